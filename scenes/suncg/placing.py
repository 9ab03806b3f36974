"""Where the nodes of a house.json are: from the frame of a model to that of the level, z up and in metres."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from trimesh.transformations import transform_points

from slamgym.scenes.importing.pieces import Piece
from slamgym.scenes.suncg.house_file import Frame, Node
from slamgym.scenes.suncg.models import Models
from slamgym.types import FloatArray

RIGHT_ANGLE = 0.01
"""Largest cosine between the file's directions up and front."""


def level_frame(frame: Frame, defects: list[str]) -> FloatArray:
    """T_level_scene (4, 4): turns the file's up to z and its front to -y, and scales to metres.

    With SUNCG's own directions it is (x, y, z) -> (x, -z, y). defects: gets a line when they make no frame.
    """
    up, front = (np.array(v) / max(float(np.linalg.norm(v)), 1e-12) for v in (frame.up, frame.front))
    if not (abs(up @ front) < RIGHT_ANGLE and up.any() and front.any()):
        defects.append(f"the house: expected up and front at right angles, got {frame.up} and {frame.front}; not used")
        up, front = np.array(Frame().up), np.array(Frame().front)
    across = np.cross(up, front)
    T = np.eye(4)
    T[:3, :3] = frame.scale * np.stack([across / np.linalg.norm(across), -front, up])
    return T


def node_frame(node: Node, defects: list[str]) -> FloatArray:
    """T_scene_model (4, 4) of a node. The mirroring is in it; defects: gets a line when isMirrored denies that."""
    T = np.array(node.transform).reshape(4, 4).T
    if node.mirrored and not _mirrors(T):
        defects.append(f"node {node.id}: isMirrored: expected 0, as its transform does not mirror, got 1; not used")
    return T


def placed_pieces(node: Node, models: Models, T_level_scene: FloatArray, defects: list[str]) -> Iterator[Piece]:
    """What a node shows, in the level's frame, named group/material; see `group_of`."""
    T = T_level_scene @ node_frame(node, defects)
    for kind, piece in models.of(node):
        yield replace(
            piece,
            name=f"{group_of(kind, node)}/{piece.material.name.replace('/', '_')}",
            vertices=transform_points(piece.vertices, T),
            faces=piece.faces[:, ::-1] if _mirrors(T) else piece.faces,
        )


def group_of(kind: str, node: Node) -> str:
    """What the names of the parts of one thing begin with."""
    return f"{kind}#{node.id}".replace("/", "_")


def _mirrors(T: FloatArray) -> bool:
    return bool(np.linalg.det(T[:3, :3]) < 0.0)
