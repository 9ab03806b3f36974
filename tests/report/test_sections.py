import numpy as np
import pytest

from slamgym.report.accuracy import run_threshold, threshold_section
from slamgym.report.causes import causes_section, causes_text
from slamgym.report.correlations import correlations_section
from slamgym.report.facts import study_facts
from slamgym.report.failures import trend_text, trends
from slamgym.report.judged import judged_runs
from slamgym.report.overview import figures
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
    assert causes_text(judged) == "the most frequent cause of losses is darkness: 3 of 4 (75 %)"
    (picture,) = causes_section(judged).pictures
    assert [bar.get_width() for bar in picture.draw().axes[0].containers[0]] == [1.5, 0.0]


@pytest.mark.parametrize(
    ("causes", "text"),
    [
        ({"unknown": 3}, "no cause stood out in any of the 3 losses"),
        (
            {"unknown": 9, "blur": 1},
            "the most frequent cause of losses is blur: 1 of 10 (10 %); in 9 nothing stood out",
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
    assert beyond.endswith("half of the runs would fail beyond them")


def test_facts_tell_round_trips_and_loops():
    made = varied_study(paths=3, repeats=2)
    back = {"run.reset_options.tour": "round_trip", "loops_closed": [0, 1, 2, 0, 0, 0]}
    results = changed(made, **back)
    facts = study_facts(results, judged_runs(results))
    assert facts["Round trips"] == "3 drives back to the start; loops seen to close in 2 of 6 runs"
    assert facts["Driven"] == "36 m in 48 s, 1,440 frames fed"
    assert facts["Repeats"] == "2"
    assert facts["Versions"] == "slamgym 0.1.0"
    assert "Not run" not in facts
