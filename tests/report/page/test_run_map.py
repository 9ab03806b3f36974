import numpy as np
import pytest

from slamgym.report.page.run_files import RunFiles
from slamgym.report.page.run_map import pieces, run_map
from slamgym.report.page.timeline import timeline

N = 11


def run(states=("ok",) * N, map_ids=None, losses=(), truth=None, estimate=None, flat=True, **changes):
    """A drive of 10 m along x in 10 s, one fed frame a second."""
    line = np.column_stack([np.arange(N), np.zeros(N), np.zeros(N)]).astype(float)
    truth = line if truth is None else truth
    tracked = np.array(states) == "ok"
    values = {
        "summary": {"map_policy": "largest", "losses": [{"start_frame": a, "end_frame": b} for a, b in losses]},
        "fed_s": np.arange(N) * 1.0,
        "states": tuple(states),
        "truth": truth,
        "estimate": np.where(tracked[:, None], line if estimate is None else estimate, np.nan),
        "map_ids": np.where(tracked, 0 if map_ids is None else map_ids, -1),
        "tracked_points": np.full(N, 50.0),
        "frames_s": np.arange(N) * 1.0,
        "speed_mps": np.linspace(0.0, 2.0, N),
        "turn_degps": np.where(np.arange(N) == 5, -30.0, 10.0),
        "flat": flat,
    }
    return RunFiles(**{**values, **changes})


def lines(drawn, kind):
    return [
        np.array([point.split(",") for point in line.points.split()], dtype=int)
        for line in drawn.lines
        if line.kind == kind
    ]


def test_metres_are_the_same_both_ways_and_y_points_upwards(tmp_path):
    truth = np.column_stack([np.linspace(0, 4, N), np.linspace(0, 2, N), np.zeros(N)])
    drawn = run_map(run(truth=truth, estimate=truth), tmp_path)
    # 4 m and a margin of 5 % on either side fill the width.
    assert drawn.metre == round(1000 / 4.4)
    assert (drawn.width, drawn.height) == (1000, round(2.4 * 1000 / 4.4))
    (line,) = lines(drawn, "truth")
    assert line[0].tolist() == [round(0.2 * 1000 / 4.4), round(2.2 * 1000 / 4.4)]
    assert line[-1].tolist() == [round(4.2 * 1000 / 4.4), round(0.2 * 1000 / 4.4)]
    assert drawn.start == tuple(line[0].tolist())


def test_every_map_is_aligned_on_its_own_and_cut_where_it_was_lost(tmp_path):
    """The estimate of the second map is turned by 90 degrees and far away: aligned it lies on the truth."""
    states = ("ok",) * 4 + ("lost",) + ("ok",) * 6
    map_ids = np.where(np.arange(N) < 4, 0, 1)
    turned = np.column_stack([np.full(N, 100.0), np.arange(N), np.zeros(N)])
    line = np.column_stack([np.arange(N), np.zeros(N), np.zeros(N)])
    drawn = run_map(run(states, map_ids, [(4, 4)], estimate=np.where(map_ids[:, None] == 1, turned, line)), tmp_path)
    (truth,), (largest,), (other,), (lost,) = (lines(drawn, kind) for kind in ("truth", "estimate", "other", "lost"))
    assert np.abs(largest - truth[5:]).max() <= 1
    assert np.abs(other - truth[:4]).max() <= 1
    assert lost.tolist() == truth[3:6].tolist()
    assert [(cross.number, cross.x, cross.y) for cross in drawn.crosses] == [(1, *truth[4].tolist())]


def test_a_map_of_two_poses_cannot_be_aligned(tmp_path):
    states = ("lost",) * 9 + ("ok",) * 2
    assert run_map(run(states), tmp_path).kinds == {"truth"}


def test_without_a_truth_the_estimate_is_in_its_own_frame(tmp_path):
    """Of a camera, with z forwards."""
    forwards = np.column_stack([np.arange(N) / 2, np.zeros(N), np.arange(N)])
    drawn = run_map(run(truth=np.full((N, 3), np.nan), estimate=forwards, flat=False), tmp_path)
    (line,) = lines(drawn, "estimate")
    assert drawn.kinds == {"estimate"}
    assert drawn.start is None
    assert line[0][1] - line[-1][1] == pytest.approx(10 * drawn.metre, abs=10)


def test_nothing_known_is_no_map(tmp_path):
    assert run_map(run(("not_initialized",) * N, truth=np.full((N, 3), np.nan)), tmp_path) is None


def test_a_long_path_is_thinned_out_and_keeps_its_ends(tmp_path):
    truth = np.column_stack([np.linspace(0, 10, 5000), np.zeros(5000), np.zeros(5000)])
    drawn = run_map(run(("lost",) * 5000, truth=truth, estimate=truth, map_ids=0), tmp_path)
    (line,) = lines(drawn, "truth")
    assert 140 < len(line) < 160
    assert (line[0][0], line[-1][0]) == (45, 955)


def test_pieces_are_runs_of_true():
    assert pieces(np.array([1, 1, 0, 0, 1], dtype=bool)) == [slice(0, 2), slice(4, 5)]
    assert pieces(np.zeros(3, dtype=bool)) == []


def test_a_state_lasts_until_the_next_one_begins():
    drawn = timeline(run(("not_initialized",) + ("ok",) * 4 + ("lost",) * 5 + ("ok",)))
    assert drawn.duration_s == 10.0
    assert [(span.state, span.x) for span in drawn.spans] == [
        ("not_initialized", 0),
        ("ok", 100),
        ("lost", 500),
        ("ok", 1000),
    ]
    assert [span.width for span in drawn.spans] == [100, 400, 500, 4]


def test_curves_are_cut_where_nothing_is_known_and_begin_at_zero():
    drawn = timeline(run(("ok",) * 3 + ("lost",) * 3 + ("ok",) * 5, speed_mps=np.full(N, np.nan)))
    points, turn = drawn.curves
    assert (points.label, points.top, points.bottom) == ("tracked points", 50.0, 0.0)
    assert [line.split() for line in points.lines] == [
        ["0,0", "100,0", "200,0"],
        ["600,0", "700,0", "800,0", "900,0", "1000,0"],
    ]
    # From 10 down to -30 degrees a second, of a strip of 100.
    assert (turn.label, turn.top, turn.bottom) == ("turn rate", 10.0, -30.0)
    assert "500,100" in turn.lines[0].split()
    assert turn.range_text == "-30 to 10 °/s"


def test_ranges_are_plain_numbers():
    curve = next(iter(timeline(run(tracked_points=np.full(N, 1010.0))).curves))
    assert curve.range_text == "0 to 1010"


def test_no_peak_of_a_long_drive_is_thinned_out():
    n = 100_000
    speed = np.zeros(n)
    speed[77_777] = 3.0
    drawn = timeline(run(frames_s=np.linspace(0, 10, n), speed_mps=speed, turn_degps=np.zeros(n)))
    curve = next(curve for curve in drawn.curves if curve.label == "speed")
    assert curve.top == 3.0
    points = curve.lines[0].split()
    assert len(points) < 200
    assert "778,0" in points


def test_a_run_that_was_never_fed_has_no_timeline():
    assert timeline(run((), fed_s=np.empty(0), map_ids=np.empty(0, int), estimate=np.empty((0, 3)))) is None
