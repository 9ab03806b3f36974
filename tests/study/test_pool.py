import os
import time

import pytest

from slamgym.computer import cores
from slamgym.study.pool import LocalPool


@pytest.fixture
def pool():
    pool = LocalPool(2)
    yield pool
    pool.close()


def test_workers_do_one_thing_at_a_time_and_share_the_cores(pool):
    assert pool.capacity() == 2
    names = ("LP_NUM_THREADS", "OMP_NUM_THREADS", "OPENCV_FOR_THREADS_NUM")
    before = [os.environ.get(name) for name in names]
    first = [pool.submit(os.getenv, names[0]), pool.submit(os.getenv, names[1])]
    threads = [future.result(30) for future in first] + [pool.submit(os.getenv, names[2]).result(30)]
    assert threads == [str(max(1, cores() // 2))] * 3
    assert [os.environ.get(name) for name in names] == before
    pids = [pool.submit(os.getpid), pool.submit(os.getpid)]
    assert len({future.result(30) for future in pids} | {os.getpid()}) == 3


def test_a_worker_that_dies_is_replaced_and_its_neighbour_is_not(pool):
    other = pool.submit(time.sleep, 0.5)
    neighbour = pool.submit(os.getpid)  # the other worker: the first one is busy
    pid = neighbour.result(30)
    doomed = pool.submit(os._exit, 3)
    with pytest.raises(pool.lost):
        doomed.result(30)
    other.result(30)
    again = pool.submit(time.sleep, 0.5), pool.submit(os.getpid)
    assert again[1].result(30) != pid
    again[0].result(30)


def test_closing_ends_what_is_under_way(children):
    before = children()
    pool = LocalPool(1)
    pool.submit(time.sleep, 1e6)
    assert len(children() - before) >= 1
    pool.close()
    left = children() - before  # but for what multiprocessing keeps for all pools of this process
    commands = [open(f"/proc/{pid}/cmdline").read() for pid in left]  # noqa: SIM115, PTH123
    assert [command for command in commands if "resource_tracker" not in command] == []
