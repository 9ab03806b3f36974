import numpy as np
import pandas as pd
import pytest

from slamgym.errors import ConfigError
from slamgym.eval.plots.style import save_figure
from slamgym.eval.statistics import Interval
from slamgym.report.comparison import compare_studies
from slamgym.report.comparison.broken import regressed_pairs
from slamgym.report.comparison.differences import MetricChange, metric_changes, outcome_counts
from slamgym.report.comparison.metrics import SUCCESS
from slamgym.report.comparison.pairing import pair_studies
from tests.report.made_up import runs, study
from tests.report.made_up_pairs import compared, pairs_of, repeated, table

NAN = np.nan


def changes_of(new, baseline, factors=("speed",)):
    return {change.metric.name: change for change in metric_changes(pairs_of(new, baseline, factors).pairs)}


def test_repeats_come_together_and_failures_count_as_infinite():
    new = table([("a", 0.2, 1, True, 0.02), ("a", 0.2, 2, False, 0.01), ("a", 0.2, 3, True, 0.04)])
    old = table([("a", 0.2, 1, True, 0.01), ("a", 0.2, 2, True, 0.02), ("a", 0.2, 3, True, 0.03)])
    (pair,) = pairs_of(new, old).pairs.to_dict("records")
    assert (pair["place"], pair["speed"]) == ("a", "0.2")
    assert (pair["successes.new"], pair["runs.new"], pair["successes.baseline"]) == (2, 3, 3)
    assert pair["success.new"] == pytest.approx(2 / 3)
    # Of 0.02, 0.04 and infinity the median is 0.04: not 0.03, nor that of the failed run's small error.
    assert pair["ate_rmse_m.new"] == 0.04
    assert pair["ate_rmse_m.baseline"] == 0.02


def test_changes_by_hand():
    # Path a: success 1 -> 0.5 at one speed, 1 -> 1 at the other; path b: 0 -> 1 and 1 -> 1.
    new = table(
        [("a", 0.2, 1, True, 0.02), ("a", 0.2, 2, False, 0.0), ("a", 0.8, 1, True, 0.08), ("a", 0.8, 2, True, 0.08)]
        + [("b", speed, repeat, True, 0.03) for speed in (0.2, 0.8) for repeat in (1, 2)]
    )
    old = table(
        [("a", speed, repeat, True, 0.02) for speed in (0.2, 0.8) for repeat in (1, 2)]
        + [("b", 0.2, 1, False, NAN), ("b", 0.2, 2, False, NAN), ("b", 0.8, 1, True, 0.01), ("b", 0.8, 2, True, 0.01)]
    )
    changes = changes_of(new, old)
    success, ate = changes["success"], changes["ate_rmse_m"]
    # Path by path: a (-0.5 + 0) / 2, b (1 + 0) / 2.
    assert success.change.estimate == pytest.approx((-0.25 + 0.5) / 2)
    assert (success.new, success.baseline) == (pytest.approx(0.875), pytest.approx(0.75))
    # Of a, half of whose repeats failed at 0.2 m/s, only the ratio 4 at 0.8 m/s counts; of b 3: sqrt(12).
    assert ate.paths == 2
    assert ate.change.estimate == pytest.approx(np.sqrt(12))
    assert ate.new / ate.baseline == pytest.approx(np.sqrt(12))
    # a: a failure against a success, 0.08 against 0.02; b: a success against a failure, 0.03 against 0.01.
    assert outcome_counts(pairs_of(new, old).pairs) == {"wins": 1, "losses": 3, "ties": 0}
    assert changes["timing.track_ms_median"].change_text == "cannot be told"


def test_the_same_data_show_nothing():
    same = study(runs(seed=1), ("speed",))
    comparison = compare_studies(same, same)
    assert comparison.regressions == comparison.settings == comparison.broken == ()
    assert {change.change.estimate for change in comparison.changes} == {0.0, 1.0}
    assert all(change.p == 1.0 for change in comparison.changes)
    assert "Of 60 pairs 0 are better, 0 worse and 60 equal" in " ".join(comparison.content.headlines)
    assert comparison.content.headlines[0].startswith("No regression")
    assert not comparison.content.sections[-1].tables


