"""Trajectories: their files, which poses of two belong together, how they move."""

from slamgym.eval.trajectories.association import associate, match_stamps
from slamgym.eval.trajectories.attributes import SequenceAttributes, sequence_attributes, step_sizes
from slamgym.eval.trajectories.files import FORMATS, guess_format, needs_times, read_trajectory
from slamgym.eval.trajectories.interpolation import fill_holes, find_holes, interpolate
from slamgym.eval.trajectories.stamps import read_stamps, write_stamps
from slamgym.eval.trajectories.trajectory import Trajectory
from slamgym.eval.trajectories.tum import read_tum, write_tum

__all__ = [
    "FORMATS",
    "SequenceAttributes",
    "Trajectory",
    "associate",
    "fill_holes",
    "find_holes",
    "guess_format",
    "interpolate",
    "match_stamps",
    "needs_times",
    "read_stamps",
    "read_trajectory",
    "read_tum",
    "sequence_attributes",
    "step_sizes",
    "write_stamps",
    "write_tum",
]
