import os
import re
import warnings
from pathlib import Path

import cv2
import numpy as np
import pytest

from slamgym.camera import LENSES
from slamgym.errors import SequenceError, TrajectoryWarning
from slamgym.eval.datasets import FORMATS, published, read_sequence


@pytest.fixture(autouse=True)
def _warnings_are_errors():
    with warnings.catch_warnings():
        warnings.simplefilter("error", TrajectoryWarning)
        yield


def refused(folder, pattern):
    with pytest.raises(SequenceError, match=pattern) as told:
        read_sequence(folder)
    assert len(str(told.value).splitlines()) == 1


def test_real_frames_of_freiburg1(shared_data):
    with pytest.warns(TrajectoryWarning, match="5 of 100 colour images have no depth image within 0.02 s") as told:
        sequence = read_sequence(shared_data / "tum_fr1_xyz_100")
    assert len(told) == 1
    assert (len(sequence), sequence.has_truth.sum(), len(sequence.truth)) == (95, 95, 691)
    assert sequence.camera == LENSES["tum_fr1"]
    assert 29 < sequence.fps < 32
    assert published(sequence.name).ate_rmse_m == 0.010
    frame = sequence.frame(0)
    assert frame.stamp_ns == 1305031102_175304000
    assert (frame.rgb.shape, frame.rgb.dtype, frame.depth.shape) == ((480, 640, 3), np.uint8, (480, 640))
    # A desk at 1 to 2 m; the colour as OpenCV has it, the other way round.
    assert 0.5 < np.median(frame.depth[frame.depth > 0]) < 2.5
    bgr = cv2.imread(str(shared_data / "tum_fr1_xyz_100/rgb/1305031102.175304.png"))
    np.testing.assert_array_equal(frame.rgb, bgr[..., ::-1])
    # Interpolated: 1305031102.1753 lies in the truth at x 1.3405 y 0.6266 z 1.6575, to half a millimetre.
    np.testing.assert_allclose(frame.T_world_cam[:3, 3], [1.3405, 0.6266, 1.6575], atol=5e-4)


def test_frames_are_pairs_with_colour_in_rgb_and_depth_in_metres(tum_folder):
    sequence = read_sequence(tum_folder())
    assert sequence.name == "mine"
    assert sequence.fps == 10
    assert (sequence.stamps_ns == [1_000_000_000, 1_100_000_000, 1_200_000_000]).all()
    for k, frame in enumerate(sequence.frames()):
        assert (frame.rgb == [k, 100, 200]).all()
        assert frame.depth.dtype == np.float32
        assert (frame.depth == k).all()
    assert [frame.stamp_ns for frame in sequence.frames(stride=1)] == [1_000_000_000, 1_200_000_000]
    assert list(sequence.rows(stride=1)) == [0, 2]


def test_colour_and_depth_are_paired_by_time_the_closest_first(tum_folder):
    # 1.1 is 0.005 s from depth 1; depth 0 is 0.019 s from colour 0; 1.2 has no depth within 0.02 s.
    folder = tum_folder(rgb_s=(1.0, 1.1, 1.2), depth_s=(1.019, 1.105, 1.25))
    with pytest.warns(TrajectoryWarning, match="1 of 3 colour images"):
        sequence = read_sequence(folder)
    assert (sequence.stamps_ns == [1_000_000_000, 1_100_000_000]).all()
    assert [frame.depth[0, 0] for frame in sequence.frames()] == [0, 1]


@pytest.mark.parametrize("name", ["associations.txt", "associate.txt"])
def test_associations_come_before_the_pairing(tum_folder, name):
    folder = tum_folder()
    (folder / name).write_text("1.1 rgb/1.1.png 1.0 depth/1.0.png\n1.2 rgb/1.2.png 1.1 depth/1.1.png\n")
    sequence = read_sequence(folder)
    assert [(frame.rgb[0, 0, 0], frame.depth[0, 0]) for frame in sequence.frames()] == [(1, 0), (2, 1)]


def test_true_poses_are_interpolated_and_only_those_near_a_true_one_count(tum_folder):
    folder = tum_folder(rgb_s=(1.0, 1.1, 1.2, 1.3), depth_s=(1.0, 1.1, 1.2, 1.3), true_s=(1.095, 1.1, 1.21))
    sequence = read_sequence(folder)
    np.testing.assert_array_equal(sequence.has_truth, [False, True, True, False])
    # At x = t between the true poses, and where the first and the last one are beyond them.
    np.testing.assert_allclose(sequence.T_world_cam[:, 0, 3], [1.095, 1.1, 1.2, 1.21], atol=1e-9)
    # The camera's z axis is the world's x axis.
    np.testing.assert_allclose(sequence.T_world_cam[0, :3, 2], [1, 0, 0], atol=1e-9)
    assert [frame.has_truth for frame in sequence.frames()] == [False, True, True, False]


@pytest.mark.parametrize("text", [None, "# nothing but a comment\n"])
def test_without_a_truth_poses_are_nan(tum_folder, text):
    folder = tum_folder()
    if text:
        (folder / "groundtruth.txt").write_text(text)
    sequence = read_sequence(folder)
    assert sequence.truth is None
    assert np.isnan(sequence.T_world_cam).all()
    assert not sequence.has_truth.any()


