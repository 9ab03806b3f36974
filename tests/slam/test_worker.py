import os
from dataclasses import replace

import pytest

from slamgym.errors import TrajectoryWarning
from slamgym.slam.frame_buffer import FrameBuffer
from slamgym.slam.worker import Server

SCRIPT = "(echo 0.1 0 0 0 0 0 0 1; echo 0.2 nan 0 0 0 0 0 1; echo 0.4 0 0 0 0 0 0 1) > CameraTrajectory.txt"


def test_what_was_repaired_is_part_of_the_answer(config, frame):
    fed, options = frame(1), {"command": f"sh -c '{SCRIPT}'"}
    frames = FrameBuffer(config.camera)
    frames.write(fed)
    server = Server(os.dup(frames.fd))
    assert server.answer("start", "command", replace(config, options=options)) == (True, None)
    for stamp_ns in (100_000_000, 200_000_000):
        server.answer("track", stamp_ns, fed.T_world_cam)
    with pytest.warns(TrajectoryWarning) as logged:
        ok, (trajectory, told) = server.answer("finish")
    assert ok
    assert trajectory.stamps_ns.tolist() == [100_000_000]
    assert told[0].startswith("CameraTrajectory.txt:2: expected ")
    assert told[1] == "1 of 2 poses belong to no frame: left out"
    assert [str(one.message) for one in logged] == told
