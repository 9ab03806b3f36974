import shutil
import subprocess
import sys
import threading
from dataclasses import replace

import numpy as np
import pytest
from skimage.io import imread

from slamgym.errors import OutputError, SequenceError
from slamgym.eval.datasets import SequenceWriter, read_sequence

LISTS = {"rgb.txt", "depth.txt", "associations.txt", "groundtruth.txt", "camera.yaml"}

# Files may not grow beyond a limit, as on a full disk.
FULL_DISK = """
import resource, sys
from pathlib import Path
import numpy as np
from slamgym.camera import PinholeCamera
from slamgym.errors import OutputError
from slamgym.eval.datasets import SequenceWriter
from slamgym.types import Frame

size, count, limit = map(int, sys.argv[2:])
resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
rgb = np.random.default_rng(0).integers(256, size=(size, size, 3), dtype=np.uint8)
try:
    with SequenceWriter(Path(sys.argv[1]), PinholeCamera(size, size, 9.0, 9.0, 4.0, 4.0), 30.0) as writer:
        for k in range(count):
            writer.add(Frame(k, rgb, np.ones((size, size), np.float32), np.eye(4)))
except OutputError as error:
    print(error)
"""


def record(folder, camera, frames):
    with SequenceWriter(folder, camera, 30.0) as writer:
        for frame in frames:
            writer.add(frame)
    return folder


def writing_threads():
    return [thread for thread in threading.enumerate() if thread.name.startswith("sequence-writer")]


def test_what_was_recorded_is_read_back(tmp_path, camera, make_frames):
    frames = make_frames(30)
    sequence = read_sequence(record(tmp_path / "new", camera, frames))
    assert {path.name for path in sequence_files(tmp_path / "new")} == LISTS
    assert (sequence.camera, sequence.fps, sequence.name) == (camera, 30.0, "new")
    np.testing.assert_array_equal(sequence.stamps_ns, [frame.stamp_ns for frame in frames])
    assert sequence.has_truth.all()
    for frame, read in zip(frames, sequence.frames(), strict=True):
        np.testing.assert_array_equal(read.rgb, frame.rgb)
        np.testing.assert_allclose(read.depth, frame.depth, rtol=0, atol=1.01e-4)
        np.testing.assert_allclose(read.T_world_cam, frame.T_world_cam, atol=1e-8)
    assert not writing_threads()


def sequence_files(folder):
    return [path for path in folder.iterdir() if path.is_file()]


def test_other_programs_find_tums_format(tmp_path, camera, make_frames):
    frames = make_frames(2)
    folder = record(tmp_path, camera, frames)
    pair = "0.033333333 rgb/0.033333333.png 0.033333333 depth/0.033333333.png"
    assert (folder / "associations.txt").read_text().splitlines()[1] == pair
    assert (folder / "rgb.txt").read_text().splitlines()[1:] == [
        f"{stamp} rgb/{stamp}.png" for stamp in ("0.000000000", "0.033333333")
    ]
    assert (folder / "depth.txt").read_text() == (folder / "rgb.txt").read_text().replace("rgb", "depth")
    np.testing.assert_array_equal(imread(folder / "rgb" / "0.033333333.png"), frames[1].rgb)
    depth = imread(folder / "depth" / "0.033333333.png")
    assert depth.dtype == np.uint16
    np.testing.assert_allclose(depth / 5000, frames[1].depth, atol=1.01e-4)


def test_what_cannot_be_told_in_16_bits_is_no_measurement(tmp_path, camera, make_frames):
    depth = np.zeros((6, 8), np.float32)
    depth[0] = [np.nan, np.inf, -1.0, 13.108, 1e30, 13.107, 0.0002, 0.00005]
    sequence = read_sequence(record(tmp_path, camera, [replace(make_frames(1)[0], depth=depth)]))
    np.testing.assert_allclose(sequence.frame(0).depth[0], [0, 0, 0, 0, 0, 13.107, 0.0002, 0], atol=1e-6)


