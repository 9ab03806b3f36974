from dataclasses import replace

import numpy as np
import pytest

from slamgym.eval.statistics import Interval
from slamgym.report.accuracy import run_threshold, threshold_section
from slamgym.report.causes import causes_section, causes_text
from slamgym.report.correlations import correlations_section
from slamgym.report.facts import driven, study_facts
from slamgym.report.failures import failures_section, trend_text, trends
from slamgym.report.judged import judged_runs, of_complete_paths
from slamgym.report.overview import figures
from slamgym.report.study import study_content
from slamgym.study.results import StudyResults
from tests.report.varied_study import varied_study


def changed(results, **columns):
    runs = results.runs.assign(**columns)
    return StudyResults(results.folder, results.name, "", results.factors, results.planned, runs)


def test_figures_of_a_group_by_hand():
    made = varied_study(paths=4, repeats=1)
    success = [True, True, True, False]
    judged = judged_runs(
        changed(
            made,
            success=success,
            ate_rmse_m=[0.1, 0.3, 0.2, 0.01],
            completion=[1.0, 0.8, 0.6, 0.2],
            loss_count=[0, 0, 0, 3],
        )
    )
    row = figures(judged.table)
    assert (row["paths"], row["runs"], row["failed"], row["failed share"]) == (4, 4, 1, 0.25)
    # A failed run counts as worse than any other, however small its ATE: the median of 0.1, 0.2, 0.3, failed.
    assert row["median ATE, failed last (m)"] == pytest.approx(0.25)
    assert row["median ATE, successful (m)"] == pytest.approx(0.2)
    assert row["mean completion"] == pytest.approx(0.65)
    # 3 losses in 4 drives of 8 s and 6 m.
    assert row["losses/min"] == pytest.approx(3 / (32 / 60))
    assert row["losses/m"] == pytest.approx(3 / 24)


def test_half_failed_leaves_no_median():
    made = varied_study(paths=4, repeats=1)
    row = figures(judged_runs(changed(made, success=[True, True, False, False])).table)
    assert row["median ATE, failed last (m)"] == np.inf


def test_causes_are_counted_by_level():
    made = varied_study({"stride": [0, 1]}, paths=2, repeats=1)
    causes = {"loss_causes.dark": [2.0, np.nan, 1.0, np.nan], "loss_causes.fast_turn": [np.nan, 1, np.nan, np.nan]}
    others = {name: np.nan for name in made.runs.columns if name.startswith("loss_causes.") and name not in causes}
    judged = judged_runs(changed(made, **others, **causes))
    (table,) = causes_section(judged).tables
    assert table.frame.to_dict("list") == {
        "cause": ["darkness", "fast turn"],
        "losses": [3, 1],
        "share": [0.75, 0.25],
        "stride 0": [3, 0],
        "stride 1": [0, 1],
    }
    assert causes_text(judged) == "the most frequent cause of losses is darkness: 3 of 4 (75 %), on 2 of 2 paths"
    (picture,) = causes_section(judged).pictures
    assert [bar.get_width() for bar in picture.draw().axes[0].containers[0]] == [1.5, 0.0]


@pytest.mark.parametrize(
    ("causes", "text"),
    [
        ({"unknown": 3}, "no cause stood out in any of the 3 losses"),
        (
            {"unknown": 9, "blur": 1},
            "the most frequent cause of losses is blur: 1 of 10 (10 %), on 1 of 1 path; in 9 nothing stood out",
        ),
        ({"fading": 2, "blur": 2}, "the most frequent causes of losses are fading points and blur: 2 each of 4"),
        ({}, "tracking was never lost"),
    ],
)
def test_the_cause_is_told_as_it_is(causes, text):
    made = varied_study(paths=1, repeats=1, half_fail_at=0)
    none = {name: np.nan for name in made.runs.columns if name.startswith("loss_causes.")}
    columns = {f"loss_causes.{cause}": float(n) for cause, n in causes.items()}
    assert causes_text(judged_runs(changed(made, **{**none, **columns}, loss_count=sum(causes.values())))) == text


