"""Rigid transforms as (..., 4, 4) arrays; all arithmetic is SciPy's."""

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import RigidTransform, Rotation

from slamgym.types import FloatArray

# Columns are the optical axes (x right, y down, z forward) in the robot's body frame (x forward, y left, z up).
R_BODY_OPTICAL: FloatArray = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])


def inverse(T: FloatArray) -> FloatArray:
    """Inverse of rigid transforms (..., 4, 4)."""
    return RigidTransform.from_matrix(T).inv().as_matrix()


def from_quaternion(translation: ArrayLike, quaternion_xyzw: ArrayLike) -> FloatArray:
    """Transforms (N, 4, 4) from translations (N, 3), metres, and quaternions (N, 4) in the order x, y, z, w."""
    # Through RigidTransform a million of them would take four times as long, and 0.5 GB more.
    R = Rotation.from_quat(np.asarray(quaternion_xyzw, dtype=np.float64)).as_matrix()
    T = np.tile(np.eye(4), (len(R), 1, 1))
    T[:, :3, :3] = R
    T[:, :3, 3] = translation
    return T


def quaternion_xyzw(T: FloatArray) -> FloatArray:
    """Unit quaternions (..., 4) in the order x, y, z, w of transforms (..., 4, 4)."""
    return Rotation.from_matrix(T[..., :3, :3]).as_quat()


def rotation_angle(T: FloatArray) -> FloatArray:
    """Rotation angles (...), radians in [0, pi], of transforms (..., 4, 4)."""
    return np.asarray(Rotation.from_matrix(T[..., :3, :3]).magnitude())


def planar_pose(x: float, y: float, yaw: float, z: float = 0.0) -> FloatArray:
    """T_world_body (4, 4) of a body at (x, y, z), metres, turned by yaw, radians, about the vertical axis."""
    rotation = Rotation.from_euler("z", yaw)
    return RigidTransform.from_components([x, y, z], rotation).as_matrix()


def mast_camera_pose(x: float, y: float, yaw: float, camera_height: float) -> FloatArray:
    """T_world_cam (4, 4) of a camera that looks level and straight ahead, `camera_height` metres above the floor."""
    T_world_cam = planar_pose(x, y, yaw, camera_height)
    T_world_cam[:3, :3] = T_world_cam[:3, :3] @ R_BODY_OPTICAL
    return T_world_cam
