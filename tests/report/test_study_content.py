from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from slamgym.report.judged import judged_runs
from slamgym.report.study import study_content
from slamgym.study.results import StudyResults
from tests.report.varied_study import varied_study

WORDS = {"slam": ["orbslam3", "opencv", "$x$ & <b>"]}


def drawn(content):
    """Draws every picture, and gives the names; each must be fit for a file and used once."""
    pictures = [picture for section in content.sections for picture in section.pictures]
    for picture in pictures:
        picture.draw().draw_without_rendering()
    names = [picture.name for picture in pictures]
    assert len(set(names)) == len(names)
    assert all(name.isidentifier() for name in names)
    return names


def checked(content):
    """Sentences that are sentences, and tables whose formats fit."""
    told = [*content.notices, *content.headlines, *(text for section in content.sections for text in section.sentences)]
    assert told
    for text in told:
        assert text.endswith(".")
        assert "nan" not in text.lower()
        assert "inf" not in text
    for section in content.sections:
        for table in section.tables:
            assert set(table.formats) <= set(table.frame.columns) or table.name in {"overview", "datasets", "paths"}
            assert table.caption.endswith(".")
            for column in set(table.formats) & set(table.frame.columns):
                assert [table.formats[column].format(value) for value in table.frame[column]]
    return content


def sections(content):
    return {section.anchor: section for section in content.sections}


def with_all(results, **columns):
    return StudyResults(
        results.folder,
        results.name,
        results.description,
        results.factors,
        results.planned,
        results.runs.assign(**columns),
    )


def test_a_study_of_speed_stride_and_loop_closing_has_the_papers_figures():
    factors = {"speed": [0.2, 0.6, 1.0, 1.4], "stride": [0, 2], "loop_closure": [True, False]}
    content = checked(study_content(varied_study(factors, paths=10, datasets=2)))
    expected = ["overview", "failures", "levels", "accuracy", "paths", "threshold", "correlations", "causes"]
    assert list(sections(content)) == expected
    names = drawn(content)
    assert {"failure_curve_speed", "heat_map_speed_stride", "sorted_bars_speed", "cumulative_loop_closure"} <= set(
        names
    )
    assert {"levels_loop_closure", "causes_speed", "correlations", "threshold"} <= set(names)


def test_the_figure_that_made_the_numbers_is_found_again():
    factors = {"speed": [0.2, 0.6, 1.0, 1.4, 1.8], "loop_closure": [True, False]}
    headlines = study_content(varied_study(factors, paths=30, half_fail_at=0.9)).headlines
    assert headlines[0].startswith("Half of the runs fail above 0.9")
    assert "all levels of the other factors together" in headlines[0]
    assert " of 600 runs failed" in headlines[1]
    (loops,) = [text for text in headlines if text.startswith("With loop closing on")]
    assert "no difference seen" in loops


@pytest.mark.parametrize(
    ("factors", "kind"),
    [
        ({}, {}),
        ({"speed": [0.2, 1.0, 1.8]}, {"paths": 1, "repeats": 1}),
        ({"speed": [0.2]}, {"paths": 1, "repeats": 1}),
        ({}, {"paths": 1, "repeats": 1}),
        (WORDS, {"paths": 7, "repeats": 1}),
        ({"turn_rate": [None, 1.0, 2.0]}, {"paths": 7}),
        ({"speed": [0.5, 1.0, 1.5]}, {"half_fail_at": 90.0}),
        ({"speed": [0.5, 1.0, 1.5]}, {"half_fail_at": -90.0}),
        ({"a": [1, 2], "b": [True, False], "c": ["x", "y"], "d": [0.1, 0.2], "e": [1, 2]}, {"paths": 2, "repeats": 1}),
        ({"speed": np.linspace(0.1, 2, 30).tolist(), "stride": list(range(8))}, {"paths": 2, "repeats": 1}),
    ],
    ids=[
        "none",
        "one path",
        "one level",
        "one run",
        "words",
        "none is a level",
        "none fails",
        "all fail",
        "five",
        "many",
    ],
)
def test_any_study_has_a_report(factors, kind):
    content = checked(study_content(varied_study(factors, **kind)))
    assert "overview" in sections(content)
    drawn(content)


def test_without_a_run_to_judge_it_says_so():
    made = varied_study({"speed": [0.2, 1.0]}, paths=2)
    not_run = with_all(made, status="not_run", success=np.nan, failure="house.glb: no such file")
    content = checked(study_content(not_run))
    assert content.notices == ("There is no run to judge: 8 could not be started.",)
    assert not content.headlines
    assert content.facts["Not run"] == "8 runs: house.glb: no such file"
    assert not content.sections
    only_plan = not_run.runs[["run_id", "dataset", "path", "speed", "status", "failure"]]
    bare = StudyResults(made.folder, "bare", "", made.factors, 8, only_plan)
    assert study_content(bare).notices == content.notices


def test_a_study_without_any_run_says_so():
    nothing = StudyResults(varied_study().folder, "nothing", "", ("speed",), 12, pd.DataFrame())
    content = study_content(nothing)
    assert content.notices == (
        "The study is not finished: 0 of 12 runs are done, and all below is of these.",
        "There is no run to judge.",
    )


