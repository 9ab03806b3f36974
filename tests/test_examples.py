import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
ARGUMENTS = {
    "speed_sweep.py": ["--speeds", "0.5", "1.0", "--path-length-m", "1.5", "--out", "OUT"],
}


@pytest.mark.parametrize("script", sorted(EXAMPLES.glob("*.py")), ids=lambda path: path.name)
def test_example_runs(script, tmp_path):
    arguments = [str(tmp_path / "out") if word == "OUT" else word for word in ARGUMENTS.get(script.name, [])]
    result = subprocess.run(
        [sys.executable, str(script), *arguments], cwd=tmp_path, capture_output=True, text=True, timeout=300
    )
    assert result.returncode == 0, result.stderr
    assert "ok" in result.stdout
    if arguments:
        assert len(list((tmp_path / "out").glob("*/speed_*/episode.json"))) == 2
