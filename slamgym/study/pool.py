"""Where the pieces of a study's work are carried out: in processes of this computer, or of a cluster (`dask_pool`)."""

import os
import signal
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from multiprocessing import get_context
from typing import Any, ClassVar, NamedTuple, Protocol

from slamgym.computer import cores
from slamgym.errors import ConfigError
from slamgym.slam.process_tree import process_tree
from slamgym.slam.program import signal_after

SCHEDULER_GONE = "the cluster's scheduler is gone; what is done stays: start the study again to go on"
START_S = 120.0
"""Longest time that a new worker may take to import slamgym."""


class Pool(Protocol):
    """Workers that do one thing at a time.

    A future ends with one of `lost` when its worker died, or several did; after `tries` of it the work is to blame. It
    is cancelled when all of them are out of reach.
    """

    @property
    def lost(self) -> tuple[type[BaseException], ...]: ...
    @property
    def tries(self) -> int: ...
    def capacity(self) -> int:
        """How many pieces of work can be under way now."""
        ...

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]: ...
    def close(self) -> None:
        """End what is still under way."""
        ...


class _Worker(NamedTuple):
    executor: ProcessPoolExecutor
    pid: int


class LocalPool:
    """A number of processes, replaced when they die; all end with this one, however it ends.

    What they compute with is shared out: each takes cores / workers threads for rendering and algebra. To be used by
    the thread that makes it: the kernel ends the workers when that thread ends.
    """

    lost: ClassVar = (BrokenProcessPool,)
    tries: ClassVar = 2

    def __init__(self, workers: int) -> None:
        self._threads = max(1, cores() // workers)
        self._workers: list[_Worker] = []
        self._busy: dict[int, Future[Any]] = {}
        try:
            starting = [_start(self._threads) for _ in range(workers)]
            self._workers = [_started(*one) for one in starting]
        except BaseException:
            self.close()
            raise

    def capacity(self) -> int:
        return len(self._workers)

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        slot = next(k for k in range(len(self._workers)) if k not in self._busy or self._busy[k].done())
        self._replace_dead(slot)
        self._busy[slot] = self._workers[slot].executor.submit(function, *arguments)
        return self._busy[slot]

    def close(self) -> None:
        for worker in self._workers:
            _kill(worker)
        for worker in self._workers:
            worker.executor.shutdown(cancel_futures=True)

    def _replace_dead(self, slot: int) -> None:
        try:
            self._workers[slot].executor.submit(os.getpid).result(START_S)
        except (BrokenProcessPool, TimeoutError):
            _kill(self._workers[slot])
            self._workers[slot] = _started(*_start(self._threads))


def _start(threads: int) -> tuple[ProcessPoolExecutor, Future[int]]:
    executor = ProcessPoolExecutor(1, get_context("spawn"), _begin, (os.getpid(),))
    with _environment(_thread_limits(threads)), _no_interrupts():
        return executor, executor.submit(os.getpid)


def _started(executor: ProcessPoolExecutor, pid: Future[int]) -> _Worker:
    try:
        return _Worker(executor, pid.result(START_S))
    except (BrokenProcessPool, TimeoutError):
        executor.shutdown(wait=False)
        raise ConfigError(
            "expected worker processes to start, got one that ended at once, see above; in a script of your own, call "
            'run_study below `if __name__ == "__main__":`'
        ) from None


def _kill(worker: _Worker) -> None:
    for pid in process_tree(worker.pid):
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)


def _begin(parent_pid: int) -> None:
    signal_after(parent_pid, signal.SIGKILL)


def _thread_limits(threads: int) -> dict[str, str]:
    """For Mesa, OpenBLAS and what else uses OpenMP, and OpenCV; each reads it once, when it is loaded."""
    return dict.fromkeys(("LP_NUM_THREADS", "OMP_NUM_THREADS", "OPENCV_FOR_THREADS_NUM"), str(threads))


@contextmanager
def _environment(values: Mapping[str, str]) -> Iterator[None]:
    """Variables that processes which are started within the block inherit."""
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


@contextmanager
def _no_interrupts() -> Iterator[None]:
    """Processes that are started within the block never get a Ctrl-C, which the terminal sends to all: a blocked signal
    stays blocked in what a process starts, whatever handlers it installs.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
