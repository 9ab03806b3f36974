import os

import pytest

from slamgym.slam.idle import look, only_idled, wait_until_idle


@pytest.mark.parametrize(
    ("before", "after", "idle"),
    [
        ({1: ("S", 0)}, {1: ("S", 0)}, True),
        ({1: ("S", 0)}, {1: ("S", 299_999)}, True),  # polling
        ({1: ("S", 0)}, {1: ("S", 300_000)}, False),
        ({1: ("S", 0)}, {1: ("R", 0)}, False),  # waits for a core
        ({1: ("S", 0)}, {1: ("D", 0)}, False),
        ({1: ("S", 0)}, {1: ("S", 0), 2: ("S", 0)}, False),  # a new thread
        ({1: ("S", 0), 2: ("S", 0)}, {1: ("S", 0)}, False),
        ({}, {}, True),  # gone
    ],
)
def test_only_idled(before, after, idle):
    assert only_idled(before, after) is idle


def test_look_at_this_very_thread():
    first = look(os.getpid())
    sum(range(10**6))
    second = look(os.getpid())
    state, cpu_ns = second[os.getpid()]
    assert state == "R"
    assert cpu_ns > first[os.getpid()][1]


def test_a_process_that_is_gone_is_idle():
    assert look(2**22 + 1) == {}
    assert wait_until_idle(2**22 + 1, limit_s=1.0)
