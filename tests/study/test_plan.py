import re
from collections import Counter

import gymnasium as gym
import pytest

from slamgym.errors import ConfigError
from slamgym.params import SlamParams
from slamgym.study.plan import plan_study, run_count
from slamgym.study.spec import StudySpec, read_study, write_study

PATHS = "name: s\npaths:\n- {scene: procedural:1, seeds: 1}\n"


def spec_of(**keys):
    return StudySpec.checked({"name": "s", "paths": [{"scene": "procedural:1", "seeds": [1]}], **keys})


@pytest.fixture
def written(tmp_path):
    def write(text):
        path = tmp_path / "study.yaml"
        path.write_text(text)
        return path

    return write


def test_entries_are_crossed_and_names_in_one_go_together():
    spec = spec_of(
        paths=[{"scene": ["procedural:1", "procedural:2"], "seeds": [3, 4]}, {"scene": "sweethome:5", "seeds": [6]}],
        fixed={"agent": "patrol", "path_length_m": 8},
        factors=[{"speed": [0.1, 0.4]}, {"stride": [0, 1], "loop_closure": [True, False]}],
        repeats=3,
    )
    runs = plan_study(spec)
    assert len(runs) == run_count(spec) == 5 * 2 * 2 * 3
    assert Counter((run.drive.path, run.drive.dataset) for run in runs) == {
        ("procedural:1 #3", "procedural"): 12,
        ("procedural:1 #4", "procedural"): 12,
        ("procedural:2 #3", "procedural"): 12,
        ("procedural:2 #4", "procedural"): 12,
        ("sweethome:5 #6", "sweethome"): 12,
    }
    levels = {tuple(run.levels.items()) for run in runs}
    assert levels == {
        (("speed", speed), ("stride", stride), ("loop_closure", loop_closure))
        for speed in (0.1, 0.4)
        for stride, loop_closure in ((0, True), (1, False))
    }
    assert [run.repeat for run in runs[:4]] == [1, 2, 3, 1]
    assert runs[0].drive.params == {"scene": "procedural:1", "speed": 0.1, "path_length_m": 8.0}
    assert (runs[0].drive.seed, runs[0].drive.agent, runs[0].drive.max_episode_steps) == (3, "patrol", None)
    assert runs[0].slam == {"stride": 0, "loop_closure": True}


def test_runs_come_path_after_path_and_drive_after_drive():
    spec = spec_of(
        paths=[{"scene": ["procedural:1", "procedural:2"], "seeds": [1, 2]}],
        factors=[{"stride": [0, 1]}, {"speed": [0.1, 0.2]}],
    )
    runs = plan_study(spec)
    drives = [run.drive.drive_id for run in runs]
    assert drives == [drive_id for drive_id in dict.fromkeys(drives) for _ in range(2)]
    assert len(set(drives)) == 8
    assert [run.drive.path for run in runs[::4]] == [f"procedural:{k} #{seed}" for k in (1, 2) for seed in (1, 2)]


def test_each_path_is_rendered_once_for_all_that_changes_only_the_slam():
    slam = [
        {"stride": [0, 3]},
        {"loop_closure": [True, False]},
        {"slam_options.features": [500, 1000]},
        {"slam_sync": ["lockstep", "realtime"], "busy_processes": [0, 2]},
    ]
    runs = plan_study(spec_of(factors=slam, repeats=2))
    assert len(runs) == 32
    assert len({run.drive.drive_id for run in runs}) == 1
    assert runs[0].drive.drive_id == plan_study(spec_of())[0].drive.drive_id
    assert {run.busy_processes for run in runs} == {0, 2}


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("speed", 0.3),
        ("fps", 10),
        ("agent", "patrol"),
        ("max_episode_steps", 50),
        ("scene_options.texture", 0),
        ("depth_noise", "icl_nuim"),
        ("camera", "small"),
    ],
)
def test_what_changes_the_frames_makes_another_drive(name, value):
    changed, usual = (plan_study(spec_of(fixed=fixed))[0] for fixed in ({name: value}, {}))
    assert changed.drive.drive_id != usual.drive.drive_id
    assert changed.run_id.split("/")[1] == usual.run_id.split("/")[1]