def test_an_attribute_that_makes_paths_hard_is_found_and_chance_is_not():
    made = varied_study(paths=30, repeats=2)
    path = np.repeat(np.arange(30), 2)
    rng = np.random.default_rng(0)
    succeeds = changed(
        made, success=True, ate_rmse_m=0.01 * (1 + path), turning_deg=10.0 * path, tracked_points_median=rng.random(60)
    )
    section = correlations_section(judged_runs(succeeds))
    best = section.tables[0].frame.iloc[0]
    assert (best["attribute"], best["metric"], best["paths"]) == ("turning in all (deg)", "ATE (m), failed last", 30)
    assert best["Spearman"] == pytest.approx(1.0)
    assert "turning in all (deg)" in section.sentences[0]
    chance = changed(made, tracked_points_median=rng.random(60), angular_velocity_deg_per_s=rng.random(60))
    (told,) = correlations_section(judged_runs(chance)).sentences
    assert told == "Between the paths no attribute goes with errors or failures so that it could not be chance."


def test_what_the_conditions_change_on_one_path_is_told_apart_from_which_path_is_hard():
    made = varied_study({"speed": [0.2, 0.6, 1.0, 1.4, 1.8]}, paths=10, repeats=1)
    velocity = made.runs["speed"] + 0.0
    steady = changed(made, success=True, velocity_m_per_s=velocity, ate_rmse_m=0.01 * velocity)
    section = correlations_section(judged_runs(steady))
    between, within = section.tables
    assert between.frame.set_index(["attribute", "metric"]).loc["velocity (m/s)"]["Spearman"].isna().all()
    row = within.frame.set_index(["attribute", "metric"]).loc[("velocity (m/s)", "ATE (m), failed last")]
    assert row["mean Spearman"] == pytest.approx(1.0)
    assert row["corrected p"] < 0.05


def test_few_paths_have_no_correlations():
    assert correlations_section(judged_runs(varied_study(paths=5))) is None


def test_runs_beyond_the_gap_are_set_against_those_that_lost_tracking():
    made = varied_study(paths=30, repeats=1)
    rng = np.random.default_rng(0)
    bad = np.arange(30) >= 20
    ate = np.where(bad, 0.6, 0.02) * rng.lognormal(0, 0.3, 30)
    ate[29] = np.nan
    # One run was lost with a good ATE, one went astray without being lost.
    success = ~bad
    success[0], success[20] = False, True
    judged = judged_runs(changed(made, ate_rmse_m=ate, success=success))
    threshold = run_threshold(judged)
    assert threshold.found
    (table,) = threshold_section(judged, threshold).tables
    assert table.frame["runs"].iloc[2] == "no ATE"
    assert table.frame["succeeded"].tolist() == [19, 1, 0]
    assert table.frame["failed"].tolist() == [1, 8, 1]


def test_a_trend_is_told_as_far_as_it_is_known():
    def told(paths=20, levels=(0.2, 0.6, 1.0, 1.4), **kind):
        (trend,) = trends(judged_runs(varied_study({"speed": list(levels)}, paths=paths, **kind)))
        return trend_text(trend, others=False)

    assert told().startswith("half of the runs fail above 1.1 m/s (95 % interval 0.98 to 1.2): 0 % at 0.2 m/s")
    assert told(slope=-6.0).startswith("half of the runs fail below ")
    assert told(paths=3).startswith("too few paths (3) to tell a trend with the speed: ")
    assert told(half_fail_at=50).startswith(
        "failures show no certain trend with the speed: 0 % at 0.2 m/s, 0 % at 1.4 m/s"
    )
    beyond = told(paths=60, levels=(0.2, 0.4, 0.6, 0.8), half_fail_at=1.1)
    assert beyond.startswith("failures rise with the speed: ")
    assert beyond.endswith("; fewer than half fail at every level tried")
    below = told(paths=60, levels=(0.8, 1.0, 1.2, 1.4), half_fail_at=0.5)
    assert below.endswith("; more than half fail at every level tried")


def with_shares(shares, factor="brightness", paths=12, repeats=3):
    """All paths fail at each level in so many of their repeats, by the level's share; levels are 0, 1, 2..."""
    made = varied_study({factor: list(range(len(shares)))}, paths=paths, repeats=repeats)
    return changed(made, success=made.runs["repeat"] > repeats * made.runs[factor].map(dict(enumerate(shares))))


