import warnings

import numpy as np
import pytest
from evo.core.sync import matching_time_indices
from hypothesis import given
from hypothesis import strategies as st

from slamgym.errors import ConfigError, TrajectoryError, TrajectoryWarning
from slamgym.eval.trajectories import associate, match_stamps

pytestmark = pytest.mark.filterwarnings("ignore::slamgym.errors.TrajectoryWarning")
# Dense ones have many ties, wide ones few.
STAMPS = st.one_of(
    *(st.lists(st.integers(0, top), min_size=1, max_size=30, unique=True).map(sorted) for top in (35, 60, 10**6))
)
BOUNDS = st.one_of(st.integers(0, 20), st.just(10**5), st.just(10**30))


def tum_associate(ref_ns, est_ns, max_difference_ns):
    """associate.py of the TUM tools, written out."""
    candidates = sorted((abs(a - b), a, b) for a in ref_ns for b in est_ns if abs(a - b) < max_difference_ns)
    free_ref, free_est, matches = set(ref_ns), set(est_ns), []
    for _, a, b in candidates:
        if a in free_ref and b in free_est:
            free_ref.remove(a)
            free_est.remove(b)
            matches.append((ref_ns.index(a), est_ns.index(b)))
    return sorted(matches)


@given(ref_ns=STAMPS, est_ns=STAMPS, max_difference_ns=BOUNDS)
def test_association_as_the_tum_tools_do_it(trajectory_at, ref_ns, est_ns, max_difference_ns):
    expected = tum_associate(ref_ns, est_ns, max_difference_ns)
    if not expected:
        with pytest.raises(TrajectoryError, match="same clock"):
            associate(trajectory_at(ref_ns), trajectory_at(est_ns), max_difference_ns)
        return
    ref, est = associate(trajectory_at(ref_ns), trajectory_at(est_ns), max_difference_ns)
    assert list(zip(ref.tolist(), est.tolist(), strict=True)) == expected


@given(ref_ns=STAMPS, est_ns=STAMPS, max_difference_ns=BOUNDS)
def test_association_as_evo_does_it(trajectory_at, ref_ns, est_ns, max_difference_ns):
    ref_s, est_s = np.array(ref_ns, dtype=float), np.array(est_ns, dtype=float)
    if len(est_ns) > len(ref_ns):
        expected_ref, expected_est = matching_time_indices(ref_s, est_s, max_difference_ns)
    else:
        expected_est, expected_ref = matching_time_indices(est_s, ref_s, max_difference_ns)
    if not expected_ref:
        with pytest.raises(TrajectoryError, match="same clock"):
            associate(trajectory_at(ref_ns), trajectory_at(est_ns), max_difference_ns, "evo")
        return
    ref, est = associate(trajectory_at(ref_ns), trajectory_at(est_ns), max_difference_ns, "evo")
    assert (ref.tolist(), est.tolist()) == (expected_ref, expected_est)


def test_the_two_conventions_differ(trajectory_at):
    # Both estimates are nearest to the truth at 10; one to one, the second takes what is left: 20, 8 away.
    ref, est = trajectory_at([10, 20, 40]), trajectory_at([9, 12])
    assert [side.tolist() for side in associate(ref, est, 9, "tum")] == [[0, 1], [0, 1]]
    assert [side.tolist() for side in associate(ref, est, 9, "evo")] == [[0, 0], [0, 1]]


def test_the_bound_itself_counts_in_one_convention_only(trajectory_at):
    ref, est = trajectory_at([0]), trajectory_at([20_000_000])
    assert len(associate(ref, est, convention="evo")[0]) == 1
    with pytest.raises(TrajectoryError, match=r"within 0\.02 s of each other"):
        associate(ref, est)


def test_midway_stamps_are_paired_one_after_the_other(trajectory_at):
    # Every pose is equally far from both of its neighbours: the earliest pair decides all that follow.
    ref, est = associate(trajectory_at(range(0, 20_000, 2)), trajectory_at(range(1, 20_000, 2)), 10**9)
    assert ref.tolist() == est.tolist() == list(range(10_000))


def test_a_bound_that_reaches_over_everything_takes_no_memory_for_all_pairs(trajectory_at):
    # All pairs would be 2e9.
    ref = trajectory_at(np.arange(100_000) * 10)
    est = trajectory_at(np.arange(20_000) * 50 + 1)
    ref_index, est_index = associate(ref, est, 10**18)
    assert ref_index.tolist() == list(range(0, 100_000, 5))
    assert est_index.tolist() == list(range(20_000))


@pytest.mark.parametrize("convention", ["tum", "evo"])
def test_an_estimate_that_mostly_lies_outside_is_told(trajectory_at, convention):
    ref = trajectory_at([0, 10, 20])
    with pytest.warns(TrajectoryWarning, match="3 of the estimate's 5 poses have no partner"):
        associate(ref, trajectory_at([1, 11, 100, 110, 120]), 5, convention)
    # Half of them, 2 of 4, is not most of them.
    with warnings.catch_warnings(action="error"):
        assert len(associate(ref, trajectory_at([1, 11, 100, 110]), 5, convention)[0]) == 2


def test_a_pose_that_comes_up_twice_is_one_pose_with_a_partner(trajectory_at):
    # Both true poses are nearest to the pose at 11, so those at 50 and 60 are alone: 2 of 3.
    with pytest.warns(TrajectoryWarning, match="2 of the estimate's 3 poses have no partner"):
        pair = associate(trajectory_at([10, 12]), trajectory_at([11, 50, 60]), 5, "evo")
    assert [side.tolist() for side in pair] == [[0, 1], [0, 0]]


@pytest.mark.parametrize("convention", ["tum", "evo"])
def test_nothing_matches_an_empty_trajectory(trajectory_at, convention):
    for ref, est in (([], [1, 2]), ([1, 2], []), ([], [])):
        with pytest.raises(TrajectoryError, match="no pose"):
            associate(trajectory_at(ref), trajectory_at(est), 10, convention)


@pytest.mark.parametrize("bound", [-1, float("nan")])
def test_a_bound_below_zero(trajectory_at, bound):
    with pytest.raises(ConfigError, match="0 ns or more"):
        associate(trajectory_at([1]), trajectory_at([1]), bound)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("convention", ["tum", "evo"])
def test_stamps_without_partner_are_no_error_of_their_own(convention):
    ref, est = match_stamps(np.array([0, 10]), np.array([100]), 5, convention)
    assert ref.dtype == est.dtype == np.int64
    assert len(ref) == len(est) == 0


def test_an_unknown_convention(trajectory_at):
    with pytest.raises(ConfigError, match="did you mean 'tum'"):
        associate(trajectory_at([1]), trajectory_at([1]), 1, "tun")
