"""Evaluation: accuracy and robustness of estimated trajectories. Needs no simulator."""

from slamgym.eval.evaluation import evaluate
from slamgym.eval.reference import EvalParams
from slamgym.eval.trajectories import Trajectory, read_trajectory

__all__ = ["EvalParams", "Trajectory", "evaluate", "read_trajectory"]
