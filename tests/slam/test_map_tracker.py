import numpy as np
import pytest

from slamgym.slam.map_tracker import MapTracker, final_trajectory
from slamgym.types import SlamEvent, SlamTrajectory, TrackingState

E = SlamEvent
NI, OK, LOST = TrackingState


def run(states, printed=None):
    """(state, map id, event) of each frame. printed: frame -> text that appeared before that frame was tracked."""
    maps = MapTracker()
    answers = []
    for k, state in enumerate(states.split()):
        maps.read((printed or {}).get(k, ""))
        answers.append((*maps.update(state), maps.map_id))
    return maps, answers


def test_initialisation():
    _, answers = run("NO_IMAGES_YET NOT_INITIALIZED OK OK OK_KLT")
    assert answers == [(NI, E.NONE, -1)] * 2 + [(OK, E.INITIALIZED, 0)] + [(OK, E.NONE, 0)] * 2


def test_found_again_in_the_same_map():
    maps, answers = run("OK RECENTLY_LOST RECENTLY_LOST OK OK")
    assert answers[1:] == [(LOST, E.LOST, 0), (LOST, E.NONE, 0), (OK, E.RELOCALIZED, 0), (OK, E.NONE, 0)]
    assert maps.thrown_away == set()


def test_new_map_after_a_long_loss():
    maps, answers = run("OK RECENTLY_LOST NO_IMAGES_YET NOT_INITIALIZED NOT_INITIALIZED OK OK")
    assert [a[1] for a in answers] == [E.INITIALIZED, E.LOST, E.NONE, E.NONE, E.NONE, E.NEW_MAP, E.NONE]
    assert [a[0] for a in answers[1:5]] == [LOST] * 4
    assert answers[-1][2] == 1
    assert maps.thrown_away == set()


@pytest.mark.parametrize("between", ["LOST", "LOST NOT_INITIALIZED", "RECENTLY_LOST LOST NOT_INITIALIZED"])
def test_map_thrown_away(between):
    maps, answers = run(f"OK {between} OK")
    assert answers[-1] == (OK, E.MAP_RESET, 1)
    assert maps.thrown_away == {0}


def test_merge_goes_back_to_the_older_map_and_later_ids_stay_right():
    created, merged = "Creation of new map with id: {}\n", "*Merge detected\nChange to map with id: {}\n"
    _, answers = run(
        "OK NO_IMAGES_YET OK OK NO_IMAGES_YET OK OK",
        {0: created.format(0), 2: created.format(1), 3: merged.format(0), 5: created.format(2), 6: merged.format(1)},
    )
    # The merged map took the atlas id 1, so the second merge is with our map 0 again.
    assert [a[2] for a in answers] == [0, -1, 1, 0, -1, 2, 0]
    assert [a[1] for a in answers if a[0] is OK] == [E.INITIALIZED, E.NEW_MAP, E.MAPS_MERGED, E.NEW_MAP, E.MAPS_MERGED]


def test_merge_after_a_reset_that_kept_the_atlas_id():
    _, answers = run(
        "OK NO_IMAGES_YET OK LOST OK OK",
        {0: "Creation of new map with id: 0", 2: "Creation of new map with id: 1", 5: "Change to map with id: 0"},
    )
    assert [a[2] for a in answers] == [0, -1, 1, -1, 2, 0]


def test_loop_that_closes_while_lost_is_told_later():
    _, answers = run("OK RECENTLY_LOST OK OK OK", {2: "*Loop detected\n"})
    assert [a[1] for a in answers] == [E.INITIALIZED, E.LOST, E.RELOCALIZED, E.LOOP_CLOSED, E.NONE]


def trajectory(stamps, ids, x=0.0):
    T = np.tile(np.eye(4), (len(stamps), 1, 1))
    T[:, 0, 3] = x
    return SlamTrajectory(np.array(stamps, np.int64), T, np.array(ids, np.int64))


def test_final_takes_saved_poses_of_frames_that_were_ok():
    online = trajectory([10, 20, 30], [0, 0, 0])
    saved = trajectory([10, 20, 20, 25, 30], [0] * 5, x=[1.0, 2.0, 99.0, 98.0, 3.0])  # 25 was lost, 20 comes twice
    final = final_trajectory(online, saved, set())
    assert final.stamps_ns.tolist() == [10, 20, 30]
    assert final.T_map_cam[:, 0, 3].tolist() == [1.0, 2.0, 3.0]


def test_final_gives_merged_maps_one_id_and_keeps_other_maps():
    online = trajectory([1, 2, 3, 4, 5, 6], [0, 1, 1, 2, 2, 2])
    final = final_trajectory(online, trajectory([1, 2, 3], [0] * 3, x=5.0), set())
    assert final.map_id.tolist() == [1, 1, 1, 2, 2, 2]
    assert final.T_map_cam[:, 0, 3].tolist() == [5.0] * 3 + [0.0] * 3


def test_final_leaves_out_what_the_slam_no_longer_has():
    online = trajectory([1, 2, 3, 4], [0, 1, 1, 2])
    final = final_trajectory(online, trajectory([2], [0], x=5.0), thrown_away={2})
    # 3 is of the biggest map, but was not saved with it: its pose belongs to no map that is left.
    assert final.stamps_ns.tolist() == [1, 2]
