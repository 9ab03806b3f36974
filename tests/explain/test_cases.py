from pathlib import Path
from types import SimpleNamespace

import pytest

from slamgym.explain.cases import cases_of, picked
from slamgym.explain.source import Loss


def run(*losses_m, stretch_m=(0.0, 12.0)):
    losses = tuple(Loss(n, 0.0, at_m, "unknown", "") for n, at_m in enumerate(losses_m, start=1))
    return SimpleNamespace(losses=losses, stretch_m=stretch_m, folder=Path("run"))


def test_a_stretch_reaches_around_the_loss():
    (case,) = cases_of(run(5.0), 3.0, 1.5)
    assert (case.stretch_m, case.window_m, case.whole_m) == ((2.0, 6.5), (4.0, 6.5), (0.0, 6.5))


@pytest.mark.parametrize(
    ("at_m", "stretch_m", "window_m"),
    [(0.4, (0.0, 1.9), (0.0, 1.9)), (11.8, (8.8, 12.0), (10.8, 12.0))],
)
def test_it_ends_where_the_drive_did(at_m, stretch_m, window_m):
    (case,) = cases_of(run(at_m), 3.0, 1.5)
    assert case.stretch_m == pytest.approx(stretch_m)
    assert case.window_m == pytest.approx(window_m)


def test_losses_in_one_stretch_are_one_case():
    cases = list(cases_of(run(2.0, 2.2, 3.5, 3.6, 9.0), 3.0, 1.5))
    assert [[loss.number for loss in case.losses] for case in cases] == [[1, 2, 3], [4], [5]]
    assert [case.loss.number for case in cases] == [1, 4, 5]
    assert cases[1].stretch_m == pytest.approx((0.6, 5.1))


def test_picked_in_turn():
    runs = [list(cases_of(run(*at_m), 3.0, 1.0)) for at_m in ((1.0, 4.0, 8.0), (2.0,), (3.0, 9.0))]
    places = [[case.loss.progress_m for case in picked(runs, most)] for most in (None, 2, 4)]
    assert places == [[1.0, 4.0, 8.0, 2.0, 3.0, 9.0], [1.0, 2.0], [1.0, 4.0, 2.0, 3.0]]
