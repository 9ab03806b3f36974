"""SUNCG's Box: a cuboid about its own origin."""

import numpy as np

SIDES = ("+y", "-y", "-x", "+x", "+z", "-z")
"""The sides in the order of the node's materials, as SUNCGtoolbox has it."""
MTL_NAME = "box.mtl"
MTL = "".join(f"newmtl {side}\n" for side in SIDES)


def box_obj(dimensions: tuple[float, ...]) -> str:
    """The .obj of a box of these dimensions along x, y, z. Textures repeat each unit; upright ones stand upright."""
    size = np.array(dimensions)
    lines = [f"mtllib {MTL_NAME}"]
    for number, side in enumerate(SIDES):
        axis, sign = "xyz".index(side[1]), 1.0 if side[0] == "+" else -1.0
        # u x v is the outward normal; v is up on the upright sides.
        v = np.eye(3)[2 if axis == 1 else 1]
        u = np.cross(v, sign * np.eye(3)[axis])
        for s, t in ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)):
            corner = size / 2 * (sign * np.eye(3)[axis] + (2 * s - 1) * u + (2 * t - 1) * v)
            lines.append("v {!r} {!r} {!r}".format(*corner.tolist()))
            lines.append(f"vt {float(s * (size * np.abs(u)).sum())!r} {float(t * (size * np.abs(v)).sum())!r}")
        a, b, c, d = (4 * number + k for k in (1, 2, 3, 4))
        lines += [f"usemtl {side}", f"f {a}/{a} {b}/{b} {c}/{c}", f"f {a}/{a} {c}/{c} {d}/{d}"]
    return "\n".join(lines) + "\n"
