import subprocess
import sys
from dataclasses import replace
from typing import Literal

import pytest
from pydantic import BaseModel

from slamgym.errors import ConfigError, SlamError
from slamgym.slam.backend import BACKENDS, SlamOptions, check_config, load_backend
from slamgym.slam.groundtruth import GroundTruth
from slamgym.slam.orb_settings import OrbOptions
from slamgym.slam.session import SlamSession
from slamgym.types import SlamEvent

NOT_EVERYWHERE = {"command", "orbslam2"}
"""They need a program or a library of the user's, see their own tests."""


@pytest.mark.parametrize("name", BACKENDS)
def test_every_backend_offers_what_the_protocol_asks(name, config):
    backend = load_backend(name)
    assert set(backend.loop_closures) <= {True, False}
    assert isinstance(backend.offline, bool)
    assert isinstance(backend.has_background_threads, bool)
    if name not in NOT_EVERYWHERE:
        assert backend.Options() is not None  # all options have defaults
        assert check_config(name, config) is backend


@pytest.mark.parametrize("name", BACKENDS)
def test_no_slam_library_in_the_users_process(name):
    program = f"import sys; from slamgym.slam.backend import load_backend; load_backend({name!r}); print(*sys.modules)"
    modules = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert "pyorbslam3" not in modules


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("orbslam", "did you mean 'orbslam3'"),
        ("no_such_module:Slam", "no_such_module"),
        ("slamgym.slam.groundtruth:Nothing", "Nothing"),
    ],
)
def test_unknown_backend(name, message):
    with pytest.raises(ConfigError, match=message):
        load_backend(name)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"feature": 500}, "unknown slam option 'feature'; did you mean 'features'"),
        ({"features": "many"}, "slam option 'features': .*integer.*, got 'many'"),
        ({"scale_factor": 0.5}, "slam option 'scale_factor': .*greater than 1.*, got 0.5"),
        ({"baseline": "inf"}, "slam option 'baseline': .*finite number, got 'inf'"),
        ({"levels": 0, "feature": 500}, "'levels': .*, got 0; unknown slam option 'feature'"),
    ],
)
def test_bad_option(options, message):
    with pytest.raises(ConfigError, match=message) as caught:
        OrbOptions.checked(options)
    assert "\n" not in str(caught.value)


class WordsAndNumbers(SlamOptions):
    word: Literal["fast", "exact"] = "fast"
    number: Literal[1, 2] = 1
    maybe: Literal["fast", "exact"] | None = None


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"word": "exat"}, "unknown word 'exat'; did you mean 'exact'"),
        ({"number": "3"}, "slam option 'number': the value should be 1 or 2, got '3'"),
        ({"maybe": "exat"}, "slam option 'maybe': the value should be 'fast' or 'exact', got 'exat'"),
    ],
)
def test_bad_choice(options, message):
    with pytest.raises(ConfigError, match=message):
        WordsAndNumbers.checked(options)


class PlainOptions(BaseModel):
    pass


@pytest.mark.parametrize("options", [PlainOptions, SlamOptions()])
def test_options_of_a_users_backend_have_to_be_slam_options(options, monkeypatch):
    monkeypatch.setattr(GroundTruth, "Options", options)
    with pytest.raises(ConfigError, match=r"'groundtruth': expected Options derived .*SlamOptions, got .*; derive"):
        load_backend("groundtruth")


def test_loop_closure_of_a_slam_that_has_none(config):
    check_config("groundtruth", replace(config, loop_closure=False))
    with pytest.raises(ConfigError, match="'groundtruth': expected loop_closure as one of None, False, got True"):
        check_config("groundtruth", replace(config, loop_closure=True))


def test_installed_package_adds_a_backend(tmp_path, monkeypatch, config, frame):
    """As pip leaves it: a module, and its entry points in a folder beside it."""
    (tmp_path / "my_slam.py").write_text("from slamgym.slam.groundtruth import GroundTruth as MySlam\n")
    info = tmp_path / "my_slam-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: my-slam\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[slamgym.slam_backends]\nmine = my_slam:MySlam\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    with SlamSession("mine", config) as session:
        assert session.track(frame(3)).event is SlamEvent.INITIALIZED
    with pytest.raises(ConfigError, match="did you mean 'mine'"):
        load_backend("mien")


def test_missing_vocabulary_is_seen_before_anything_starts(config, tmp_path):
    with pytest.raises(SlamError, match="expected a file"):
        check_config("orbslam3", replace(config, options={"vocabulary": str(tmp_path / "ORBvoc.txt")}))
