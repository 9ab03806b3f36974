"""`slamgym run --like`: a run is repeated from its folder."""

import json
import shutil

import pytest
import yaml

from slamgym.cli import main

RUN = [
    *("run", "--camera", "small", "--lighting", "flat", "--path-length-m", "1", "--speed", "0.8", "--seed", "5"),
    *("--agent", "patrol", "--slam", "wheel_odometry", "--stride", "1", "--slam-options", "drift_noise", "0.1"),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs") / "run"
    main([*RUN, "--out", str(folder)])
    return folder


def test_the_same_run_comes_out_and_what_has_changed_is_told(folder, tmp_path, capsys):
    recorded = shutil.copytree(folder, tmp_path / "recorded")
    config = yaml.safe_load((folder / "config.yaml").read_text())
    versions = config["run"]["versions"]
    (recorded / "config.yaml").write_text(
        yaml.safe_dump({**config, "run": {**config["run"], "versions": {**versions, "house_sha256": "0123456789ab"}}})
    )
    main(["run", "--like", str(recorded), "--out", str(tmp_path / "again")])
    told = [line for line in capsys.readouterr().out.splitlines() if "not as it was recorded" in line]
    assert told == [f"not as it was recorded: house_sha256: 0123456789ab then, {versions['house_sha256']} now"]
    for name in ("config.yaml", "groundtruth.txt", "estimate.txt", "poses.csv", "frames.csv"):
        assert (tmp_path / "again" / name).read_text() == (folder / name).read_text(), name
    here, there = (json.loads((place / "episode.json").read_text()) for place in (tmp_path / "again", folder))
    assert here.pop("timing").keys() == there.pop("timing").keys()
    assert here == there


@pytest.mark.parametrize(
    ("beside", "flags"),
    [
        (["--speed", "1"], "--speed"),
        # As it is by default.
        (["--speed", "0.2"], "--speed"),
        (["--max_episode_steps=10000", "--seed", "0"], "--max-episode-steps, --seed"),
        (["--seed", "6", "--slam-options", "features", "500"], "--seed, --slam-options"),
        (["--agent", "cautious", "--loop-closure", "True"], "--agent, --loop-closure"),
    ],
)
def test_other_parameters_beside_it_are_refused(beside, flags, folder, tmp_path, capsys):
    with pytest.raises(SystemExit) as stopped:
        main(["run", "--like", str(folder), "--out", str(tmp_path / "again"), *beside])
    assert stopped.value.code == 2
    assert capsys.readouterr().err.strip().endswith(f"expected no other parameters, got {flags}")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_without_a_run_is_told(tmp_path, capsys):
    with pytest.raises(SystemExit):
        main(["run", "--like", str(tmp_path), "--out", str(tmp_path / "again")])
    assert (
        "expected the folder of a run, got one whose config.yaml cannot be read; name another"
        in capsys.readouterr().err
    )