@pytest.mark.parametrize(
    ("change", "regressed"),
    [
        ({"ate_factor": 1.5}, {"ate_rmse_m"}),
        ({"more_failures": 0.35}, {"success", "completion"}),
        ({"time_factor": 1.3}, {"timing.track_ms_median"}),
        ({"ate_factor": 0.6}, set()),
    ],
)
def test_a_clear_change_for_the_worse_is_a_regression(change, regressed):
    comparison = compare_studies(
        study(runs(seed=3, **change), ("speed",)), study(runs(seed=4), ("speed",), folder="old")
    )
    assert {one.metric.name for one in comparison.regressions} == regressed
    told = [text for text in comparison.content.headlines if text.startswith("Regression: ")]
    assert len(told) == len(regressed)


def test_a_small_but_sure_change_is_no_regression():
    old = runs(seed=1)
    slower = old.assign(**{"timing.track_ms_median": 1.15 * old["timing.track_ms_median"]})
    comparison = compare_studies(study(slower, ("speed",)), study(old, ("speed",)))
    (time,) = [change for change in comparison.changes if change.metric.name == "timing.track_ms_median"]
    assert time.change.estimate == pytest.approx(1.15)
    assert time.p < 0.001
    assert comparison.regressions == ()
    assert str(time).startswith(
        "time for a frame (ms): 13.8 -> 15.9, +15 % (95 % interval +15 to +15), 30 paths, p < 0.001"
    )


@pytest.mark.parametrize(("paths", "told"), [(7, True), (8, False)])
def test_too_few_paths_are_told(paths, told):
    # The least p of 7 paths is 2 / 2^7, times 4 metrics above 0.05; of 8 paths 2 / 2^8, times 4 below.
    new, old = runs(paths=paths, ate_factor=9, seed=1), runs(paths=paths, seed=2)
    comparison = compare_studies(study(new, ("speed",)), study(old, ("speed",)))
    first = comparison.content.headlines[0]
    assert first.startswith("Too few paths to tell a regression from chance: 7, and 8 are the least") == told
    assert bool(comparison.regressions) != told


def test_what_has_no_partner_is_counted():
    old = runs(paths=10, speeds=(0.2, 0.8, 1.2), seed=1)
    new = runs(paths=12, seed=2)
    new.loc[:2, "status"] = "not_run"
    new["success"] = new["success"].astype(object)
    new.loc[:2, "success"] = None
    pairing = pair_studies(study(new, ("speed",)), study(old, ("speed",)))
    # Path 0 at 0.2 m/s was not begun; paths 10 and 11 and the speed of 1.2 m/s are in one study only.
    assert pairing.not_begun == {"new": 3, "baseline": 0}
    assert pairing.alone == {"new": 12, "baseline": 33}
    assert len(pairing.pairs) == 10 * 2 - 1
    facts = compare_studies(study(new, ("speed",)), study(old, ("speed",))).content.facts
    assert facts["Runs without a partner, baseline"] == 33
    assert facts["Runs that were not begun, new"] == 3


def test_a_factor_of_one_study_only():
    # A speed that one study varies is paired with the other's one; a SLAM's factor is set against it at each level.
    old = runs(paths=9, speeds=(0.8,), seed=1)
    new = runs(paths=9, seed=2)
    new = pd.concat([new.assign(features=n) for n in (500, 1000)])
    pairing = pair_studies(study(new, ("speed", "features")), study(old, ()))
    assert pairing.factors == ("speed", "features")
    assert set(pairing.pairs["speed"]) == {"0.8"}
    assert len(pairing.pairs) == 9 * 2
    assert pairing.alone == {"new": 9 * 2 * 3, "baseline": 0}


def test_a_level_is_the_same_as_number_and_as_text():
    old = runs(paths=3, seed=1)
    assert len(pairs_of(runs(paths=3, seed=2), old.assign(speed=old["speed"].astype(str))).pairs) == 6


def test_paths_of_one_name_in_two_datasets_are_kept_apart():
    two = pd.concat([runs(paths=3, seed=1), runs(paths=3, seed=2).assign(dataset="other")])
    assert set(pairs_of(two, two).pairs["place"]) == {
        f"{dataset}: procedural:1 #{k}" for dataset in ("procedural", "other") for k in range(3)
    }


def test_studies_with_nothing_in_common_are_refused_in_one_line():
    old = runs(paths=3, seed=1)
    elsewhere = old.assign(path=old["path"].str.replace("procedural:1", "procedural:9"))
    with pytest.raises(ConfigError, match="expected two studies with a path in common, got 3 paths such as") as none:
        compare_studies(study(elsewhere, ("speed",)), study(old, ("speed",)))
    with pytest.raises(ConfigError, match=r"got speed 2 against speed 0\.2, 0\.8"):
        compare_studies(study(old.assign(speed=2.0), ("speed",)), study(old, ("speed",)))
    with pytest.raises(ConfigError, match="expected finished runs in new, got none"):
        compare_studies(study(old.assign(status="not_run"), ("speed",)), study(old, ("speed",)))
    assert "\n" not in str(none.value)


