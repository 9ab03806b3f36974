import cv2
import numpy as np
import pytest

from slamgym.camera import PinholeCamera
from slamgym.geometry import mast_camera_pose
from slamgym.types import Frame

CAMERA = PinholeCamera(8, 6, 7.5, 7.25, 3.5, 2.5, distortion=(0.1, -0.2, 0.001, -1e-5))
CAMERA_YAML = "{width: 8, height: 6, fx: 7.5, fy: 7.25, cx: 3.5, cy: 2.5, fps: 10}\n"


@pytest.fixture(scope="session")
def camera():
    return CAMERA


@pytest.fixture(scope="session")
def make_frames():
    """make_frames(n): frames of noise, 33 333 333 ns apart from 0 on, that drive along x."""

    def make(n, camera=CAMERA):
        rng = np.random.default_rng(n)
        size = (camera.height, camera.width)
        return [
            Frame(
                stamp_ns=k * 33_333_333,
                rgb=rng.integers(256, size=(*size, 3), dtype=np.uint8),
                depth=rng.uniform(0.3, 13.0, size=size).astype(np.float32),
                T_world_cam=mast_camera_pose(0.1 * k, 0.0, 0.02 * k, 1.0),
            )
            for k in range(n)
        ]

    return make


@pytest.fixture
def tum_folder(tmp_path):
    """tum_folder(rgb_s, depth_s, true_s): a sequence that OpenCV and plain text made, without a line of ours.

    Frame k is all (k, 100, 200) in RGB and k metres deep; the camera is at x = t, looking along x.
    """

    def make(rgb_s=(1.0, 1.1, 1.2), depth_s=(1.0, 1.1, 1.2), true_s=(), name="mine", camera_yaml=CAMERA_YAML):
        folder = tmp_path / name
        for kind, stamps in (("rgb", rgb_s), ("depth", depth_s)):
            (folder / kind).mkdir(parents=True)
            for k, stamp in enumerate(stamps):
                bgr = np.full((6, 8, 3), (200, 100, k), dtype=np.uint8)
                image = bgr if kind == "rgb" else np.full((6, 8), 5000 * k, dtype=np.uint16)
                assert cv2.imwrite(str(folder / kind / f"{stamp}.png"), image)
            lines = [f"{stamp} {kind}/{stamp}.png\n" for stamp in stamps]
            (folder / f"{kind}.txt").write_text("# timestamp filename\n" + "".join(lines))
        if true_s:
            poses = [f"{t} {t} 0 1 -0.5 0.5 -0.5 0.5\n" for t in true_s]
            (folder / "groundtruth.txt").write_text("".join(poses))
        if camera_yaml:
            (folder / "camera.yaml").write_text(camera_yaml)
        return folder

    return make