def test_an_unfinished_study_says_so_first():
    content = study_content(varied_study({"speed": [0.2, 1.0]}, paths=8, planned=1000))
    assert content.notices[0] == "The study is not finished: 32 of 1,000 runs are done, and all below is of these."
    assert content.facts["Runs"] == "32 runs of 1,000 planned; the study is not finished"


def test_runs_that_could_not_be_started_are_no_failures_of_the_slam():
    made = varied_study({"speed": [0.2, 1.0]}, paths=8, half_fail_at=50)
    status = made.runs["status"].where(made.runs.index > 4, "not_run")
    content = study_content(with_all(made, status=status, success=made.runs["success"].where(made.runs.index > 4)))
    assert content.notices[0] == "5 runs could not be started and are left out."
    assert content.headlines[0].startswith("0 of 27 runs failed (0 %;")


def test_a_level_of_which_no_run_could_be_started_is_named():
    made = varied_study({"speed": [0.2, 1.0, 1.8], "stride": [0, 1]}, paths=8)
    gone = made.runs["speed"] == 1.8
    content = study_content(with_all(made, status=made.runs["status"].mask(gone, "not_run")))
    assert content.notices == (
        "32 runs could not be started and are left out.",
        "No run at 1.8 m/s could be started.",
    )


def test_factors_of_an_unfinished_study_are_not_taken_for_one():
    made = varied_study({"stride": [0, 1], "loop_closure": [False, True]}, paths=8)
    diagonal = made.runs[made.runs["stride"] == made.runs["loop_closure"]]
    titles = [factor.title for factor in judged_runs(replace(made, runs=diagonal)).factors]
    assert titles == ["stride", "loop closing"]
    zipped = replace(made, runs=diagonal, planned=len(diagonal))
    assert [factor.title for factor in judged_runs(zipped).factors] == ["stride with loop closing"]


def test_paths_of_one_house_tell_of_these_houses():
    made = varied_study({"stride": [0, 1]}, paths=12)
    (overall,) = [text for text in study_content(made).headlines if " of 48 runs failed" in text]
    assert overall.endswith(" for paths like these 12 in these 4 houses).")
    (overall,) = [
        text for text in study_content(with_all(made, scene=made.runs["path"])).headlines if " of 48 runs" in text
    ]
    assert overall.endswith(" for paths like these 12).")


def test_of_levels_that_are_alike_the_furthest_is_told():
    made = varied_study({"stride": ["none", "few", "many"]}, paths=8, half_fail_at=50)
    told = study_content(with_all(made, success=True)).headlines
    assert any(text.startswith("With stride many, 0 of 16 runs failed; with stride none, 0 of 16: ") for text in told)


def test_recorded_sequences_without_drives_have_a_report():
    made = varied_study({"stride": [0, 1, 3], "loop_closure": [True, False]}, paths=6)
    recorded = with_all(made, sequence=made.runs["path"], scene=None)
    without = StudyResults(
        made.folder, "fr1", "", made.factors, made.planned, recorded.runs.drop(columns=["duration_s", "distance_m"])
    )
    content = checked(study_content(without))
    # 72 runs of 240 frames at 30 frames a second, of which a stride of s feeds every (s + 1)-th.
    seconds = 24 * 239 / 30 * (1 + 2 + 4)
    assert f"in {seconds / 60:.0f} min, 17,280 frames fed" in content.facts["Shown to the SLAM"]
    drawn(content)


def test_sequences_without_a_truth_have_failures_and_no_errors():
    made = varied_study({"stride": [0, 1]}, paths=8)
    unknown = dict.fromkeys(["ate_rmse_m", "rpe_trans_rmse_m", "rpe_rot_mean_deg", "velocity_m_per_frame"], np.nan)
    content = checked(study_content(with_all(made, **unknown)))
    row = sections(content)["overview"].tables[0].frame.iloc[0]
    assert row["failed"] == (~made.runs["success"]).sum()
    assert np.isnan(row["median ATE, successful (m)"])
    drawn(content)


def test_only_times_are_asked_of_a_study_of_the_computer():
    made = varied_study({"slam_sync": ["lockstep", "realtime"], "busy_processes": [0, 2]}, paths=6)
    (table,) = sections(study_content(made))["computer"].tables
    assert list(table.frame["level"]) == ["lockstep", "realtime", "0", "2"]
    assert (table.frame["runs"] == 24).all()
    assert "computer" not in sections(study_content(varied_study({"stride": [0, 1]}, paths=6)))


def test_names_of_files_stay_text():
    made = varied_study({"stride": [0, 1]}, paths=7)
    evil = "<script>alert(1)</script>"
    content = study_content(with_all(made, path=evil + " #" + made.runs.index.astype(str).str[-1], dataset=evil))
    (table,) = sections(content)["paths"].tables
    assert table.frame["path"].str.startswith(evil).all()


def test_a_hundred_thousand_runs_make_no_picture_of_a_hundred_thousand_things():
    factors = {"speed": np.linspace(0.1, 2, 10).tolist(), "stride": [0, 1, 2, 3, 5], "loop_closure": [True, False]}
    made = varied_study(factors, paths=100, repeats=10)
    assert len(made.runs) == 100_000
    content = study_content(made)
    for section in content.sections:
        for picture in section.pictures:
            assert sum(1 for _ in picture.draw().findobj()) < 6000
