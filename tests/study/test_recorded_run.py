import pytest
import yaml

from slamgym.agents import Patrol
from slamgym.errors import ConfigError
from slamgym.params import SlamParams
from slamgym.study.planned import PlannedDrive, PlannedRun
from slamgym.study.recorded_run import changed_versions, read_recorded_run
from slamgym.study.slam_work import PLANNED, write_planned

RUN = {
    "env_id": "HomeRobotSLAM-v0",
    "seed": 3,
    "agent": "slamgym.agents.patrol:Patrol",
    "reset_options": {"tour": "round_trip"},
    "versions": {"slamgym": "0.1"},
}
SLAM = {**SlamParams().model_dump(), "slam": "groundtruth", "slam_options": {}}


def folder_of(tmp_path, run=RUN, **config):
    (tmp_path / "config.yaml").write_text(yaml.safe_dump({"run": run, **config}))
    return tmp_path


def test_all_that_a_run_depends_on_is_read(tmp_path):
    read = read_recorded_run(folder_of(tmp_path, speed=0.4, max_episode_steps=50, **SLAM))
    assert read.keywords == {"speed": 0.4, "max_episode_steps": 50, **SLAM}
    assert (read.seed, read.agent, read.versions, read.busy_processes) == (3, Patrol, {"slamgym": "0.1"}, 0)


def test_how_busy_the_computer_was_is_planned(tmp_path):
    folder = folder_of(tmp_path, **SLAM)
    write_planned(folder, PlannedRun("d/1", PlannedDrive("d", "s", "p", {}), {}, 1, {}, busy_processes=3))
    assert read_recorded_run(folder).busy_processes == 3


def test_other_reset_options_than_the_agents_are_kept_under_its_name(tmp_path):
    options = {"tour": "one_way"}
    agent = read_recorded_run(folder_of(tmp_path, {**RUN, "reset_options": options}, **SLAM)).agent()
    assert isinstance(agent, Patrol)
    assert agent.reset_options == options
    assert Patrol.reset_options == {"tour": "round_trip"}
    assert f"{type(agent).__module__}:{type(agent).__qualname__}" == RUN["agent"]


def test_a_replay_is_refused_with_the_line_to_type(tmp_path):
    config = {**SLAM, "stride": 2, "slam": "wheel_odometry", "slam_options": {"seed": 4, "drift_noise": 0.02}}
    folder = folder_of(tmp_path, {"sequence": "fr1 xyz", "versions": {}}, **config)
    line = "slamgym replay 'fr1 xyz' --out DIR --slam wheel_odometry --stride 2 --slam-options seed 4"
    with pytest.raises(ConfigError) as told:
        read_recorded_run(folder)
    assert str(told.value).endswith(f"repeat it with: {line}")
    drive = PlannedDrive("d", "own", "fr1 xyz", {}, sequence="/data/fr1 xyz")
    write_planned(folder, PlannedRun("d/1", drive, {}, 1, {}))
    with pytest.raises(ConfigError, match="replay '/data/fr1 xyz' --out DIR"):
        read_recorded_run(folder)


@pytest.mark.parametrize(
    ("run", "config", "message"),
    [
        ({**RUN, "agent": "nowhere:Agent"}, SLAM, "agent nowhere:Agent: expected one that can be imported"),
        ({**RUN, "agent": "__main__:Mine"}, SLAM, "agent __main__:Mine"),
        ({name: RUN[name] for name in ("agent", "reset_options", "versions")}, SLAM, "expected 'seed' of the run"),
        (RUN, {}, "expected a run with a SLAM in the loop"),
        ([], SLAM, "an entry 'run'"),
    ],
)
def test_a_run_that_cannot_be_repeated_is_told_in_one_line(run, config, message, tmp_path):
    with pytest.raises(ConfigError, match=message) as told:
        read_recorded_run(folder_of(tmp_path, run, **config))
    assert len(str(told.value).splitlines()) == 1


@pytest.mark.parametrize("content", [None, "a: [", "- 1", "\x00"])
def test_a_folder_without_a_config_is_told_in_one_line(content, tmp_path):
    if content is not None:
        (tmp_path / "config.yaml").write_text(content)
    with pytest.raises(ConfigError, match="expected") as told:
        read_recorded_run(tmp_path)
    assert len(str(told.value).splitlines()) == 1


def test_a_plan_that_is_none_is_told(tmp_path):
    folder = folder_of(tmp_path, **SLAM)
    (folder / PLANNED).write_text("[1]")
    with pytest.raises(ConfigError, match="expected a run as a study planned it"):
        read_recorded_run(folder)


def test_what_has_changed_since():
    then, now = (
        {"slamgym": "0.1", "house_sha256": "aa", "orb": "3"},
        {"slamgym": "0.1", "house_sha256": "bb", "map": "m"},
    )
    assert changed_versions(then, then) == []
    assert changed_versions(then, now) == [
        "house_sha256: aa then, bb now",
        "orb: 3 then, none now",
        "map: none then, m now",
    ]
