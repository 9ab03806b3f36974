from dataclasses import replace

import pytest

from slamgym.report.comparison import compare_studies
from slamgym.report.comparison.broken import more_failures_p
from tests.report.made_up import study
from tests.report.made_up_pairs import compared, pairs_of, repeated, table


def test_pairs_whose_repeats_all_break_are_a_regression():
    # 2 of 100 paths: no change of a mean, but 10 of 10 repeats do not turn by chance; 3 of 10 may, among 100 pairs.
    old = repeated([(f"p{k}", 1, 0) for k in range(100)])
    new = repeated([(f"p{k}", 1, {7: 10, 50: 10, 60: 3}.get(k, 0)) for k in range(100)])
    comparison = compared(new, old)
    assert comparison.regressions == ()
    assert comparison.regressed_pairs == ("p50", "p7")
    assert comparison.has_regressed
    assert comparison.content.headlines[0].startswith("Regression: the repeats of 2 pairs fail more often")
    assert comparison.content.headlines[0].endswith("p50, p7.")
    assert not compared(old, new).has_regressed


def test_p_of_more_failures_by_hand():
    pairs = pairs_of(repeated([("a", 1, 5), ("b", 1, 0)], 5), repeated([("a", 1, 0), ("b", 1, 0)], 5)).pairs
    # One of the 10 choose 5 ways to share out five failures, times two pairs.
    assert more_failures_p(pairs) == pytest.approx([2 / 252, 1.0])


def test_what_cannot_be_judged_says_why():
    old = repeated([(f"p{k}", 1, 0) for k in range(20)])
    assert compared(old, old).not_judged == ()
    few = old[old["path"].isin(["p1", "p2"])]
    (reason,) = compared(few, few).not_judged
    assert reason.startswith("expected at least 7 paths in common, got 2; ")
    unfinished = replace(study(old), planned=240)
    (reason,) = compare_studies(unfinished, study(old)).not_judged
    assert reason == "expected all 240 runs of the new study, got 200; wait until it is finished"
    not_begun = old.astype({"success": object})
    not_begun.loc[old["path"] == "p3", ["status", "success"]] = ["not_run", None]
    (reason,) = compared(not_begun, old).not_judged
    assert reason.startswith("expected no more runs that were not begun than the baseline's 0, got 10; ")
    assert compared(old, not_begun).not_judged == compared(not_begun, not_begun).not_judged == ()


def test_missing_runs_are_headlines():
    old = repeated([(f"p{k}", 1, 0) for k in range(20)])
    new = old.astype({"success": object})
    new.loc[old["path"] == "p3", ["status", "success"]] = ["not_run", None]
    told = compare_studies(replace(study(new), planned=240), replace(study(old), planned=201)).content.headlines
    assert "The new study is not finished: 200 of 240 runs have a result." in told
    assert "The baseline is not finished: 200 of 201 runs have a result." in told
    assert "10 runs of the new study and 0 of the baseline were not begun, and are left out." in told
    assert not any("not finished" in text or "not begun" in text for text in compared(old, old).content.headlines)


def test_paths_that_broke_are_named():
    old = table([("a", 0.2, r, True, 0.02) for r in (1, 2, 3)] + [("b", 0.2, r, r > 1, 0.02) for r in (1, 2, 3)])
    new = table([(path, 0.2, r, r > 2, 0.02) for path in ("a", "b") for r in (1, 2, 3)])
    comparison = compare_studies(study(new, ("speed",)), study(old, ("speed",)))
    assert comparison.broken == ("a (speed 0.2)",)
    assert any("fail now in 1 pair: a (speed 0.2)" in text for text in comparison.content.headlines)