def test_only_poses_that_are_known_become_the_truth(tmp_path, camera, make_frames):
    frames = make_frames(4)
    frames[1] = replace(frames[1], T_world_cam=np.full((4, 4), np.nan))
    frames[2] = replace(frames[2], has_truth=False)
    sequence = read_sequence(record(tmp_path / "some", camera, frames))
    np.testing.assert_array_equal(sequence.truth.stamps_ns, [frames[0].stamp_ns, frames[3].stamp_ns])
    np.testing.assert_array_equal(sequence.has_truth, [True, False, False, True])
    record(tmp_path / "none", camera, frames[1:3])
    assert not (tmp_path / "none" / "groundtruth.txt").exists()
    assert read_sequence(tmp_path / "none").truth is None


@pytest.mark.parametrize("error", [KeyboardInterrupt, FileNotFoundError("not ours")], ids=["Ctrl-C", "OSError"])
@pytest.mark.parametrize("exists", [False, True])
def test_a_recording_that_an_exception_ends_leaves_nothing(tmp_path, camera, make_frames, error, exists):
    folder = tmp_path / "new"
    if exists:
        folder.mkdir()
    before = list(tmp_path.iterdir())
    kind = error if isinstance(error, type) else type(error)
    with pytest.raises(kind), SequenceWriter(folder, camera, 30.0) as writer:  # noqa: PT012
        for frame in make_frames(20):
            writer.add(frame)
        raise error
    assert not writing_threads()
    assert list(tmp_path.rglob("*")) == before
    with pytest.raises(OutputError, match="still recorded"):
        writer.add(make_frames(1)[0])
    assert len(read_sequence(record(folder, camera, make_frames(2)))) == 2


def test_a_recording_is_there_whole_or_not_at_all(tmp_path, camera, make_frames):
    with SequenceWriter(tmp_path / "new", camera, 30.0) as writer:
        for frame in make_frames(20):
            writer.add(frame)
            assert not (tmp_path / "new").exists()
    assert len(read_sequence(tmp_path / "new")) == 20
    assert list(tmp_path.iterdir()) == [tmp_path / "new"]


def test_an_image_that_cannot_be_written_is_told_by_the_next_calls(tmp_path, camera, make_frames):
    def without(kind):
        """A writer whose folder of that kind is gone, as on a disk that is taken away."""
        writer = SequenceWriter(tmp_path / "new", camera, 30.0)
        shutil.rmtree(next(tmp_path.glob(f".new-*/new/{kind}")))
        return writer

    writer = without("rgb")
    with pytest.raises(OutputError, match=r"cannot write .*new: No such file"):  # noqa: PT012
        for frame in make_frames(20):
            writer.add(frame)
    assert not writing_threads()
    writer.close()
    writer = without("depth")
    writer.add(make_frames(1)[0])
    with pytest.raises(OutputError, match=r"cannot write .*new: No such file"):
        writer.close()
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("size", "count", "limit"), [(40, 3, 2_000), (2, 60, 2_000)], ids=["images", "lists"])
def test_a_full_disk_leaves_nothing(tmp_path, size, count, limit):
    arguments = [sys.executable, "-c", FULL_DISK, str(tmp_path / "new"), str(size), str(count), str(limit)]
    result = subprocess.run(arguments, capture_output=True, text=True, timeout=60, check=True)
    assert result.stdout == f"cannot write {tmp_path / 'new'}: File too large; make room or name another\n"
    assert not list(tmp_path.iterdir())


def test_frames_that_do_not_fit_are_refused(tmp_path, camera, make_frames):
    frame, next_frame = make_frames(2)
    with SequenceWriter(tmp_path, camera, 30.0) as writer:
        writer.add(next_frame)
        with pytest.raises(SequenceError, match="expected a stamp above 33333333 ns, got 0 ns"):
            writer.add(frame)
        with pytest.raises(SequenceError, match=r"expected images of the camera's 8x6 pixels, got .*\(6, 7\)"):
            writer.add(replace(next_frame, stamp_ns=10**9, depth=frame.depth[:, 1:]))
    assert len(read_sequence(tmp_path)) == 1


def test_nothing_is_written_over(tmp_path, camera):
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(OutputError, match="expected a new or empty folder"):
        SequenceWriter(tmp_path, camera, 30.0)
    with pytest.raises(OutputError, match="expected a new or empty folder"):
        SequenceWriter(tmp_path / "mine.txt", camera, 30.0)
    with pytest.raises(OutputError, match=r"cannot write in .*mine\.txt;"):
        SequenceWriter(tmp_path / "mine.txt" / "new", camera, 30.0)
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]
