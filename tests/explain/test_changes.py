from dataclasses import replace

import numpy as np
import pytest

from slamgym.explain.changes import CHANGES, Setup, changes_of
from slamgym.params import DriveParams, SlamInLoopParams
from slamgym.stage import load_stage


def setup(busy_processes=0, slam=(), **drive):
    return Setup(DriveParams.checked(drive), SlamInLoopParams.checked(dict(slam)), busy_processes)


def test_what_does_not_apply_is_left_out():
    assert list(changes_of(setup())) == ["half the turn rate", "half the speed", "more light", "richer texture"]
    everything = setup(
        1, {"stride": 2, "slam_sync": "free"}, depth_noise="icl_nuim", rgb_noise=2.0, motion_blur=0.3, speed=0.4
    )
    assert list(changes_of(everything)) == list(CHANGES)


def test_each_changes_one_thing():
    base = setup(
        1, {"stride": 2, "slam_sync": "free"}, depth_noise="icl_nuim", rgb_noise=2.0, motion_blur=0.3, speed=0.4
    )
    expected = {
        "half the turn rate": {"turn_rate": 0.8},
        "half the speed": {"speed": 0.2, "turn_rate": 1.6},
        "every frame": {"stride": 0},
        "more light": {"brightness": 2.0},
        "richer texture": {"scene_options": {"texture": 2.0}},
        "no depth noise": {"depth_noise": "none"},
        "no image noise": {"rgb_noise": 0.0},
        "no motion blur": {"motion_blur": 0.0},
        "lock-step": {"slam_sync": "lockstep"},
        "an idle computer": {"busy_processes": 0},
    }
    assert expected.keys() == CHANGES.keys()
    for name, changed in changes_of(base).items():
        assert differing(base, changed) == expected[name], name


def differing(base, changed):
    before, after = values(base), values(changed)
    return {name: after[name] for name in before if before[name] != after[name]}


def values(of):
    return {**of.drive.model_dump(), **of.slam.model_dump(), "busy_processes": of.busy_processes}


def test_half_the_turn_rate_is_half_of_what_it_turned_at():
    slow, straight = (replace(setup(turn_rate=6.0), turned_radps=radps) for radps in (1.8, 0.05))
    changed = CHANGES["half the turn rate"](slow)
    assert changed is not None
    assert changed.drive.turn_rate == 0.9
    assert CHANGES["half the turn rate"](straight) is None


@pytest.mark.parametrize(("before", "after"), [(0.1, 1.0), (0.7, 1.4), (1.0, 2.0), (3.0, 4.0), (4.0, None)])
def test_more_light(before, after):
    changed = CHANGES["more light"](setup(brightness=before))
    assert (None if changed is None else changed.drive.brightness) == after


def test_richer_texture_only_where_the_scene_has_some_and_it_can_be_richer(tmp_path):
    assert CHANGES["richer texture"](setup(scene_options={"texture": 2.0})) is None
    richer = CHANGES["richer texture"](setup(scene="procedural:3", scene_options={"texture": 0.5, "clutter": 0.0}))
    assert richer is not None
    assert richer.drive.scene_options == {"texture": 2.0, "clutter": 0.0}
    (tmp_path / "box.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert CHANGES["richer texture"](setup(scene=str(tmp_path / "box.obj"))) is None


@pytest.mark.slow
def test_textures_leave_the_paths_as_they_are():
    for seed in range(4):
        grids = [
            load_stage(
                DriveParams(scene=f"procedural:{seed}", lighting="flat", scene_options={"texture": texture})
            ).grid
            for texture in (0.0, 2.0)
        ]
        assert np.array_equal(grids[0].occupied, grids[1].occupied)
