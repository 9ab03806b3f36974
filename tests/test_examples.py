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
    "speed_sweep.py": [*SHORT, "--speeds", "0.5", "1.0", "--out", "OUT"],
}
"""Of every example; analyse_runs.py is run on what speed_sweep.py leaves."""


def run(script, arguments, folder):
    words = [word.replace("OUT", str(folder / "out")) for word in arguments]
    result = subprocess.run(
        [sys.executable, str(EXAMPLES / script), *words], cwd=folder, capture_output=True, text=True, timeout=300
    )
    assert result.returncode == 0, result.stderr
    return result.stdout


def test_every_example_is_run():
    assert {path.name for path in EXAMPLES.glob("*.py")} == {*ARGUMENTS, "analyse_runs.py"}


@pytest.mark.parametrize("script", ARGUMENTS)
def test_example_runs(script, tmp_path):
    assert "ok" in run(script, ARGUMENTS[script], tmp_path)
    if script == "speed_sweep.py":
        assert len(list((tmp_path / "out").glob("*/speed_*/episode.json"))) == 2
        printed = run("analyse_runs.py", ["OUT", "--pictures", "OUT/pictures"], tmp_path)
        assert "2 runs: 2 ok" in printed
        assert "0 of 2 runs failed" in printed
        assert len(list((tmp_path / "out" / "pictures").iterdir())) == 4
