from types import SimpleNamespace

import pytest

from slamgym.explain.result import CaseResult, by_change, summary_sentences
from slamgym.explain.source import Loss
from slamgym.explain.verdict import Confirmation, Count, confirm, judge

LOSS = Loss(1, 2.0, 3.0, "unknown", "")


def result(confirmation, seed=0):
    """A change that the first test credits, of a loss that always comes."""
    run = SimpleNamespace(folder="run", seed=seed, setup=SimpleNamespace(drive=SimpleNamespace(scene="hall")))
    case = SimpleNamespace(run=run, loss=LOSS, losses=(LOSS,), window_m=(2.0, 4.0))
    controls = {name: Count(3, 3) for name in ("unchanged", "unchanged again", "another start")}
    judgement = judge(controls, {"slower": Count(0, 3), "brighter": Count(3, 3)})
    return CaseResult(case, (((0.0, 4.0), Count(3, 3)),), judgement, confirmation)


HELD = confirm(Count(3, 3), {"slower": Count(0, 3)})


@pytest.mark.parametrize(
    ("confirmation", "verdict", "on_slower", "counts"),
    [
        (HELD, "explained", "vanishes", "0 of 3, over other frames 0 of 3"),
        (confirm(Count(8, 8), {"slower": Count(1, 8)}), "helped", "helps", "0 of 3, over other frames 1 of 8"),
        (
            confirm(Count(3, 3), {"slower": Count(2, 3)}),
            "undecided",
            "not confirmed",
            "0 of 3, over other frames 2 of 3",
        ),
        (Confirmation(Count(0, 3)), "undecided", "not confirmed", "0 of 3"),
    ],
)
def test_a_change_is_given_credit_where_it_holds_over_other_frames(confirmation, verdict, on_slower, counts):
    told = result(confirmation)
    assert told.verdict == verdict
    assert [told.verdict_on(one) for one in told.judgement.changes] == [on_slower, "unchanged"]
    assert f"slower ({counts})" in told.sentence()
    assert told.sentence().endswith(f"unchanged 9 of 9, over other frames {confirmation.unchanged}")
    assert ("hangs on where the frames fall" in told.sentence()) == (verdict == "undecided")
    assert by_change([told])["slower"] == Count(int(verdict == "explained"), 1)


def test_a_loss_that_is_rare_over_other_frames_asks_for_more_repeats():
    told = result(Confirmation(Count(2, 3)))
    assert told.verdict == "undecided"
    assert "over other frames it comes too rarely to tell, take more repeats: slower (0 of 3)" in told.sentence()


def test_losses_of_one_path_are_not_counted_as_independent():
    gone, stays = HELD, confirm(Count(3, 3), {"slower": Count(3, 3)})
    apart = summary_sentences([result(gone if seed % 2 else stays, seed) for seed in range(8)])[1]
    together = summary_sentences([result(gone if seed % 2 else stays, seed % 4) for seed in range(8)])[1]
    alone = summary_sentences([result(gone), result(stays)])[1]
    assert apart.startswith("vanish with a single change: 4 of 8 (50 %, 95 % interval ")
    assert together.startswith("vanish with a single change: 4 of 8 (50 %, 95 % interval ")
    assert width(together) > width(apart) + 10
    assert alone.endswith("1 of 2 (50 %, all of one path, which tells nothing of others)")


def width(sentence):
    words = sentence.split()
    return int(words[-2]) - int(words[-4])
