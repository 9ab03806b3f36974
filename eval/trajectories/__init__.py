"""Trajectories: their files, which poses of two belong together, how they move."""

from slamgym.eval.trajectories.association import associate
from slamgym.eval.trajectories.trajectory import Trajectory
from slamgym.eval.trajectories.tum import read_tum, write_tum

__all__ = ["Trajectory", "associate", "read_tum", "write_tum"]