def test_a_truth_of_another_time_is_told(tum_folder):
    with pytest.warns(TrajectoryWarning, match="no pose within 0.02 s of any frame"):
        assert not read_sequence(tum_folder(true_s=(7.0, 8.0))).has_truth.any()


@pytest.mark.parametrize(
    ("text", "pattern"),
    [
        ("", "rgb.txt: expected lines with 'timestamp filename', got none"),
        ("1.0 rgb/1.0.png\n1.1\n", "rgb.txt:2: expected the columns 'timestamp filename', got 1"),
        ("1.0 rgb/1.0.png 1.0 depth/1.0.png\n", "rgb.txt:1: expected the columns 'timestamp filename', got 4"),
        ("1.1 rgb/1.1.png\n1.0 rgb/1.0.png\n", "rgb.txt:2: expected increasing stamps"),
        ("1.0 ../rgb/1.0.png\n", "rgb.txt:1: expected a file inside of the sequence's folder"),
        ("1.0 rgb/../../x.png\n", "rgb.txt:1: expected a file inside"),
        ("1.0 /etc/passwd\n", "rgb.txt:1: expected a file inside"),
        ("1.0 rgb/none.png\n", "rgb.txt:1: expected the file .*none.png, got none"),
        ("1.0 rgb\n", "rgb.txt:1: expected the file"),
        ("one rgb/1.0.png\n", "rgb.txt:1: expected a stamp in seconds, got 'one'"),
        ("1000000000000000000 rgb/1.0.png\n", "rgb.txt:1: .*in nanoseconds, divide it by 1e9"),
        (f"1.0 {'x' * 300}/1.0.png\n", "File name too long"),
        ("5.0 rgb/1.0.png\n", "expected colour images within 0.02 s of depth images of depth.txt, got none"),
        ("\0\0", "got a binary file"),
    ],
)
def test_a_broken_list_is_refused_in_one_line(tum_folder, text, pattern):
    folder = tum_folder()
    (folder / "rgb.txt").write_text(text)
    refused(folder, pattern)


def test_other_broken_text_is_refused_in_one_line(tum_folder, tmp_path):
    folder = tum_folder()
    (folder / "groundtruth.txt").write_text("1.0 0 0 0\n")
    refused(folder, "groundtruth.txt:1: expected the 8 columns")
    (folder / "depth.txt").unlink()
    refused(folder, "depth.txt: No such file")
    (folder / "rgb.txt").unlink()
    refused(folder, f"one of the formats {', '.join(FORMATS)} .*got none of their files")
    refused(tmp_path / "none", "expected the folder of a sequence, got none")


def test_the_rate_of_one_frame_has_to_be_told(tum_folder):
    one = tum_folder((1.0,), (1.0,), name="rgbd_dataset_freiburg1_desk", camera_yaml="")
    refused(one, "expected two frames or more to tell their rate, got 1")


def flip_a_bit(path):
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(bytes(data))


def claim_16_tib(path):
    data = path.read_bytes()
    path.write_bytes(data[:16] + b"\x00\x40\x00\x00" * 2 + data[24:])


def make_a_pipe(path):
    path.unlink()
    os.mkfifo(path)


def draw(*shape, dtype):
    return lambda path: cv2.imwrite(str(path), np.zeros(shape, dtype))


@pytest.mark.parametrize(
    ("damage", "name", "pattern"),
    [
        (Path.unlink, "rgb", "cannot read the image .*: No such file"),
        (make_a_pipe, "rgb", "cannot read the image .*: expected a file"),
        (lambda path: path.write_bytes(path.read_bytes()[:-20]), "rgb", "whole PNG image, got a damaged one"),
        (flip_a_bit, "rgb", "whole PNG image, got a damaged one"),
        (lambda path: path.write_text("no image" * 10), "rgb", "expected a PNG image, got another file"),
        (draw(8, 6, 3, dtype=np.uint8), "rgb", "expected 8x6 pixels as the camera has, got 6x8"),
        (claim_16_tib, "rgb", "expected 8x6 pixels as the camera has, got 4194304x4194304"),
        (
            draw(6, 8, dtype=np.uint16),
            "rgb",
            "8 bits a channel.* got 16 bits.* are the two columns of the list swapped",
        ),
        (draw(6, 8, dtype=np.uint8), "depth", "16 bits and one channel.* got 8 bits"),
        (draw(6, 8, 3, dtype=np.uint16), "depth", "16 bits and one channel.* colour type 2"),
    ],
)
def test_a_damaged_image_is_refused_when_its_turn_comes(tum_folder, damage, name, pattern):
    folder = tum_folder()
    sequence = read_sequence(folder)
    damage(folder / name / "1.1.png")
    sequence.frame(0)
    with pytest.raises(SequenceError, match=rf"{name}/1\.1\.png.*") as told:
        sequence.frame(1)
    assert re.search(pattern, str(told.value))
    assert len(str(told.value).splitlines()) == 1
    sequence.frame(2)
