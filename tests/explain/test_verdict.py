from math import comb

import numpy as np
import pytest
from scipy import stats

from slamgym.explain.verdict import (
    FALSE_ALARM,
    Count,
    can_confirm,
    confirm,
    draws_needed,
    false_alarm,
    fisher_p,
    judge,
    pooled,
    strictest_p,
)

CONTROLS = ("unchanged", "unchanged again", "another start")


def controls(*lost, of=3):
    return {name: Count(count, of) for name, count in zip(CONTROLS, lost, strict=True)}


@pytest.mark.parametrize(
    ("control", "changed", "p"),
    [
        ((3, 3), (0, 3), 1 / comb(6, 3)),
        ((9, 9), (0, 3), 1 / comb(12, 3)),
        ((8, 9), (0, 3), 4 / 220),  # the three without a loss are among the four that were without any
        ((9, 9), (1, 3), 10 / 220),  # two runs without a loss, both of the three: only the third is free
        ((0, 9), (0, 3), 1.0),
        ((9, 9), (3, 3), 1.0),
    ],
)
def test_fishers_p_by_hand(control, changed, p):
    assert fisher_p(Count(*control), Count(*changed)) == pytest.approx(p)


def test_fishers_p_is_scipys():
    for control, changed in [((5, 9), (1, 4)), ((11, 12), (2, 4)), ((3, 6), (2, 2))]:
        table = [[changed[0], changed[1] - changed[0]], [control[0], control[1] - control[0]]]
        expected = stats.fisher_exact(table, alternative="less").pvalue
        assert fisher_p(Count(*control), Count(*changed)) == pytest.approx(expected)


def test_pooled():
    assert pooled([Count(1, 3), Count(3, 3), Count(2, 4)]) == Count(6, 10)


def test_what_makes_a_loss_vanish():
    judgement = judge(
        controls(3, 3, 3),
        {"slower": Count(0, 3), "brighter": Count(3, 3), "richer": Count(1, 3), "finer": Count(0, 3)},
    )
    verdicts = {finding.name: finding.verdict for finding in judgement.changes}
    # One loss of three is p = 10 / 220 = 0.045, which of four changes one has by chance too often.
    assert verdicts == {"slower": "vanishes", "brighter": "unchanged", "richer": "unchanged", "finer": "vanishes"}
    assert judgement.controls_agree
    assert judgement.is_decisive
    assert judgement.control_count == Count(9, 9)


def test_with_more_repeats_rarer_is_told_too():
    judgement = judge(controls(8, 8, 8, of=8), {"slower": Count(2, 8), "brighter": Count(7, 8)})
    assert [finding.verdict for finding in judgement.changes] == ["helps", "unchanged"]


def test_a_loss_that_comes_too_rarely_tells_nothing():
    judgement = judge(controls(2, 1, 3), {name: Count(0, 3) for name in "abcde"})
    assert {finding.verdict for finding in judgement.changes} == {"unchanged"}
    assert not judgement.is_decisive


def test_controls_that_differ_leave_no_change_the_credit():
    judgement = judge(controls(5, 5, 0, of=5), {"slower": Count(0, 5)})
    assert fisher_p(Count(10, 15), Count(0, 5)) < judgement.strictest_p  # it would be given it
    assert [finding.verdict for finding in judgement.controls] == ["unchanged", "unchanged", "vanishes"]
    assert not judgement.controls_agree
    assert judgement.changes[0].verdict == "unchanged"


def test_without_a_change_the_controls_are_judged():
    assert judge(controls(3, 3, 3), {}).controls_agree


@pytest.mark.parametrize("changes", [1, 5, 10])
@pytest.mark.parametrize("repeats", [3, 4, 6, 10])
def test_strictest_p_is_the_largest_that_keeps_the_promise(repeats, changes):
    limit = strictest_p(3 * repeats, repeats, changes)
    assert fisher_p(Count(3 * repeats, 3 * repeats), Count(0, repeats)) <= limit <= 0.05
    assert false_alarm(limit, 3 * repeats, repeats, changes) <= FALSE_ALARM
    larger = [p for p in attainable(3 * repeats, repeats) if limit + 1e-9 < p <= 0.05]
    assert all(false_alarm(p, 3 * repeats, repeats, changes) > FALSE_ALARM for p in larger)


