"""How much does a result change from run to run? One drive, rendered once, is fed to a SLAM again and again.

With `--sequence FOLDER` it is a recorded sequence instead, such as one of TUM RGB-D.
"""

import multiprocessing
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import tyro

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.eval.datasets import Sequence, read_sequence
from slamgym.eval.robustness import average
from slamgym.params import SlamParams
from slamgym.recording import recorded_drive
from slamgym.replay import replay
from slamgym.slam.session import Sync


def main(
    sequence: Path | None = None,
    sequence_camera: str | None = None,
    speed: float = 1.2,
    seed: int = 7,
    scene: str = "procedural",
    path_length_m: float = 8.0,
    camera: str = "default",
    slam: str = "orbslam3",
    stride: int = 0,
    repeats: int = 6,
    busy_loops: int = 8,
    syncs: tuple[Sync, ...] = ("lockstep", "realtime", "free"),
) -> None:
    """Feed the same frames `repeats` times in each sync mode, on an idle machine and beside `busy_loops`."""
    drive: dict[str, Any] = {"speed": speed, "scene": scene, "path_length_m": path_length_m, "camera": camera}
    with (
        recorded_drive(PathFollower(), seed, **drive)
        if sequence is None
        else nullcontext(read_sequence(sequence, sequence_camera)) as seq
    ):
        rows = []
        for sync in syncs:
            params = SlamParams.checked({"slam": slam, "slam_sync": sync, "stride": stride})
            for loops in (0, busy_loops):
                with busy(loops):
                    rows += [{"sync": sync, "busy loops": loops, **run(seq, params)} for _ in range(repeats)]
        table = pd.DataFrame(rows)
    print(table.to_string(index=False, float_format="%.4f"))
    for condition, runs in table.groupby(["sync", "busy loops"], sort=False):
        ate = runs["ATE m"].to_numpy()
        # A failed run is worse than any other: the median counts it as infinite instead of leaving it out.
        failed = ~runs["success"].to_numpy() | np.isnan(ate)
        typical = average(ate, failed, "penalise", penalty=np.inf)
        print(
            f"{condition}: ATE m {typical}; from {np.nanmin(ate):.4f} to {np.nanmax(ate):.4f}; "
            f"median wall time {runs['wall s'].median():.1f} s"
        )


def given(folder: Path, camera: str | None) -> AbstractContextManager[Sequence]:
    """A sequence that is there already."""
    return nullcontext(read_sequence(folder, camera))


def run(sequence: Sequence, params: SlamParams) -> dict[str, Any]:
    """One row of the table."""
    begin = time.perf_counter()
    summary = replay(sequence, params).summary
    return {
        "status": summary["status"],
        "success": summary["success"],
        "ATE m": summary["ate_rmse_m"],
        "completion": summary["completion"],
        "losses": summary["loss_count"],
        "dropped": summary["frames_dropped"],
        "overruns": summary["lockstep_overruns"],
        "wall s": time.perf_counter() - begin,
    }


@contextmanager
def busy(loops: int) -> Iterator[None]:
    """So many processes that do nothing but keep the processor busy."""
    processes = [multiprocessing.Process(target=spin, daemon=True) for _ in range(loops)]
    for process in processes:
        process.start()
    try:
        yield
    finally:
        for process in processes:
            process.kill()
            process.join()


def spin() -> None:
    while True:
        pass


if __name__ == "__main__":
    tyro.cli(main)
