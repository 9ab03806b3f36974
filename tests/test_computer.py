import os

from slamgym.computer import computer_name, cores


def test_the_computer_has_a_processor_and_the_cores_that_may_be_used():
    processor, _, told = computer_name().rpartition(", ")
    assert processor.strip()
    assert told == f"{cores()} core{'s' if cores() > 1 else ''}"


def test_cores_are_those_that_this_process_may_use():
    allowed = os.sched_getaffinity(0)
    try:
        os.sched_setaffinity(0, {min(allowed)})
        assert cores() == 1
    finally:
        os.sched_setaffinity(0, allowed)
    assert cores() == len(allowed)


def test_a_processor_without_a_name_is_told_by_its_architecture(monkeypatch):
    monkeypatch.setattr("slamgym.computer.Path", lambda _: _Unreadable())
    computer_name.cache_clear()
    try:
        assert computer_name().startswith(os.uname().machine)
    finally:
        computer_name.cache_clear()


class _Unreadable:
    def read_text(self):
        raise FileNotFoundError