def test_ids_do_not_depend_on_how_a_thing_is_written():
    plain = plan_study(spec_of(fixed={"speed": 1, "camera": "small", "slam_options.features": 1000}))
    other = plan_study(
        spec_of(
            name="other",
            paths=[{"scene": "procedural:1", "seeds": 1, "dataset": "homes"}],
            fixed={
                "slam_options.features": "1000",
                "camera": "small",
                "speed": 1.0,
                "stride": 0,
                "scene_options.size": "medium",
            },
        )
    )
    assert plain[0].run_id == other[0].run_id


def test_an_id_tells_a_person_what_it_is():
    spec = spec_of(factors=[{"speed": [0.4]}, {"stride": [2], "loop_closure": [False]}])
    expected = r"procedural-1-1_speed-0\.4_[0-9a-f]{8}/orbslam3_stride-2_loop_closure-off_[0-9a-f]{8}_r1"
    assert re.fullmatch(expected, plan_study(spec)[0].run_id)
    slams = plan_study(spec_of(factors=[{"slam": ["opencv", "groundtruth"]}]))
    assert [re.sub("_[0-9a-f]{8}_r1", "", run.run_id.split("/")[1]) for run in slams] == ["opencv", "groundtruth"]


def test_the_keywords_are_those_that_the_environment_takes():
    fixed = {"scene_options.size": "small", "camera": "small", "turn_rate": None, "slam_options.levels": 6}
    run = plan_study(spec_of(fixed=fixed))[0]
    env = gym.make("HomeRobot-v0", **run.drive.params)
    assert env.unwrapped.params.scene_options == {"size": "small"}
    assert env.unwrapped.params.camera.width == 320
    env.close()
    assert SlamParams.checked(run.slam).slam_options == {"levels": 6}


def test_a_scene_file_has_its_own_name_and_dataset(tmp_path):
    house, suncg = tmp_path / "<script>alert(1)</script>.glb", tmp_path / "0004d5" / "house.json"
    for file in (house, suncg):
        file.parent.mkdir(parents=True)
        file.touch()
    drives = [run.drive for run in plan_study(spec_of(paths=[{"scene": [str(house), str(suncg)], "seeds": 7}]))]
    assert [drive.path for drive in drives] == ["<script>alert(1)</script>.glb #7", "0004d5/house.json #7"]
    assert [drive.dataset for drive in drives] == ["script>", "house"]
    assert all(re.fullmatch(r"[A-Za-z0-9._-]{1,49}", drive.drive_id) for drive in drives)


def test_recorded_sequences_are_drives_of_their_own(tmp_path):
    for name in ("tum/fr1", "tum/fr2", "icl/office"):
        (tmp_path / name).mkdir(parents=True)
    spec = spec_of(
        paths=[
            {"sequence": [f"{tmp_path}/tum/fr1", f"{tmp_path}/tum/fr2"]},
            {"sequence": f"{tmp_path}/icl/office", "dataset": "ICL"},
        ],
        factors=[{"stride": [0, 1]}],
    )
    runs = plan_study(spec)
    assert [(run.drive.path, run.drive.dataset) for run in runs[::2]] == [
        ("fr1", "tum"),
        ("fr2", "tum"),
        ("office", "ICL"),
    ]
    assert (runs[0].drive.sequence, runs[0].drive.params) == (f"{tmp_path}/tum/fr1", {})


def test_two_paths_of_one_name_are_refused(tmp_path):
    for name in ("a/seq", "b/seq"):
        (tmp_path / name).mkdir(parents=True)
    with pytest.raises(ConfigError, match=r"expected paths of different names, got 'seq' for .*a/seq and .*b/seq"):
        plan_study(spec_of(paths=[{"sequence": [f"{tmp_path}/a/seq", f"{tmp_path}/b/seq"]}]))


