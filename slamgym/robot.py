"""The robot: a differential drive with acceleration limits that bumps into the house. The only user of pybullet."""

import importlib
import os
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from math import cos, sin
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from slamgym.scenes.house import House

ROBOT_RADIUS = 0.20
ROBOT_HEIGHT = 0.90
MAX_ACCELERATION = 2.0
"""m/s^2, forward and backward."""
MAX_TURN_ACCELERATION = 12.0
"""rad/s^2: both wheels of a 0.34 m track at 2 m/s^2."""
GROUND_CLEARANCE = 0.03
"""metres; the body floats this high, as on wheels, so that rugs and thresholds are driven over."""
SUBSTEP = 1 / 240
"""seconds; Bullet's usual step."""
MAX_SHAPE_VERTICES = 30_000
"""Bullet loses triangles of a static mesh above some 40,000 vertices a shape."""


@dataclass(frozen=True, slots=True)
class RobotState:
    """Where the robot is and how it really moves. Metres, radians, seconds; yaw counter-clockwise from the x axis."""

    x: float
    y: float
    yaw: float
    speed: float
    yaw_rate: float
    collided: bool


class DifferentialDrive:
    """A vertical cylinder in a Bullet world that moves in the plane as two driven wheels would move it.

    Wheels are not modelled: the body gets the velocity that they would give it, within the acceleration limits, and
    Bullet's contacts with the solid parts of the house then take away what the obstacles forbid.
    """

    def __init__(self, house: House) -> None:
        self._bullet = _import_bullet()
        self._world: int = self._bullet.connect(self._bullet.DIRECT)
        for vertices, faces in _obstacles(house):
            self._add_obstacle(vertices, faces)
        self._body: int | None = None
        self._state = RobotState(0.0, 0.0, 0.0, 0.0, 0.0, collided=False)

    def reset(self, x: float, y: float, yaw: float) -> RobotState:
        """Put the robot down at rest."""
        bullet = self._bullet
        # A new body each time: a moved one would bring old contacts along, and the same drive would differ.
        if self._body is not None:
            bullet.removeBody(self._body, physicsClientId=self._world)
        height = ROBOT_HEIGHT - GROUND_CLEARANCE
        shape = bullet.createCollisionShape(
            bullet.GEOM_CYLINDER, radius=ROBOT_RADIUS, height=height, physicsClientId=self._world
        )
        self._body = bullet.createMultiBody(
            baseMass=20.0,
            baseCollisionShapeIndex=shape,
            basePosition=[x, y, GROUND_CLEARANCE + height / 2],
            baseOrientation=[0.0, 0.0, sin(yaw / 2), cos(yaw / 2)],
            physicsClientId=self._world,
        )
        bullet.changeDynamics(
            self._body,
            -1,
            localInertiaDiagonal=[0.0, 0.0, 0.5],  # zero means infinite: the body never tips over
            lateralFriction=0.2,
            linearDamping=0.0,
            angularDamping=0.0,
            activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING,
            physicsClientId=self._world,
        )
        self._state = RobotState(x, y, yaw, 0.0, 0.0, collided=False)
        return self._state

    def step(self, speed: float, yaw_rate: float, duration: float) -> RobotState:
        """Drive for `duration` seconds towards the commanded speed (m/s) and yaw rate (rad/s)."""
        substeps = max(1, round(duration / SUBSTEP))
        dt = duration / substeps
        self._bullet.setTimeStep(dt, physicsClientId=self._world)
        state = self._state
        for _ in range(substeps):
            state = self._substep(
                _approach(state.speed, speed, MAX_ACCELERATION * dt),
                _approach(state.yaw_rate, yaw_rate, MAX_TURN_ACCELERATION * dt),
                state,
                dt,
            )
        self._state = state
        return state

    def _substep(self, speed: float, yaw_rate: float, before: RobotState, dt: float) -> RobotState:
        bullet, world = self._bullet, self._world
        # The heading in the middle of the step makes the drive along a circle exact to second order.
        heading = before.yaw + yaw_rate * dt / 2
        bullet.resetBaseVelocity(
            self._body,
            [speed * cos(heading), speed * sin(heading), 0.0],
            [0.0, 0.0, yaw_rate],
            physicsClientId=world,
        )
        bullet.stepSimulation(physicsClientId=world)
        (x, y, _), (_, _, qz, qw) = bullet.getBasePositionAndOrientation(self._body, physicsClientId=world)
        (vx, vy, _), (_, _, wz) = bullet.getBaseVelocity(self._body, physicsClientId=world)
        collided = bool(bullet.getContactPoints(bodyA=self._body, physicsClientId=world))
        yaw = before.yaw + _wrapped(2 * float(np.arctan2(qz, qw)) - before.yaw)
        return RobotState(x, y, yaw, vx * cos(yaw) + vy * sin(yaw), wz, collided)

    def close(self) -> None:
        """Free the Bullet world; may be called again."""
        if self._bullet.isConnected(physicsClientId=self._world):
            self._bullet.disconnect(physicsClientId=self._world)

    def _add_obstacle(self, vertices: NDArray[np.float32], faces: NDArray[np.int32]) -> None:
        bullet = self._bullet
        shape = bullet.createCollisionShape(
            bullet.GEOM_MESH,
            vertices=vertices.tolist(),
            indices=faces.ravel().tolist(),
            flags=bullet.GEOM_FORCE_CONCAVE_TRIMESH,  # Bullet takes the convex hull without it
            physicsClientId=self._world,
        )
        bullet.createMultiBody(baseMass=0.0, baseCollisionShapeIndex=shape, physicsClientId=self._world)


def _obstacles(house: House) -> Iterator[tuple[NDArray[np.float32], NDArray[np.int32]]]:
    """Triangles of solid parts within the robot's height, in pieces that Bullet can take."""
    for part in house.parts:
        if not part.solid:
            continue
        z = part.vertices[part.faces][:, :, 2]
        faces = part.faces[(z.max(axis=1) > GROUND_CLEARANCE) & (z.min(axis=1) < ROBOT_HEIGHT)]
        for start in range(0, len(faces), MAX_SHAPE_VERTICES // 3):
            used, index = np.unique(faces[start : start + MAX_SHAPE_VERTICES // 3], return_inverse=True)
            yield part.vertices[used], index.astype(np.int32)


@cache
def _import_bullet() -> Any:
    """Import pybullet without the line that it writes from C to the standard error, into progress bars and logs."""
    stderr = os.dup(2)
    with Path(os.devnull).open("w") as nowhere:
        os.dup2(nowhere.fileno(), 2)
        try:
            return importlib.import_module("pybullet")
        finally:
            os.dup2(stderr, 2)
            os.close(stderr)


def _approach(value: float, target: float, most: float) -> float:
    return value + min(max(target - value, -most), most)


def _wrapped(angle: float) -> float:
    """The same angle within [-pi, pi)."""
    return float((angle + np.pi) % (2 * np.pi) - np.pi)