def test_a_curve_that_does_not_fit_is_no_trend():
    results = with_shares([1, 1 / 3, 0, 0, 2 / 3])
    (trend,) = trends(judged_runs(results))
    assert trend.changes
    assert not trend.is_seen
    headline, _, *levels = study_content(results).headlines
    assert headline == (
        "Failures do not simply rise or fall with the brightness: 100 % at brightness 0, 33 % at brightness 1, "
        "0 % at brightness 2, 0 % at brightness 3, 67 % at brightness 4."
    )
    assert levels[0].startswith("Fewer failures with brightness 1: ")
    (row,) = failures_section(judged_runs(results), [trend]).tables[0].frame.to_dict("records")
    assert np.isnan([row["half fail at"], row["95 % from"], row["95 % to"]]).all()


def test_failures_that_begin_at_one_level_are_a_rise():
    results = with_shares([0, 0, 2 / 3, 1], factor="speed")
    (trend,) = trends(judged_runs(results))
    assert np.isinf(trend.curve.slope)
    assert study_content(results).headlines[0].startswith("Half of the runs fail above 2.0 m/s (95 % interval ")
    (row,) = failures_section(judged_runs(results), [trend]).tables[0].frame.to_dict("records")
    assert row["half fail at"] == pytest.approx(2.0)
    curve = failures_section(judged_runs(results), [trend]).pictures[0].draw().axes[0]
    assert any(len(line.get_xdata()) > 10 for line in curve.lines)


def test_levels_that_differ_without_a_rise_are_no_uncertain_trend():
    (trend,) = trends(judged_runs(with_shares([1, 0, 0, 0, 1])))
    assert not trend.changes
    assert trend_text(trend, others=False).startswith(
        "failures differ between levels of the brightness, but do not surely rise or fall: 100 % at brightness 0, 0 %"
    )


def test_ends_beyond_the_levels_tried_are_left_open():
    made = varied_study({"speed": [0.2, 0.6, 1.0, 1.4]}, paths=20)
    (trend,) = trends(judged_runs(made))

    def with_midpoint(*middle):
        return replace(trend, curve=replace(trend.curve, midpoint=Interval(*middle)))

    open_below, open_above = with_midpoint(0.8, 0.1, 1.2), with_midpoint(0.8, 0.4, 1.5)
    assert "(95 % interval 1.2 or less)" in trend_text(open_below, others=False)
    assert "(95 % interval 0.40 or more)" in trend_text(open_above, others=False)
    neither = with_midpoint(0.8, 0.1, 1.5)
    assert trend_text(neither, others=False).startswith("failures rise with the speed: ")
    table = failures_section(judged_runs(made), [open_below, open_above, neither]).tables[0].frame
    shown = table[["half fail at", "95 % from", "95 % to"]].to_numpy()
    assert shown[0, 1] == -np.inf
    assert shown[1, 2] == np.inf
    assert np.isnan(shown[2]).all()


def test_levels_that_hard_paths_alone_were_driven_at_are_no_trend():
    made = varied_study({"speed": [0.2, 0.6, 1.0, 1.4]}, paths=24, repeats=2)
    path = np.repeat(np.arange(24), 8)
    fails = path < 12
    results = replace(made, runs=made.runs.assign(success=~fails)[~(fails & (made.runs["speed"] < 1.0))])
    judged = judged_runs(results)
    (trend,) = trends(judged)
    assert set(trend.share_at.values()) == {0.0}
    content = study_content(results)
    left_out = "12 of 24 paths lack runs under some conditions; trends, the table at a glance and correlations leave "
    assert content.notices[-1].startswith(left_out)
    overview, failures = content.sections[:2]
    assert overview.tables[0].frame["paths"].tolist() == [24, 12, 12, 12, 12]
    assert overview.tables[0].caption.endswith(" Levels are of the 12 of 24 paths with runs under all conditions.")
    assert failures.sentences[-1].startswith(left_out)


def test_paths_of_other_conditions_are_not_compared_even_if_they_have_as_many():
    made = varied_study({"speed": [0.2, 0.6, 1.0, 1.4]}, paths=9, repeats=1)
    slow = made.runs["speed"] < 0.8
    three = made.runs["path"].str.startswith("procedural:0 ")
    judged = judged_runs(replace(made, runs=made.runs[slow ^ three]))
    assert of_complete_paths(judged).paths == 6
    assert not trends(judged)


