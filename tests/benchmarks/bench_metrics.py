"""What the metrics cost, against evo on the same poses in the same run. Run by `make bench`.

Both sides start from the same two arrays (N, 4, 4) and end with the same numbers. For evo this means its trajectory
objects (counted once), its alignment, and one run of its metric for the translation and one for the rotation; ours
checks the poses and gives both at once. evo's relative errors take about a minute.
"""

import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import numpy as np
from evo.core import metrics as evo
from evo.core.trajectory import PosePath3D
from rich.console import Console
from rich.table import Table
from scipy.spatial.transform import Rotation

from slamgym.eval.accuracy import ate, rpe_all_steps
from slamgym.geometry import from_quaternion
from slamgym.types import FloatArray

RPE_POSES, ATE_POSES, LONG_RPE_POSES = 1_000, 100_000, 10_000
TRANS, ROT = evo.PoseRelation.translation_part, evo.PoseRelation.rotation_angle_deg
Result = TypeVar("Result")
REPEATS = 5
"""Runs of ours, of which the quickest counts; evo runs once, long enough to average over a busy machine."""

PEAK_MEMORY = """
import resource
from bench_metrics import LONG_RPE_POSES, rpe_all_steps, walk
rpe_all_steps(*walk(LONG_RPE_POSES))
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


def walk(n: int) -> tuple[FloatArray, FloatArray]:
    """A random walk of 3 cm a frame, and an estimate of it that is off by about 1 cm and 0.01 radians."""
    rng = np.random.default_rng(0)
    turns = np.cumsum(0.05 * rng.normal(size=(n, 3)), axis=0)
    ref_T = from_quaternion(np.cumsum(0.03 * rng.normal(size=(n, 3)), axis=0), Rotation.from_rotvec(turns).as_quat())
    noise = Rotation.from_rotvec(0.01 * rng.normal(size=(n, 3)))
    noise_T = from_quaternion(0.01 * rng.normal(size=(n, 3)), noise.as_quat())
    return ref_T, ref_T[n // 2] @ ref_T @ noise_T


def evo_rpe_all_steps(ref_T: FloatArray, est_T: FloatArray) -> tuple[float, ...]:
    pair = PosePath3D(poses_se3=list(ref_T)), PosePath3D(poses_se3=list(est_T))
    means = []
    for relation, statistic in ((TRANS, evo.StatisticsType.rmse), (ROT, evo.StatisticsType.mean)):
        by_step = []
        for d in range(1, len(ref_T)):
            metric = evo.RPE(relation, d, evo.Unit.frames, all_pairs=True)
            metric.process_data(pair)
            by_step.append(metric.get_statistic(statistic))
        means.append(float(np.mean(by_step)))
    return tuple(means)


def evo_ate(relation: evo.PoseRelation) -> Callable[[FloatArray, FloatArray], float]:
    def ate_rmse(ref_T: FloatArray, est_T: FloatArray) -> float:
        ref, est = PosePath3D(poses_se3=list(ref_T)), PosePath3D(poses_se3=list(est_T))
        est.align(ref)
        metric = evo.APE(relation)
        metric.process_data((ref, est))
        return float(metric.get_statistic(evo.StatisticsType.rmse))

    return ate_rmse


def timed(
    action: Callable[..., Result], poses: tuple[FloatArray, FloatArray], repeats: int = 1
) -> tuple[Result, float]:
    """The result and the milliseconds of the quickest run."""
    times_ms = []
    for _ in range(repeats):
        begin = time.perf_counter()
        result = action(*poses)
        times_ms.append((time.perf_counter() - begin) * 1e3)
    return result, min(times_ms)


def peak_mib() -> float:
    """Peak memory, MiB, of a fresh process that makes the long pair and its RPE over all steps; imports included."""
    command = [sys.executable, "-c", PEAK_MEMORY]
    folder = {"PYTHONPATH": str(Path(__file__).parent)}
    return int(subprocess.run(command, env=folder, check=True, capture_output=True).stdout) / 1024


def main() -> None:
    table = Table("what", "slamgym", "evo", "ratio", "differ by", title="metrics")
    rpe_rows(table)
    ate_rows(table)
    Console().print(table)


def rpe_rows(table: Table) -> None:
    poses = walk(RPE_POSES)
    (ours, our_ms), (evos, evo_ms) = timed(rpe_all_steps, poses, REPEATS), timed(evo_rpe_all_steps, poses)
    difference = max(abs(a - b) for a, b in zip(ours, evos, strict=True))
    add_row(table, f"RPE, all steps, {RPE_POSES:,} poses (aim: 30)", our_ms, evo_ms, difference)
    _, long_ms = timed(rpe_all_steps, walk(LONG_RPE_POSES))
    table.add_row(f"RPE, all steps, {LONG_RPE_POSES:,} poses", f"{long_ms:.0f} ms")
    table.add_row("  its peak memory (aim: below 1 GB)", f"{peak_mib():.0f} MiB")


def ate_rows(table: Table) -> None:
    """Ours gives translation and rotation in one run, which stands against each of evo's."""
    poses = walk(ATE_POSES)
    stats, our_ms = timed(ate, poses, REPEATS)
    for name, relation, rmse in (
        ("evo: translation (aim: 1)", TRANS, stats.trans_m.rmse),
        ("evo: rotation", ROT, stats.rot_deg.rmse),
    ):
        expected, evo_ms = timed(evo_ate(relation), poses)
        add_row(table, f"ATE, {ATE_POSES:,} poses, {name}", our_ms, evo_ms, abs(rmse - expected))


def add_row(table: Table, what: str, our_ms: float, evo_ms: float, difference: float) -> None:
    ratio = evo_ms / our_ms
    table.add_row(what, f"{our_ms:.0f} ms", f"{evo_ms:.0f} ms", f"{ratio:.1f}", f"{difference:.0e}")


if __name__ == "__main__":
    main()
