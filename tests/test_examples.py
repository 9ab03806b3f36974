import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
SHORT = ["--path-length-m", "1.5"]
ARGUMENTS = {
    "quickstart.py": [],
    "repeatability.py": [*SHORT, "--repeats", "2", "--busy-loops", "1", "--camera", "small", "--syncs", "free"],
    "views.py": [*SHORT, "--out", "OUT.png"],
    "speed_sweep.py": [*SHORT, "--speeds", "0.5", "1.0", "--out", "OUT"],
}


@pytest.mark.parametrize("script", sorted(EXAMPLES.glob("*.py")), ids=lambda path: path.name)
def test_example_runs(script, tmp_path):
    arguments = [word.replace("OUT", str(tmp_path / "out")) for word in ARGUMENTS[script.name]]
    result = subprocess.run(
        [sys.executable, str(script), *arguments], cwd=tmp_path, capture_output=True, text=True, timeout=300
    )
    assert result.returncode == 0, result.stderr
    assert "ok" in result.stdout
    if script.name == "speed_sweep.py":
        assert len(list((tmp_path / "out").glob("*/speed_*/episode.json"))) == 2
