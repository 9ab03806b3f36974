"""The oracle where the truth has holes. What it answers otherwise is tested with the session."""

from dataclasses import replace

import numpy as np

from slamgym.slam.session import SlamSession
from slamgym.types import SlamEvent, TrackingState

NOT_INITIALIZED, OK, LOST = TrackingState


def test_frames_without_truth_are_not_tracked(config, frame):
    known = [False, True, True, False, False, True, True]
    hole = np.full((4, 4), np.nan)
    frames = [frame(k) if is_known else replace(frame(k), T_world_cam=hole) for k, is_known in enumerate(known)]
    with SlamSession("groundtruth", config) as session:
        online = [session.track(f) for f in frames]
        final = session.finish()
    assert [r.state for r in online] == [NOT_INITIALIZED, OK, OK, LOST, LOST, OK, OK]
    assert {k: r.event for k, r in enumerate(online) if r.event} == {
        1: SlamEvent.INITIALIZED,
        3: SlamEvent.LOST,
        5: SlamEvent.RELOCALIZED,
    }
    assert [r.T_map_cam[0, 3] for r in online if r.state is OK] == [0.0, 1.0, 4.0, 5.0]
    assert all(np.isnan(r.T_map_cam).all() and r.map_id == -1 for r in online if r.state is not OK)
    assert final.stamps_ns.tolist() == [1, 2, 5, 6]
    np.testing.assert_array_equal(final.T_map_cam[:, 0, 3], [0.0, 1.0, 4.0, 5.0])
