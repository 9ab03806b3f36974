import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from slamgym.study.busy import busy


def ticks_of_cpu(pid):
    """Of the kernel's clock, that the process has computed for so far."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return int(fields[11]) + int(fields[12])


def eventually(condition, limit_s=20.0):
    deadline = time.monotonic() + limit_s
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.02)
    return condition()


def test_processes_compute_as_long_as_the_block_lasts(children):
    before = children()
    with busy(3):
        burning = children() - before
        assert len(burning) == 3
        for pid in burning:
            start = ticks_of_cpu(pid)
            assert eventually(lambda pid=pid, start=start: ticks_of_cpu(pid) > start + 2)
    assert children() == before


def test_none_is_none(children):
    before = children()
    with busy(0):
        assert children() == before


def test_they_are_gone_after_an_error(children):
    before = children()
    with pytest.raises(KeyError), busy(2):
        raise KeyError
    assert children() == before


def alive(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_they_are_gone_when_their_parent_is_killed(children):
    program = "import time\nfrom slamgym.study.busy import busy\nwith busy(2):\n print('.', flush=True); time.sleep(60)"
    before = children()
    parent = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE)
    assert parent.stdout.read(1) == b"."
    burning = children() - before - {parent.pid}
    assert len(burning) == 2
    os.kill(parent.pid, signal.SIGKILL)
    parent.wait()
    parent.stdout.close()
    assert eventually(lambda: not any(map(alive, burning)))
