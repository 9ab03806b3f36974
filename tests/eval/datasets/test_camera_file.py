import pytest

from slamgym.camera import CAMERAS, LENSES, PinholeCamera
from slamgym.errors import SequenceError
from slamgym.eval.datasets import read_sequence

OWN = PinholeCamera(8, 6, 7.5, 7.25, 3.5, 2.5)
BILLION = "a: &a [x, x]\nb: &b [*a, *a]\nwidth: [*b, *b]\n"


def test_the_camera_is_the_given_one_or_the_sequences_own_or_that_of_the_name(tum_folder, tmp_path):
    own = tum_folder()
    assert read_sequence(own).camera == OWN
    assert read_sequence(own, "tum_fr2").camera == LENSES["tum_fr2"]
    assert read_sequence(own, "default").camera == CAMERAS["default"]
    other = tmp_path / "other.yaml"
    other.write_text("{width: 8, height: 6, fx: 9, fy: 9, cx: 4, cy: 3, distortion: [1, 2, 3, 4], fps: 5}")
    given = read_sequence(own, str(other))
    assert given.camera == PinholeCamera(8, 6, 9, 9, 4, 3, (1, 2, 3, 4))
    assert given.fps == 5
    for digit in "123":
        named = tum_folder(name=f"rgbd_dataset_freiburg{digit}_desk", camera_yaml="")
        assert read_sequence(named).camera == LENSES[f"tum_fr{digit}"]


def test_a_number_without_a_point_that_yaml_takes_for_a_word(tum_folder):
    text = "{width: 8, height: 6, fx: 75e-1, fy: 7.25, cx: 3.5, cy: 2.5, distortion: [0.1, -2e-1, 0, -1e-5], fps: 1e1}"
    sequence = read_sequence(tum_folder(camera_yaml=text))
    assert sequence.camera == PinholeCamera(8, 6, 7.5, 7.25, 3.5, 2.5, (0.1, -0.2, 0.0, -1e-5))
    assert sequence.fps == 10


def test_the_name_of_a_folder_that_is_given_as_a_dot_counts(tum_folder, monkeypatch):
    monkeypatch.chdir(tum_folder(name="tum_fr3_office", camera_yaml=""))
    sequence = read_sequence(".")
    assert (sequence.name, sequence.camera) == ("tum_fr3_office", LENSES["tum_fr3"])


def test_depth_scale_and_rate_stay_those_of_the_files_when_a_preset_is_given(tum_folder):
    text = "{width: 640, height: 480, fx: 1, fy: 1, cx: 1, cy: 1, depth_scale: 1000, fps: 15}"
    sequence = read_sequence(tum_folder(camera_yaml=text), "tum_fr1")
    assert (sequence.camera, sequence.fps) == (LENSES["tum_fr1"], 15)
    scaled = tum_folder(
        name="scaled", camera_yaml="{width: 8, height: 6, fx: 7, fy: 7, cx: 4, cy: 3, depth_scale: 1000}"
    )
    assert (read_sequence(scaled).frame(2).depth == 10).all()
    assert read_sequence(scaled).fps == pytest.approx(10)


def test_without_a_camera_the_message_says_what_to_write(tum_folder):
    folder = tum_folder(name="freiburg", camera_yaml="")
    with pytest.raises(
        SequenceError, match=r"give --camera tum_fr1\|tum_fr2\|tum_fr3, or write a camera.yaml .*width, height, fx"
    ):
        read_sequence(folder)
    with pytest.raises(SequenceError, match=r"unknown camera 'tum_fr4'; did you mean 'tum_fr[123]'.* or the path of"):
        read_sequence(folder, "tum_fr4")


@pytest.mark.parametrize(
    ("text", "pattern"),
    [
        ("# nothing", "got: no keys"),
        ("width: 8", "height: Field required"),
        ("{width: 8, height: 6, fx: 7, fy: 7, cx: 4, cy: 3, baseline: 1}", "unknown parameter 'baseline'"),
        ("{width: 8, height: 6, fx: -7, fy: 7, cx: 4, cy: 3}", "focal lengths above 0"),
        ("{width: 8.5, height: 6, fx: 7, fy: 7, cx: 4, cy: 3}", "width: the value should be a valid integer"),
        ("{width: 8, height: 6, fx: .nan, fy: 7, cx: 4, cy: 3}", "fx: the value should be a finite number"),
        ("{width: 8, height: 6, fx: 7, fy: 7, cx: 4, cy: 3, depth_scale: 0}", "depth_scale: the value should be"),
        ("{width: 8, height: 6, fx: 7, fy: 7, cx: 4, cy: 3, distortion: [1]}", "no distortion, or finite"),
        ("{width: 8, height: 6, fx: 1" + "0" * 400 + ", fy: 7, cx: 4, cy: 3}", "fx: "),
        ("width: 1" + "0" * 5000, "Exceeds the limit"),
        ("[" * 15_000, "more lists than the one of the distortion"),
        ("- " * 7_000, "more lists than the one of the distortion"),
        ("{width: &a [*a]}", "an alias"),
        ("width: !!python/object/apply:os.system [ls]", "could not determine a constructor"),
        ("width: {", "while parsing"),
        (BILLION, "an alias, or more lists"),
        ("#" * 20_000, "at most 16384 bytes"),
        ("width: \0", "not allowed"),
    ],
)
def test_a_broken_camera_file_is_refused_in_one_line(tum_folder, text, pattern):
    with pytest.raises(SequenceError, match=pattern) as told:
        read_sequence(tum_folder(camera_yaml=text))
    message = str(told.value)
    assert "camera.yaml: expected the keys width" in message
    assert len(message.splitlines()) == 1
    assert len(message) < 800
