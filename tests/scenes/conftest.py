import json
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from PIL import Image


@pytest.fixture
def hostile_folder(tmp_path):
    """A folder for a scene's files, with what a file that means harm may name: links, a pipe, a secret beside it."""
    folder = tmp_path / "scene"
    folder.mkdir()
    Image.fromarray(np.zeros((2, 2, 3), np.uint8)).save(tmp_path / "secret.png")
    (folder / "link.png").symlink_to(tmp_path / "secret.png")
    (folder / "loop.png").symlink_to("loop.png")
    os.mkfifo(folder / "pipe.png")
    return folder


@pytest.fixture
def fuzz():
    """A function that damages the files of a scene, reads it again and again, and counts the outcomes, see fuzzing.py.

    loader: "module:class". reader: "module:function". entries: the files in the folder that are read. limit_s: when it
    hangs.
    """

    def run(loader, reader, folder, entries, count, seed, limit_s=300):
        program = [sys.executable, str(Path(__file__).with_name("fuzzing.py"))]
        words = [loader, reader, str(folder), str(count), str(seed), *entries]
        done = subprocess.run([*program, *words], capture_output=True, text=True, timeout=limit_s, check=False)
        assert done.returncode == 0, done.stderr[-2000:]
        result = json.loads(done.stdout)
        assert not result["wrong"], result["wrong"][:20]
        return Counter({(name, outcome): n for name, outcome, n in result["told"]})

    return run
