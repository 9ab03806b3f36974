import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import dask
import pytest
from distributed import Client, LocalCluster

from slamgym.errors import ConfigError
from slamgym.study.dask_pool import DaskPool
from slamgym.study.run import run_study
from slamgym.study.table import open_study


@pytest.fixture(scope="module")
def cluster():
    """Two worker processes of one thread each, which a nanny replaces."""
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0") as cluster:
        yield cluster


def study_of(sequences, repeats):
    return f"""
name: lines
paths: [{{sequence: [{", ".join(map(str, sequences))}]}}]
factors: [{{slam: [groundtruth, wheel_odometry]}}]
repeats: {repeats}
"""


def test_a_study_on_a_cluster_loses_nothing_with_a_worker(cluster, study, sequences, tmp_path, wait_until):
    spec, out = study(study_of(sequences[:2], 4)), tmp_path / "out"
    killed = []

    def kill_one():
        with Client(cluster) as client:
            assert wait_until(lambda: len(list((out / "runs").glob("*/[!.]*"))) >= 2, 120)
            killed.append(next(iter(client.run(os.getpid).values())))
            os.kill(killed[0], signal.SIGKILL)

    killer = threading.Thread(target=kill_one)
    killer.start()
    done = run_study(spec, out, dask=cluster.scheduler_address)
    killer.join()
    assert killed
    assert done.runs["status"].tolist() == ["ok"] * 16
    assert open_study(out).planned == 16
    assert not [path for path in out.rglob("*") if path.name.startswith(".")]
    assert not (out / "frames").exists()


def test_a_run_that_kills_every_worker_is_crashed(study, sequences, tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    text = study_of(sequences[:1], 1).replace("wheel_odometry", "'deadly_backends:KillsItsWorker'")
    search_path = f"{Path(__file__).parent}{os.pathsep}{os.environ.get('PYTHONPATH', '')}"
    monkeypatch.setenv("PYTHONPATH", search_path)
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 1}),
        LocalCluster(n_workers=1, threads_per_worker=1, processes=True, dashboard_address=":0") as cluster,
    ):
        runs = run_study(study(text), tmp_path / "out", dask=cluster.scheduler_address).runs
    assert runs["status"].tolist() == ["ok", "crashed"]


def test_an_address_without_a_scheduler(tmp_path, monkeypatch):
    monkeypatch.setattr("slamgym.study.dask_pool.CONNECT_S", 0.5)
    for address in ("tcp://127.0.0.1:9", "nowhere at all", "what://127.0.0.1:9"):
        with pytest.raises(ConfigError, match="expected the address of a Dask scheduler") as refused:
            DaskPool(address, tmp_path)
        assert "\n" not in str(refused.value)


def test_workers_that_cannot_do_the_work(tmp_path, monkeypatch):
    monkeypatch.setattr("slamgym.study.dask_pool.CONNECT_S", 1.0)
    with LocalCluster(n_workers=0, threads_per_worker=2, processes=True, dashboard_address=":0") as cluster:
        with pytest.raises(ConfigError, match=r"expected workers at tcp://.+, got none"):
            DaskPool(cluster.scheduler_address, tmp_path)
        monkeypatch.setattr("slamgym.study.dask_pool.CONNECT_S", 60.0)
        cluster.scale(1)
        with pytest.raises(ConfigError, match=r"workers of one thread each, got tcp://.+ with 2"):
            DaskPool(cluster.scheduler_address, tmp_path)


def test_workers_that_do_not_see_the_folder(tmp_path):
    """A worker whose file system has another folder in its place, as on a computer of its own; needs root."""
    if subprocess.run(["unshare", "--mount", "true"], capture_output=True).returncode:
        pytest.skip("expected to be allowed to give a process a file system of its own")
    with LocalCluster(n_workers=0, processes=True, dashboard_address=":0") as cluster:
        worker = f"{sys.executable} -m distributed.cli.dask_worker {cluster.scheduler_address} --nthreads 1 --no-nanny"
        command = f"mount -t tmpfs tmpfs {tmp_path} && exec {worker} --local-directory {tmp_path} --no-dashboard"
        with subprocess.Popen(["unshare", "--mount", "sh", "-c", command], stderr=subprocess.DEVNULL) as elsewhere:
            with pytest.raises(ConfigError, match=r"that all workers share, but tcp://.+ does not see it"):
                DaskPool(cluster.scheduler_address, tmp_path)
            elsewhere.kill()
    assert list(tmp_path.iterdir()) == []