@pytest.mark.parametrize(
    ("column", "value"),
    [
        ("run.reset_options.tour", "round_trip"),
        ("run.reset_options.tour", "lap"),
        ("agent", "patrol"),
        ("agent", "lap"),
    ],
)
def test_facts_tell_round_trips_and_loops(column, value):
    made = varied_study(paths=3, repeats=2)
    back = {column: value, "loops_closed": [0, 1, 2, 0, 0, 0]}
    results = changed(made, **back)
    facts = study_facts(results, judged_runs(results))
    told = "3 drives back to the start; with loop closing on, a loop was seen to close in 2 of 6 runs"
    assert facts["Round trips"] == told
    assert facts["Shown to the SLAM"] == "36 m in 48 s, 1,440 frames fed"
    assert facts["Repeats"] == "2"
    assert facts["Paths"] == "3 paths of dataset 0 in 1 house"
    assert facts["Versions"] == "slamgym 0.1.0"
    assert "Not run" not in facts


def test_facts_tell_where_and_when():
    made = varied_study(paths=2, repeats=1)
    when = {"timing.ended": ["2026-03-02T23:59:59+00:00", "2026-03-01T08:00:00+00:00"]}
    results = changed(made, **when, **{"timing.computer": "AMD EPYC, 2 cores"})
    facts = study_facts(results, judged_runs(results))
    assert (facts["Run"], facts["Computer"]) == ("2026-03-01 to 2026-03-02", "AMD EPYC, 2 cores")
    one_day = changed(made, **{"timing.ended": "2026-03-01T08:00:00+00:00"})
    assert study_facts(one_day, judged_runs(one_day))["Run"] == "2026-03-01"
    assert "Run" not in study_facts(made, judged_runs(made))


def test_of_recorded_sequences_time_and_distance_come_from_the_frames():
    made = varied_study(paths=2, repeats=1)
    # 21 frames that were fed, 20 steps: of 1 and of 3 frames of the sequence.
    recorded = changed(
        made, duration_s=np.nan, distance_m=np.nan, frames_fed=21, fps=10.0, stride=[0, 2], velocity_m_per_frame=0.1
    )
    seconds, metres = driven(recorded.runs)
    assert seconds == pytest.approx([2.0, 6.0])
    assert metres == pytest.approx([2.0, 2.0])


def test_a_heat_map_has_the_first_factor_to_the_right():
    made = varied_study({"speed": [0.5, 1.0, 1.5], "stride": [0, 1]}, paths=2, repeats=1)
    fails = (made.runs["speed"] == 1.5) & (made.runs["stride"] == 0)
    judged = judged_runs(changed(made, success=~fails))
    (heat_map,) = [p for p in failures_section(judged, []).pictures if p.name == "heat_map_speed_stride"]
    axes = heat_map.draw().axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("speed (m/s)", "stride (frames left out)")
    assert [label.get_text() for label in axes.get_xticklabels()] == ["0.5", "1", "1.5"]
    written = {tuple(int(p) for p in text.get_position()): text.get_text() for text in axes.texts}
    assert {place for place, text in written.items() if text == "2/2"} == {(2, 0)}
    assert set(written) == {(x, y) for x in range(3) for y in range(2)}


def test_a_table_of_midpoints_has_the_curves_figures():
    made = varied_study({"speed": [0.2, 0.6, 1.0, 1.4]}, paths=20)
    (trend,) = trends(judged_runs(made))
    (row,) = failures_section(judged_runs(made), [trend]).tables[0].frame.to_dict("records")
    middle = trend.midpoint
    assert [row["half fail at"], row["95 % from"], row["95 % to"]] == [middle.estimate, middle.low, middle.high]
    assert middle.low < middle.estimate < middle.high
    assert (row["runs"], row["failed"]) == (len(made.runs), int((~made.runs["success"]).sum()))


def test_sequences_of_one_name_in_two_datasets_are_two_paths():
    made = varied_study(paths=4, repeats=2, datasets=2)
    number = made.runs["drive_id"].str[-1].astype(int)
    judged = judged_runs(changed(made, path=(number // 2).astype(str)))
    assert judged.paths == 4
    assert set(judged.table["place"]) == {"dataset 0: 0", "dataset 1: 0", "dataset 0: 1", "dataset 1: 1"}
    assert set(judged_runs(made).table["place"]) == set(made.runs["path"])


def test_relative_errors_of_a_path_are_those_of_its_successful_runs():
    made = varied_study(paths=2, repeats=2)
    judged = judged_runs(changed(made, success=[True, False, False, False], rpe_trans_rmse_m=[0.1, 9.0, 8.0, 7.0]))
    assert judged.cells["rpe_trans_rmse_m"].tolist() == pytest.approx([0.1, np.nan], nan_ok=True)
