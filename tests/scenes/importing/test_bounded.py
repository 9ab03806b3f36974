import os
import subprocess
import sys
import time
from types import ModuleType

import numpy as np
import pytest

from slamgym.errors import SceneError
from slamgym.scenes.importing.bounded import call_bounded
from slamgym.scenes.importing.data_root import read_plain


def test_the_result_comes_back():
    assert (call_bounded("house.glb", np.arange)(3) == [0, 1, 2]).all()


def test_large_results_come_back():
    assert call_bounded("house.glb", np.zeros)(5_000_000).shape == (5_000_000,)


def test_its_scene_errors_are_raised_as_they_are(tmp_path):
    with pytest.raises(SceneError, match="No such file"):
        call_bounded("house.glb", read_plain)(tmp_path / "missing")


@pytest.mark.parametrize(
    ("function", "arguments", "message"),
    [
        (os.abort, (), "house.glb: its reader ended with Aborted"),
        (os._exit, (3,), "house.glb: its reader ended with exit status 3"),
        (time.sleep, (60,), "house.glb: expected to be read within 2 s"),
        (np.ones, (1 << 40,), "house.glb: expected to need at most 2048 MB of memory"),
        (int, ("seven",), "house.glb: cannot be read .ValueError"),
    ],
)
def test_crash_hang_and_exhausted_memory_are_scene_errors(function, arguments, message, children):
    before = children()
    with pytest.raises(SceneError, match=message):
        call_bounded("house.glb", function, memory_bytes=2 << 30, time_s=2.0)(*arguments)
    assert children() <= before


def test_a_broken_installation_is_not_the_files_fault(monkeypatch):
    gone = ModuleType("gone")
    exec("def read():\n    pass", vars(gone))  # a function of a module that the other process cannot import
    monkeypatch.setitem(sys.modules, "gone", gone)
    told = (
        "house.glb: its reader ended with exit status 1 .ModuleNotFoundError: No module named 'gone'.; check the inst"
    )
    with pytest.raises(SceneError, match=told):
        call_bounded("house.glb", gone.read)()


def test_a_lower_limit_of_the_system_is_kept():
    program = (
        "import operator, resource; from slamgym.scenes.importing.bounded import call_bounded\n"
        "resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))\n"
        "assert call_bounded('house.glb', resource.getrlimit)(resource.RLIMIT_AS) == (4 << 30, 4 << 30)"
    )
    subprocess.run([sys.executable, "-c", program], check=True, timeout=60)


def test_the_working_directory_may_be_gone(tmp_path, monkeypatch):
    (tmp_path / "gone").mkdir()
    monkeypatch.chdir(tmp_path / "gone")
    monkeypatch.syspath_prepend("")
    (tmp_path / "gone").rmdir()
    assert call_bounded("house.glb", int)("7") == 7
