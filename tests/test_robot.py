import numpy as np
import pytest
import trimesh

from slamgym.robot import MAX_ACCELERATION, ROBOT_RADIUS, DifferentialDrive
from slamgym.scenes.house import House, Material, Part


def box(name, size, centre, solid=True):
    mesh = trimesh.creation.box(size)
    mesh.apply_translation(centre)
    vertices = mesh.vertices.astype(np.float32)
    return Part(name, Material(name), vertices, mesh.faces.astype(np.int32), solid=solid)


@pytest.fixture
def robot():
    wall = box("wall", (0.2, 4.0, 2.0), (2.1, 0.0, 1.0))  # its near face is at x = 2
    shelf = box("shelf", (0.2, 4.0, 0.2), (-2.0, 0.0, 1.5))  # above the robot
    rug = box("rug", (1.0, 1.0, 0.5), (0.0, -2.0, 0.2), solid=False)
    robot = DifferentialDrive(House("boxes", (wall, shelf, rug)))
    yield robot
    robot.close()
    robot.close()


def drive(robot, speed, yaw_rate, seconds, fps=30.0):
    return [robot.step(speed, yaw_rate, 1 / fps) for _ in range(round(seconds * fps))]


def test_accelerates_within_its_limit(robot):
    robot.reset(0.0, 0.0, np.pi / 2)
    states = drive(robot, 0.5, 0.0, 1.0)
    gains = np.diff([0.0] + [state.speed for state in states]) * 30
    assert gains.max() == pytest.approx(MAX_ACCELERATION, rel=1e-3)
    assert states[-1].speed == pytest.approx(0.5)
    ramp_s = 0.5 / MAX_ACCELERATION
    assert states[-1].y == pytest.approx(0.5 * (1.0 - ramp_s / 2), abs=2e-3)


def test_drives_a_circle_of_the_commanded_radius(robot):
    robot.reset(0.0, 0.0, 0.0)
    drive(robot, 0.2, 0.5, 1.0)
    points = np.array([(s.x, s.y) for s in drive(robot, 0.2, 0.5, 2 * np.pi / 0.5)])
    centre = (points.max(axis=0) + points.min(axis=0)) / 2
    assert np.linalg.norm(points - centre, axis=1) == pytest.approx(0.4, abs=2e-3)


@pytest.mark.parametrize("fps", [10.0, 30.0, 60.0])
def test_is_stopped_by_a_wall(robot, fps):
    robot.reset(0.5, 0.0, 0.0)
    states = drive(robot, 1.0, 0.0, 4.0, fps)
    assert states[-1].collided
    assert states[-1].x == pytest.approx(2.0 - ROBOT_RADIUS, abs=0.01)
    assert abs(states[-1].speed) < 0.05
    away = drive(robot, -0.5, 0.0, 1.0, fps)
    assert away[-1].x < states[-1].x - 0.2
    assert not away[-1].collided


def test_passes_below_what_hangs_and_over_what_is_not_solid(robot):
    robot.reset(0.0, 0.0, np.pi)
    assert drive(robot, 1.0, 0.0, 4.0)[-1].x < -2.5
    robot.reset(0.0, 0.0, -np.pi / 2)
    assert drive(robot, 1.0, 0.0, 4.0)[-1].y < -2.5


def test_same_commands_after_a_collision_give_the_same_drive(robot):
    def once():
        robot.reset(1.0, 0.3, 0.4)
        return drive(robot, 0.8, 0.3, 3.0) + drive(robot, -0.4, -1.0, 1.0)

    first = once()
    assert any(state.collided for state in first)
    assert once() == first
