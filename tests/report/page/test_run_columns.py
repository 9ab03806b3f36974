import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from slamgym.report.page.run_columns import outcomes, run_columns, run_kinds, runs_data
from slamgym.study.results import StudyResults


def study(factors=(), **columns):
    n = len(next(iter(columns.values())))
    whole = {"run_id": [f"drive/{k}" for k in range(n)], "path": "p", "status": "ok", "success": True, **columns}
    return StudyResults(Path("study"), "s", "", tuple(factors), n, pd.DataFrame(whole))


def column(results, heading):
    return next(c for c in run_columns(results) if c.heading == heading)


def shown(results, heading):
    found = column(results, heading)
    return [found.shown(row) for row in range(len(results.runs))]


def test_every_outcome_in_words():
    runs = pd.DataFrame(
        {
            "status": ["ok", "ok", "ok", "lost", "init_failed", "crashed", "timeout", "not_run", "odd"],
            "success": [True, False, False, False, False, False, False, None, False],
            "loss_count": [0, 2, 0, 1, 0, 1, 0, np.nan, 0],
        }
    )
    assert outcomes(runs) == [
        "success", "failed: lost for a time", "failed: tracked too little", "failed: lost at the end",
        "failed: never tracked", "failed: crashed", "failed: timeout", "not run", "failed: odd",
    ]  # fmt: skip


def test_levels_are_in_their_own_order_and_default_is_one():
    results = study(["turn_rate", "loop_closure"], turn_rate=[10.0, np.nan, 2.0], loop_closure=[True, False, None])
    rate = column(results, "turn rate (rad/s)")
    assert (rate.words, rate.values, rate.filtered) == (["2", "10", "default"], [1, 2, 0], True)
    assert shown(results, "loop closing") == ["on", "off", "default"]


def test_figures_are_rounded_and_missing_ones_are_none():
    results = study(completion=[0.99999, 1.0, np.nan], ate_rmse_m=[0.123456, np.inf, 2.0], loss_count=[1, 0, 12])
    assert column(results, "completion (%)").values == [99.9, 100.0, None]
    assert shown(results, "ATE (m)") == ["0.1235", "-", "2.0000"]
    assert shown(results, "losses") == ["1", "0", "12"]


def test_causes_are_named_the_most_frequent_first():
    results = study(**{"loss_causes.blur": [1, np.nan, 0], "loss_causes.fast_turn": [3, 1, 0]})
    assert shown(results, "causes of losses") == ["fast turn (3), blur", "fast turn", "-"]


def test_causes_have_the_words_of_the_sections():
    results = study(**{"loss_causes.dark": [1, 0], "loss_causes.frame_gap": [0, 2]})
    assert shown(results, "causes of losses") == ["darkness", "gap between frames (2)"]


def test_what_a_run_came_to_stands_before_what_was_varied():
    results = study(["speed", "stride"], speed=[1, 2], stride=[0, 1], dataset=["a", "b"], completion=1.0,
        loss_count=0, ate_rmse_m=0.1, loops_closed=1, repeat=[1, 2])  # fmt: skip
    assert [c.heading for c in run_columns(results)] == [
        "path", "outcome", "completion (%)", "losses", "ATE (m)", "causes of losses", "speed (m/s)",
        "stride (frames left out)", "repeat", "dataset", "loops closed",
    ]  # fmt: skip


def test_how_a_run_is_repeated_depends_on_what_it_was():
    runs = pd.DataFrame({"status": ["ok", "lost", "not_run"], "sequence": [None, "data/fr1", "data/fr1"]})
    assert run_kinds(runs) == ["drive", "sequence", "none"]
    assert run_kinds(runs[["status"]]) == ["drive", "drive", "none"]


@pytest.mark.parametrize(("repeat", "is_told"), [([1, 1], False), ([1, 2], True)])
def test_repeats_are_told_where_there_are_several(repeat, is_told):
    assert ("repeat" in [c.heading for c in run_columns(study(repeat=repeat))]) == is_told


def test_run_ids_and_all_else_are_plain_json():
    results = study(["speed"], run_id=["a/1", "a/2", "b\x00/1"], speed=[1, 2, 1], loss_count=[0, 0, 1])
    data = json.loads(json.dumps(runs_data(results.runs, run_columns(results)), allow_nan=False))
    ids = [
        f"{data['drive']['words'][drive]}/{data['rest']['words'][rest]}"
        for drive, rest in zip(data["drive"]["values"], data["rest"]["values"], strict=True)
    ]
    assert ids == ["a/1", "a/2", "b\ufffd/1"]
