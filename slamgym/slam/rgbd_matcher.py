"""The motion between two RGB-D frames, from OpenCV 5, verified.

It is the motion that makes their grey values agree (Steinbruecker, Sturm, Cremers, "Real-time visual odometry from
dense RGB-D images", ICCV workshops 2011), once alone and once together with the point-to-plane distances of ICP. Which
is better depends on the camera: perfect depth is exact where the texture is weak, depth taken at another moment than
the colour pulls the estimate off. So both are asked, and the images decide. OpenCV calls nearly every answer a success:
each one is verified here on its own grounds.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from slamgym.camera import PinholeCamera
from slamgym.geometry import inverse
from slamgym.slam.backend import SlamOptions
from slamgym.types import BoolArray, FloatArray, Frame, IntArray

EDGE_GRADIENT = 10.0
"""Grey levels a pixel from which a pixel counts as an edge; OpenCV's odometry uses the same."""
DEPTH_TOLERANCE = 0.05
"""Share of its depth by which a point may be off where it reappears; structured light is off by up to 3 % at 8 m."""
MOST_EDGES = 10_000
"""More edge pixels than these are thinned out evenly: they tell no more, and each one costs time."""


class MatchOptions(SlamOptions):
    """What is used of the images, and what an answer of OpenCV has to fulfil to be believed."""

    shrink: int = Field(2, ge=1, le=2, description="factor by which images are made smaller: quicker, coarser")
    max_depth: float = Field(6.0, gt=0, description="largest depth that is used, metres")
    max_translation: float = Field(0.3, gt=0, description="largest motion between two matched frames, metres")
    max_rotation_deg: float = Field(15.0, gt=0, le=180, description="largest turn between two matched frames, degrees")
    min_points: int = Field(300, ge=50, description="least edge pixels with a depth that have to reappear")
    min_share: float = Field(0.5, ge=0, le=1, description="least share of the edge pixels that have to reappear")
    min_correlation: float = Field(0.8, ge=-1, le=1, description="least correlation of their grey values")
    max_condition: float = Field(50.0, gt=1, description="how much less they may tell of one motion than of another")


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """A frame, undistorted and made smaller, with its N edge pixels that have a depth.

    grey: (h, w). depth: (h, w), metres, 0 where there is none. points: (N, 3), metres, in the camera's frame. levels:
    their grey values (N,). jacobian: (N, 6), see `grey_jacobian`. prepared: OpenCV's frame, None where the edge pixels
    are too few, or too much alike, to tell a motion.
    """

    stamp_ns: int
    grey: NDArray[np.uint8]
    depth: NDArray[np.float32]
    points: FloatArray
    levels: FloatArray
    jacobian: FloatArray
    prepared: Any

    @property
    def is_usable(self) -> bool:
        """Whether a motion can be told from it."""
        return self.prepared is not None


class Match(NamedTuple):
    """A motion between two views (4, 4), the edge pixels that confirm it, and the correlation of their grey values."""

    T_reference_view: FloatArray
    points: int
    correlation: float


