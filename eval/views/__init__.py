"""Views: what one image, or the step from one to the next, offers to a SLAM."""

from slamgym.eval.views.depths import median_depth_m, overlap, valid_depth
from slamgym.eval.views.images import brightness, keypoint_count, sharpness

__all__ = ["brightness", "keypoint_count", "median_depth_m", "overlap", "sharpness", "valid_depth"]
