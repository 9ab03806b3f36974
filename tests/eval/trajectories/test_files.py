import os

import pytest

from slamgym.errors import ConfigError, TrajectoryError, TrajectoryWarning
from slamgym.eval.trajectories import (
    FORMATS,
    guess_format,
    needs_times,
    read_stamps,
    read_trajectory,
    read_tum,
    text,
)

FILES = {
    "tum": "# timestamp tx ty tz qx qy qz qw\n1 1 2 3 0 0 0 1\n",
    "kitti": "1 0 0 0 0 1 0 0 0 0 1 0\n",
    "euroc": "1403636580838555648,4.5,-1.5,0.75,1,0,0,0\n",
}


@pytest.mark.parametrize("format_", FORMATS)
def test_the_format_is_told_by_the_content_and_not_by_the_name(write, format_):
    path = write(FILES[format_], "kitti_euroc_tum.csv")
    assert guess_format(path) == format_
    times = write("1\n", "times.txt") if format_ == "kitti" else None
    assert len(read_trajectory(path, times=times)) == 1


@pytest.mark.parametrize("read_as", FORMATS)
@pytest.mark.parametrize("format_", FORMATS)
def test_a_file_of_another_format_is_told_so(write, format_, read_as):
    if format_ == read_as:
        return
    times = write("1\n", "times.txt") if read_as == "kitti" else None
    with pytest.raises(TrajectoryError, match=rf"is it in the format {format_}, or is the line cut off\?"):
        read_trajectory(write(FILES[format_]), read_as, times=times)


def test_a_file_of_no_known_format(write):
    with pytest.raises(
        TrajectoryError,
        match=r"8 columns \(tum\), 12 \(kitti\) .* got 3 columns: '1 2 3'; .* Write it as one of tum, kitti, euroc",
    ):
        guess_format(write("# nothing\n1 2 3\n"))


@pytest.mark.parametrize(("format_", "needed"), [("tum", False), ("kitti", True), ("euroc", False)])
def test_only_a_file_without_stamps_needs_times(write, format_, needed):
    assert needs_times(write(FILES[format_])) is needed


def test_whether_a_file_without_a_pose_or_of_no_format_needs_times(write, tmp_path):
    assert needs_times(write("# timestamp tx ty tz qx qy qz qw\n")) is False
    with pytest.raises(TrajectoryError, match="got 3 columns"):
        needs_times(write("1 2 3\n"))
    with pytest.raises(TrajectoryError, match="No such file"):
        needs_times(tmp_path / "none")


def test_the_format_is_told_by_the_head_of_a_file_alone(tmp_path):
    # Far down there is a byte that no text has: whoever gets there says so.
    (tmp_path / "t.txt").write_bytes(FILES["tum"].encode() + b"# much more\n" * 100_000 + b"\xff")
    assert guess_format(tmp_path / "t.txt") == "tum"
    with pytest.raises(TrajectoryError, match="got a binary file"):
        read_trajectory(tmp_path / "t.txt")


@pytest.mark.parametrize("read", [read_trajectory, read_stamps, guess_format, needs_times])
def test_a_line_without_end_is_not_read_to_its_end(write, read):
    path = write("# head\n" + "1 " * (1 << 20))
    with pytest.raises(TrajectoryError, match=r"t\.txt:2: expected lines below 1,048,576 characters, got a longer one"):
        read(path)


def test_an_unknown_format(write):
    with pytest.raises(ConfigError, match="did you mean 'kitti'"):
        read_trajectory(write(FILES["kitti"]), "kiti")


@pytest.mark.parametrize("format_", ["tum", "euroc"])
def test_times_for_a_file_that_has_stamps(write, format_):
    with pytest.raises(TrajectoryError, match="expected no times"):
        read_trajectory(write(FILES[format_]), times=write("1\n", "times.txt"))


@pytest.mark.parametrize("empty", ["", "\n\n", "# only a comment\n", "\ufeff", f"#{'x,' * 8}\n", f"{'x,' * 8}\n"])
@pytest.mark.parametrize("format_", [None, *FORMATS])
def test_a_file_without_a_pose(write, empty, format_):
    path, times = write(empty), write("1\n", "times.txt")
    with pytest.raises(TrajectoryError, match=r"no pose at all|got 0"):
        read_trajectory(path, format_, times=times if format_ == "kitti" else None)
    assert len(read_trajectory(path, format_, times=times, allow_empty=True)) == 0


