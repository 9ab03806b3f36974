"""A study's work on a Dask cluster; needs the extra `slamgym[dask]`, and a folder that all computers see."""

import os
import tempfile
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from importlib import import_module
from pathlib import Path
from typing import Any, ClassVar

from slamgym.errors import ConfigError, SlamError
from slamgym.study.pool import SCHEDULER_GONE

CONNECT_S = 30.0
"""Longest wait for the scheduler, and for the first worker."""


class DaskPool:
    """The workers of the cluster whose scheduler has this address; work of one that dies is done by another.

    folder: the study's. Raises ConfigError when there is no scheduler, no worker, one that does not see the folder, or
    one with several threads: a process can render one drive at a time.
    """

    tries: ClassVar = 1
    """The scheduler itself gives work that lost its worker to others, some times."""

    def __init__(self, address: str, folder: Path) -> None:
        distributed = _distributed()
        self.lost: tuple[type[BaseException], ...] = (distributed.KilledWorker,)
        self._address = address
        try:
            self._client = distributed.Client(address, timeout=CONNECT_S)
        except (OSError, ValueError, TypeError) as error:  # a timeout is an OSError
            raise ConfigError(
                f"dask: expected the address of a Dask scheduler, got {address!r}, where none answers "
                f"({type(error).__name__}); start one with `dask scheduler`"
            ) from None
        try:
            self._check_workers(folder)
            self._executor = self._client.get_executor(pure=False)
        except BaseException:
            self._client.close()
            raise

    def capacity(self) -> int:
        try:
            threads: dict[str, int] = self._client.nthreads()
        except (OSError, CancelledError):
            raise SlamError(SCHEDULER_GONE) from None
        if several := [worker for worker, count in threads.items() if count != 1]:
            raise ConfigError(
                f"dask: expected workers of one thread each, got {several[0]} with {threads[several[0]]}; start them "
                "with `dask worker --nworkers N --nthreads 1`"
            )
        return len(threads)

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        future: Future[Any] = self._executor.submit(function, *arguments)
        return future

    def close(self) -> None:
        self._executor.shutdown(wait=False)
        self._client.close()

    def _check_workers(self, folder: Path) -> None:
        try:
            self._client.wait_for_workers(1, CONNECT_S)
        except TimeoutError:
            raise ConfigError(
                f"dask: expected workers at {self._address}, got none in {CONNECT_S:.0f} s; start them with "
                f"`dask worker {self._address} --nworkers N --nthreads 1`"
            ) from None
        self.capacity()
        with tempfile.NamedTemporaryFile(dir=folder, prefix=".token-") as token:
            sees = self._client.run(_sees, token.name, on_error="return")
        for worker, answer in sees.items():
            if answer is not True:
                why = "does not see it" if answer is False else f"cannot look ({answer!r}): is slamgym installed there?"
                raise ConfigError(
                    f"dask: expected {folder} in a file system that all workers share, but {worker} {why}"
                )


def _distributed() -> Any:
    try:
        return import_module("distributed")
    except ImportError:
        raise ConfigError("dask: expected the package distributed; pip install 'slamgym[dask]'") from None


def _sees(file: str) -> bool:
    return os.access(file, os.W_OK)