def test_the_interval_weighs_paths_as_the_estimate_does():
    # 11 paths became worse; one, which has more pairs than all others together, became better.
    spec = [("p0", level, 10) for level in range(1, 200)] + [(f"p{k}", 1, 0) for k in range(1, 12)]
    new = [("p0", level, 0) for level in range(1, 200)] + [(f"p{k}", 1, 6) for k in range(1, 12)]
    change = changes_of(repeated(new), repeated(spec))["success"]
    assert change.change.estimate == pytest.approx((1 - 11 * 0.6) / 12)
    assert change.change.low < change.change.estimate < change.change.high
    assert change.verdict == "worse"


@pytest.mark.parametrize(
    ("estimate", "low", "high", "verdict"),
    [
        (-0.2, -0.3, -0.1, "worse"),
        (0.2, 0.1, 0.3, "better"),
        (-0.2, 0.1, 0.3, "not clear"),
        (-0.2, -0.3, 0.1, "not clear"),
    ],
)
def test_the_verdict_wants_estimate_and_interval_on_one_side(estimate, low, high, verdict):
    assert MetricChange(SUCCESS, 20, 0.5, 0.7, Interval(estimate, low, high), 0.001).verdict == verdict


def test_a_change_of_a_third_on_some_paths_is_found():
    # Graded shares: 8 of 20 paths succeed in 7 of 10 repeats in place of all.
    old = repeated([(f"p{k}", 1, 0) for k in range(20)])
    new = repeated([(f"p{k}", 1, 3 if k < 8 else 0) for k in range(20)])
    (success, *_) = compared(new, old).changes
    assert success.change.high < 0
    assert success.is_regression


def test_a_recorded_sequence_without_truth_is_compared_by_its_losses():
    new = runs(seed=3, more_failures=0.35).assign(ate_rmse_m=NAN, losses_per_metre=NAN)
    old = runs(seed=4).assign(ate_rmse_m=NAN, losses_per_metre=NAN)
    comparison = compare_studies(study(new, ("speed",)), study(old, ("speed",)))
    assert {one.metric.name for one in comparison.regressions} == {"success", "completion"}
    assert {change.metric.name: change.paths for change in comparison.changes}["ate_rmse_m"] == 0
    for section in comparison.content.sections:
        for picture in section.pictures:
            picture.draw()


def test_every_picture_and_table_is_made(tmp_path):
    hostile = runs(seed=1)
    hostile["path"] = hostile["path"].str.replace("procedural", "<script>$x$")
    comparison = compare_studies(study(hostile, ("speed",)), study(hostile.assign(ate_rmse_m=0.03), ("speed",)))
    names = []
    for section in comparison.content.sections:
        for picture in section.pictures:
            svg, png = save_figure(picture.draw(), tmp_path / picture.name)
            assert svg.stat().st_size > 5000
            assert png.stat().st_size > 5000
            names.append(picture.name)
        for made in section.tables:
            assert len(made.frame)
            assert set(made.formats) <= set(made.frame)
            for column, form in made.formats.items():
                assert [form.format(value) for value in made.frame[column]]
            names.append(made.name)
    assert {"compared_metrics", "compared_pairs", "compared_success", "compared_ate", "compared_speed"} <= set(names)
    assert len(names) == len(set(names))


@pytest.mark.slow
@pytest.mark.parametrize("design", [{"paths": 30}, {"paths": 12, "repeats": 1}, {"paths": 12, "repeats": 10}])
def test_without_a_difference_there_is_hardly_ever_a_regression(design):
    wrong = 0
    for k in range(200):
        new, old = (study(runs(seed=2 * k + side, **design), ("speed",)) for side in (0, 1))
        pairs = pair_studies(new, old).pairs
        wrong += any(change.is_regression for change in metric_changes(pairs)) or len(regressed_pairs(pairs)) > 0
    assert wrong <= 10


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "metric"), [({"more_failures": 0.35}, "success"), ({"ate_factor": 1.5}, "ate_rmse_m")]
)
def test_a_clear_regression_is_nearly_always_found(change, metric):
    found = 0
    for k in range(40):
        new, old = study(runs(seed=2 * k, **change), ("speed",)), study(runs(seed=2 * k + 1), ("speed",))
        changes = metric_changes(pair_studies(new, old).pairs)
        found += any(one.is_regression and one.metric.name == metric for one in changes)
    assert found >= 38
