from pathlib import Path

import numpy as np
import pytest

from slamgym.errors import ConfigError
from slamgym.run_record import read_config, read_results, write_record


def test_what_is_written_is_read(tmp_path):
    config = {"scene": Path("house.glb"), "speed": np.float64(0.5), "run": {"seed": 7}}
    write_record(tmp_path, config, {"status": "ok", "ate_rmse_m": np.nan, "losses": [{"duration_s": np.inf}]})
    assert read_config(tmp_path, "") == {"scene": "house.glb", "speed": 0.5, "run": {"seed": 7}}
    assert read_results(tmp_path, "") == {"status": "ok", "ate_rmse_m": None, "losses": [{"duration_s": None}]}


@pytest.mark.parametrize(
    ("content", "got"),
    [
        (None, "one whose {name} cannot be read"),
        (b"\xff\xfe", "a damaged {name} (UnicodeDecodeError"),
        (b"{ [", "a damaged {name} ("),
        (b"[1, 2]", "a {name} that is [1, 2]"),
        (b"3", "a {name} that is 3"),
    ],
)
@pytest.mark.parametrize("name", ["config.yaml", "episode.json"])
def test_what_cannot_be_read_is_told_in_one_line(tmp_path, name, content, got):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    read = read_config if name == "config.yaml" else read_results
    with pytest.raises(ConfigError) as refused:
        read(tmp_path, "name another")
    told = str(refused.value)
    assert told.startswith(f"{tmp_path}: expected the folder of a run, got {got.format(name=name)}")
    assert told.endswith("; name another")
    assert len(told.splitlines()) == 1
