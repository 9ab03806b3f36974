import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
SHORT = ["--path-length-m", "1.5"]
ARGUMENTS = {
    "quickstart.py": [],
    "repeatability.py": [*SHORT, "--repeats", "2", "--busy-loops", "1", "--camera", "small", "--syncs", "realtime"],
    "backends.py": [*SHORT, "--seeds", "1", "--speed", "1.0", "--camera", "small"],
    "losses.py": [*SHORT, "--scenes", "procedural:0", "--seeds", "7", "--camera", "small", "--slam", "groundtruth"],
    "realism.py": [*SHORT, "--scenes", "procedural:0", "--frames", "4", "--camera", "small", "--out", "OUT"],
    "views.py": [*SHORT, "--out", "OUT.png"],
    "own_study.py": [
        "--path-length-m",
        "6",
        "--scenes",
        "procedural:0",
        "--speeds",
        "1.0",
        "--camera",
        "small",
        "--out",
        "OUT",
    ],
}


def run(script, arguments, folder):
    words = [word.replace("OUT", str(folder / "out")) for word in arguments]
    result = subprocess.run(
        [sys.executable, str(EXAMPLES / script), *words], cwd=folder, capture_output=True, text=True, timeout=300
    )
    assert result.returncode == 0, result.stderr
    return result.stdout


def test_every_example_is_run():
    assert {path.name for path in EXAMPLES.glob("*.py")} == set(ARGUMENTS)


@pytest.mark.parametrize("script", ARGUMENTS)
def test_example_runs(script, tmp_path):
    assert "ok" in run(script, ARGUMENTS[script], tmp_path)