def test_a_file_whose_poses_are_all_left_out(write):
    path = write("1 nan 2 3 0 0 0 1\n")
    with pytest.warns(TrajectoryWarning), pytest.raises(TrajectoryError, match="no pose at all"):
        read_tum(path, repair=True)
    with pytest.warns(TrajectoryWarning):
        assert len(read_trajectory(path, repair=True, allow_empty=True)) == 0


@pytest.mark.parametrize("content", [b"\x89PNG\xff\xfe", b"1 2 3\0", "1 1 2 3 0 0 0 1\n".encode("utf-16")])
@pytest.mark.parametrize("read", [read_trajectory, read_tum, read_stamps, guess_format])
def test_binary_files_and_other_encodings(tmp_path, content, read):
    (tmp_path / "t.png").write_bytes(content)
    with pytest.raises(TrajectoryError, match="expected lines of numbers in UTF-8, got a binary file"):
        read(tmp_path / "t.png")


def test_what_is_no_readable_file(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "loop").symlink_to("loop")
    refused = {"none": "No such file", ".": "got a folder", "pipe": "got a device", "loop": "symbolic links"}
    for name, message in refused.items():
        with pytest.raises(TrajectoryError, match=message):
            read_trajectory(tmp_path / name, allow_empty=True)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_a_file_that_one_may_not_read(write):
    path = write(FILES["tum"])
    path.chmod(0)
    with pytest.raises(TrajectoryError, match="Permission denied"):
        read_trajectory(path)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_too_many_lines_are_refused_before_they_are_parsed(tmp_path, monkeypatch, end):
    monkeypatch.setattr(text, "MAX_LINES", 3)
    (tmp_path / "t.txt").write_bytes(end.join(["no number"] * 5).encode())
    with pytest.raises(TrajectoryError, match="at most 3 lines, got more: thin the file out"):
        read_tum(tmp_path / "t.txt")
    (tmp_path / "t.txt").write_bytes((end.join(f"{k} 1 2 3 0 0 0 1" for k in range(3)) + end).encode())
    assert len(read_tum(tmp_path / "t.txt")) == 3


def test_five_million_lines_are_the_limit(tmp_path):
    # The pose on line 1 is one that no reader takes: a longer limit would lead to it.
    (tmp_path / "t.txt").write_bytes(b"1 2 3 4 5 6 7 no\n" + b"\n" * 5_000_000)
    with pytest.raises(TrajectoryError, match="expected at most 5,000,000 lines, got more"):
        read_trajectory(tmp_path / "t.txt")


def test_the_stamps_of_a_list_of_frames(write):
    path = write("# color images\n1305031102.175304 rgb/1305031102_é.png\n1305031102.211214 a.png 1305031102.22 b\n")
    assert read_stamps(path).tolist() == [1_305_031_102_175_304_000, 1_305_031_102_211_214_000]


def test_a_list_of_euroc_frames(write):
    path = write("#timestamp [ns],filename\n1403636579763555584,a.png\n1403636579813555456,b.png\n", "data.csv")
    assert read_stamps(path).tolist() == [1403636579763555584, 1403636579813555456]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "got none"),
        ("1 a\n1 b\n", ":2: expected increasing stamps"),
        ("2 a\n1 b\n", ":2: expected increasing stamps"),
        ("nan a\n", ":1: expected a stamp in seconds"),
        ("1\na\n", ":2: expected a stamp in seconds, got 'a'"),
        ("1403636580838555648\n", ":1: .* divide it by 1e9"),
    ],
)
def test_a_bad_list_of_frames(write, content, message):
    with pytest.raises(TrajectoryError, match=message):
        read_stamps(write(content))


def test_real_lists_of_frames(shared_data):
    stamps_ns = read_stamps(shared_data / "tum_fr1_xyz_100" / "rgb.txt")
    assert len(stamps_ns) == 100
    assert stamps_ns[0] == 1_305_031_102_175_304_000
