import os
import time

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