def attainable(control_repeats, repeats):
    return {
        fisher_p(Count(a, control_repeats), Count(b, repeats))
        for a in range(control_repeats + 1)
        for b in range(repeats + 1)
    }


def test_two_repeats_allow_no_claim_among_many_changes():
    assert strictest_p(6, 2, 10) == 0.0
    assert judge(controls(2, 2, 2, of=2), {str(k): Count(0, 2) for k in range(10)}).changes[0].verdict == "unchanged"


@pytest.mark.parametrize("repeats", [3, 6])
def test_false_claims_in_simulated_experiments(repeats):
    """20,000 experiments with 7 changes none of which does anything, at probabilities of the loss around the worst."""
    rng = np.random.default_rng(0)
    limit, runs = strictest_p(3 * repeats, repeats, 7), 20_000
    for q in (0.3, 0.5, 0.6, 0.7, 0.9):
        control = rng.binomial(3 * repeats, q, runs)[:, None]
        changed = rng.binomial(repeats, q, (runs, 7))
        p = stats.hypergeom.cdf(changed, 4 * repeats, control + changed, repeats)
        assert (p <= limit + 1e-9).any(axis=1).mean() < FALSE_ALARM + 0.005


@pytest.mark.parametrize(("changes", "draws"), [(1, 3), (3, 3), (4, 4), (10, 4)])
def test_draws_that_keep_the_promise(changes, draws):
    assert draws_needed(changes) == draws
    # All lost without the change and none with it, at the worst probability of the loss.
    q = np.linspace(0.0, 1.0, 10_001)
    chance = [(q**n * (1 - (1 - (1 - q) ** n) ** changes)).max() for n in (draws - 1, draws)]
    assert chance[1] <= FALSE_ALARM
    assert chance[0] > FALSE_ALARM or strictest_p(draws - 1, draws - 1, changes) == 0.0


def test_only_what_holds_over_other_frames_is_confirmed():
    found = confirm(Count(3, 3), {"slower": Count(0, 3), "brighter": Count(1, 3)})
    assert [one.verdict for one in found.changes] == ["vanishes", "unchanged"]
    assert can_confirm(Count(3, 3), 2)
    assert not can_confirm(Count(2, 3), 2)


@pytest.mark.parametrize("per_frames", [0.0, 1.0])
def test_false_claims_where_the_loss_hangs_on_the_frames(per_frames):
    """Experiments with 5 changes that do nothing, in each of which a set of frames has a chance of the loss of its own.

    per_frames: 1.0 where the frames decide all, 0.0 where the SLAM does.
    """
    rng = np.random.default_rng(0)
    first = told = judged = 0
    for _ in range(1500):
        q = rng.choice([0.5, 0.6, 0.7, 0.8])

        def lost(q=q):
            """Of 3 runs over one set of frames."""
            return Count(int(rng.binomial(3, rng.random() < q if rng.random() < per_frames else q)), 3)

        same = lost() if per_frames == 0.0 else Count(3, 3)
        judgement = judge(
            {"unchanged": same, "again": lost() if per_frames == 0.0 else same, "start": lost()},
            {str(change): lost() for change in range(5)},
        )
        judged += judgement.controls_agree
        if names := judgement.credited:
            first += 1
            draws = draws_needed(len(names))
            anew = {name: Count(int(rng.binomial(draws, q)), draws) for name in ("unchanged", *names)}
            unchanged = anew.pop("unchanged")
            told += any(one.verdict != "unchanged" for one in confirm(unchanged, anew).changes)
    assert told / judged < FALSE_ALARM
    if per_frames:
        assert first / judged > 0.3  # what the confirmation is for
