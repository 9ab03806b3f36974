import subprocess
import sys
from dataclasses import replace

import pytest

from slamgym.errors import ConfigError, SlamError
from slamgym.slam.backend import BACKENDS, check_config, load_backend, parse_options
from slamgym.slam.orbslam3 import OrbSlam3Options
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
        check_config(name, config)


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
    ],
)
def test_bad_option(options, message):
    with pytest.raises(ConfigError, match=message) as caught:
        parse_options(OrbSlam3Options, options)
    assert "\n" not in str(caught.value)


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