@pytest.mark.parametrize(
    ("more", "line", "told"),
    [
        ("factors:\n- stride: [0]\n- speed: [0.2, -1]", 6, "speed: the value should be greater than 0, got -1"),
        ("factors:\n- stride: [0, -1]", 5, "stride: the value should be greater than or equal to 0"),
        ("factors:\n- stride: [0]\n- slam: [orbslam3, orbslm3]", 6, "unknown slam backend 'orbslm3'"),
        (
            "fixed: {slam: 'beside:Mine'}",
            4,
            "No module named 'beside'; install its package, or set PYTHONPATH to its folder",
        ),
        ("fixed:\n  stride: 0\n  slam: orbslm3", 6, "unknown slam backend 'orbslm3'"),
        (
            "fixed: {slam: opencv}\nfactors:\n- loop_closure: [off, on]",
            6,
            "expected loop_closure as one of None, False",
        ),
        ("factors:\n- loop_closure: [on, maybe]", 5, "loop_closure"),
        ("factors:\n- slam_options.feature: [1]", 5, "unknown slam option 'feature'; did you mean 'features'?"),
        ("fixed:\n  slam_options:\n    levels: 8\n    features: 1", 7, "slam option 'features'"),
        ("factors:\n- scene_options.texture: [1, 5]", 5, "scene option 'texture'"),
        ("factors:\n- fps: [30]\n- agent: [patrl]", 6, "did you mean 'patrol'?"),
        ("fixed: {agent: cautious}", 4, "without a SLAM, one of follower, lap, look_around, patrol, got 'cautious'"),
        ("repeats: 9999999999999999", 4, "repeats: the value should be less than or equal to 10000"),
        (
            "repeats: 10000\nfactors:\n- stride: [0, 1, 2]\n- speed: [0.1, 0.2, 0.3, 0.4]\n"
            "- fps: [10, 11, 12]\n- brightness: [1, 2, 3]",
            4,
            "expected at most 1,000,000 runs, got 1,080,000",
        ),
        ("fixed: {busy_processes: -1}", 4, "busy_processes"),
        ("fixed: {max_episode_steps: 0}", 4, "max_episode_steps"),
        ("factors:\n- depth_noise: [none, icl]", 5, "unknown depth_noise 'icl'; did you mean 'icl_nuim'?"),
        ("factors:\n- fps: [30, 1]\n- speed: [1, 10]", 5, "expected at most 0.4 m between two frames"),
        ("fixed: {occupancy_map: no.yaml}", 4, "no.yaml', which is not there"),
        ("factors:\n- slam_options.vocabulary: [no.txt]", 5, "no.txt"),
        ("factors:\n- slam_options.features: ['1000', 1000]", 4, "expected runs that differ"),
    ],
)
def test_a_level_that_cannot_be_is_told_with_its_line(written, more, line, told):
    path = written(PATHS + more + "\n")
    with pytest.raises(ConfigError) as error:
        plan_study(read_study(path))
    message = str(error.value)
    assert message.startswith(f"{path}:{line}: ")
    assert told in message
    assert "\n" not in message


@pytest.mark.parametrize(
    ("group", "told"),
    [
        ("{scene: procedual:1, seeds: 1}", "unknown scene 'procedual'; did you mean 'procedural'?"),
        ("{scene: procedural:x, seeds: 1}", "expected a seed of 0 or more, got 'x'"),
        ("{scene: missing.glb, seeds: 1}", "missing.glb', which is not there"),
        ("{scene: '<script>alert(1)</script>', seeds: 1}", "<script>alert(1)</script>': expected a file ending in"),
        ("{sequence: missing}", "missing', which is none"),
    ],
)
def test_a_path_that_is_not_there_is_told_with_its_line(written, group, told):
    path = written(f"name: s\npaths:\n- {{scene: procedural, seeds: 1}}\n- {group}\n")
    with pytest.raises(ConfigError) as error:
        plan_study(read_study(path))
    assert str(error.value).startswith(f"{path}:4: ")
    assert told in str(error.value)


def test_options_are_checked_against_the_backend_of_their_combination(written):
    both = "factors:\n- slam: [orbslam3, opencv]\n  slam_options.features: [500, 600]\n"
    with pytest.raises(ConfigError, match=r"study\.yaml:5: unknown slam option 'features'"):
        plan_study(read_study(written(PATHS + both)))


def test_a_written_study_gives_the_same_plan(written, tmp_path):
    spec = read_study(
        written(
            PATHS + "fixed: {agent: patrol, camera: small, slam_options: {features: 500}}\nrepeats: 2\n"
            "factors:\n- brightness: [1e-1, 1]\n- loop_closure: [on, off]\n  stride: [0, 2]\n"
        )
    )
    assert plan_study(read_study(write_study(spec, tmp_path / "out" / "study.yaml"))) == plan_study(spec)


def test_a_hundred_thousand_runs_are_all_different():
    spec = spec_of(
        paths=[{"scene": [f"procedural:{k}" for k in range(50)], "seeds": [1, 2]}],
        factors=[{"speed": [k / 10 for k in range(1, 11)]}, {"stride": list(range(10))}],
        repeats=10,
    )
    runs = plan_study(spec)
    assert len({run.run_id for run in runs}) == len(runs) == run_count(spec) == 100_000