class Matcher:
    """Prepares the frames of one camera and finds verified motions between them."""

    def __init__(self, camera: PinholeCamera, options: MatchOptions) -> None:
        self._options = options
        K = np.array([[camera.fx, 0.0, camera.cx], [0.0, camera.fy, camera.cy], [0.0, 0.0, 1.0]])
        self._undistort = _undistortion(camera, K) if camera.distortion else None
        # Pixel (x, y) of an image made smaller lies at (x, y) * shrink of the whole one.
        self._K: FloatArray = np.diag([1 / options.shrink, 1 / options.shrink, 1.0]) @ K
        settings = _settings(self._K, options)
        # The first one prepares the frames for both.
        self._estimators = [
            cv2.Odometry(kind, settings, cv2.ODOMETRY_ALGO_TYPE_COMMON)
            for kind in (cv2.ODOMETRY_TYPE_RGB_DEPTH, cv2.ODOMETRY_TYPE_RGB)
        ]

    def look(self, frame: Frame) -> View:
        grey, depth = self._images(frame)
        gradients = np.array([cv2.Sobel(grey, cv2.CV_64F, dx, 1 - dx, scale=1 / 8) for dx in (1, 0)])
        edges = (np.hypot(*gradients) >= EDGE_GRADIENT) & (depth > 0) & (depth <= self._options.max_depth)
        rows, columns = _thinned(*np.nonzero(edges))
        points = self._points(rows, columns, depth[rows, columns])
        jacobian = grey_jacobian(points, gradients[:, rows, columns], self._K)
        prepared = None
        if len(points) >= self._options.min_points and condition(jacobian) <= self._options.max_condition:
            prepared = cv2.OdometryFrame(depth, grey)
            self._estimators[0].prepareFrame(prepared)
        levels = grey[rows, columns].astype(np.float64)
        return View(frame.stamp_ns, grey, depth, points, levels, jacobian, prepared)

    def match(self, reference: View, view: View) -> Match | None:
        """The motion between two views that they confirm best, None where they confirm none."""
        if not (reference.is_usable and view.is_usable):
            return None
        answers = [estimator.compute(reference.prepared, view.prepared) for estimator in self._estimators]
        matches = [self._verified(reference, view, T) for success, T in answers if success and np.isfinite(T).all()]
        # On a tie the joint estimate, which comes first: the grey values hardly see its last millimetres.
        return max(filter(None, matches), key=lambda match: round(match.correlation, 2), default=None)

    def _verified(self, reference: View, view: View, T_view_reference: FloatArray) -> Match | None:
        options = self._options
        found, levels = self._reappearing(reference, view, T_view_reference)
        points = int(found.sum())
        if points < max(options.min_points, options.min_share * len(found)):
            return None
        correlation = float(np.corrcoef(reference.levels[found], levels)[0, 1])
        if not correlation >= options.min_correlation or condition(reference.jacobian[found]) > options.max_condition:
            return None
        return Match(inverse(T_view_reference), points, correlation)

    def _images(self, frame: Frame) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        grey: Any = cv2.cvtColor(frame.rgb, cv2.COLOR_RGB2GRAY)
        depth: Any = frame.depth
        if self._undistort is not None:
            # Beyond the image's border the grey is repeated, or the border would look like an edge.
            grey = cv2.remap(grey, *self._undistort, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
            depth = cv2.remap(depth, *self._undistort, cv2.INTER_NEAREST)
        if self._options.shrink == 2:
            grey, depth = cv2.pyrDown(grey), np.ascontiguousarray(depth[::2, ::2])
        return grey, depth

    def _points(self, rows: IntArray, columns: IntArray, depth: NDArray[np.float32]) -> FloatArray:
        pixels = np.stack([columns, rows, np.ones(len(rows))])
        points: FloatArray = depth * (np.linalg.inv(self._K) @ pixels)
        return points.T

    def _reappearing(self, reference: View, view: View, T_view_reference: FloatArray) -> tuple[BoolArray, FloatArray]:
        """Which of the reference's edge pixels (N,) reappear in the view, and the grey values where they do."""
        x, y, z = self._K @ (T_view_reference[:3, :3] @ reference.points.T + T_view_reference[:3, 3:])
        height, width = view.grey.shape
        columns, rows = np.rint(np.array([x, y]) / np.maximum(z, 1e-3))
        found = (z > 0) & (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
        pixels = rows[found].astype(np.int64), columns[found].astype(np.int64)
        # A depth of 0, where nothing was measured, agrees with none.
        agrees = np.abs(view.depth[pixels] - z[found]) <= DEPTH_TOLERANCE * z[found]
        found[found] = agrees
        return found, view.grey[pixels][agrees].astype(np.float64)


def grey_jacobian(points: FloatArray, gradients: FloatArray, K: FloatArray) -> FloatArray:
    """How the grey value where each point is seen changes with the motion of the points (N, 6).

    points: (N, 3), metres, in the camera's frame. gradients: (2, N), grey levels a pixel along x and y. K: (3, 3).
    Columns: grey levels a metre of translation along x, y, z, and a metre of displacement, at the median depth, by
    rotation about x, y, z.
    """
    x, y, z = points.T
    u, v, zero = x / z, y / z, np.zeros_like(z)
    depth = np.median(z) if len(z) else 1.0
    columns = K[0, 0] * np.array([1 / z, zero, -u / z, -u * v / depth, (1 + u * u) / depth, -v / depth])
    rows = K[1, 1] * np.array([zero, 1 / z, -v / z, -(1 + v * v) / depth, u * v / depth, u / depth])
    changes: FloatArray = gradients[0] * columns + gradients[1] * rows
    return changes.T


def condition(jacobian: FloatArray) -> float:
    """Ratio of the largest to the smallest singular value of a Jacobian (N, 6); infinite where it leaves a motion open.

    A bare wall, or one edge alone, lets the camera slide along it unseen.
    """
    eigenvalues = np.linalg.eigvalsh(jacobian.T @ jacobian)
    least = max(float(eigenvalues[0]), 0.0)
    return float(np.sqrt(eigenvalues[-1] / least)) if least > 0.0 else np.inf


def _thinned(rows: IntArray, columns: IntArray) -> tuple[IntArray, IntArray]:
    step = -(-len(rows) // MOST_EDGES) or 1
    return rows[::step], columns[::step]


def _undistortion(camera: PinholeCamera, K: FloatArray) -> tuple[Any, Any]:
    """Where in the distorted image each pixel of an image without distortion, with the same K, is to be read."""
    size = (camera.width, camera.height)
    distortion = np.array(camera.distortion)
    return cv2.initUndistortRectifyMap(K, distortion, None, K, size, cv2.CV_16SC2)


def _settings(K: FloatArray, options: MatchOptions) -> Any:
    settings = cv2.OdometrySettings()
    settings.setCameraMatrix(K.astype(np.float32))
    settings.setMaxDepth(options.max_depth)
    # Points whose depths differ by more are never paired: OpenCV's own 0.07 m fails where the camera moves faster.
    settings.setMaxDepthDiff(0.2)
    settings.setMaxTranslation(options.max_translation)
    settings.setMaxRotation(options.max_rotation_deg)
    return settings
