"""evo is the oracle: the same poses give the same numbers, and published figures come out again.

No tolerance beyond 1e-9 is needed: today's evo takes rotation angles from rotation vectors, as exact for small angles
and near 180 degrees as ours (`test_both_know_a_given_angle`); versions with an arc cosine lost half of the digits.
"""

from dataclasses import asdict

import numpy as np
import pytest
from evo.core import metrics as evo
from evo.core.filters import FilterException
from evo.core.trajectory import PosePath3D
from scipy.spatial.transform import Rotation

from slamgym.errors import TrajectoryWarning
from slamgym.eval.accuracy import ALIGNMENTS, ErrorStats, PoseErrorStats, absolute_errors, align, ate, rpe
from slamgym.eval.trajectories import associate, read_tum

TRANS, ROT = evo.PoseRelation.translation_part, evo.PoseRelation.rotation_angle_deg
EVO_UNITS = {"frames": evo.Unit.frames, "metres": evo.Unit.meters}
CASES = range(200)


def evo_path(T):
    return PosePath3D(poses_se3=list(T))


def evo_aligned(ref_T, est_T, alignment):
    ref, est = evo_path(ref_T), evo_path(est_T)
    if alignment == "first_pose":
        est.align_origin(ref)
    elif alignment != "none":
        est.align(ref, correct_scale=alignment == "sim3")
    return ref, est


def evo_stats(metric, ref, est):
    metric.process_data((ref, est))
    statistics = metric.get_all_statistics()
    del statistics["sse"]
    return statistics


def evo_ate(ref, est):
    return [evo_stats(evo.APE(relation), ref, est) for relation in (TRANS, ROT)]


def evo_rpe(ref, est, delta, unit, pairs):
    """None where there is no pair: evo raises then."""
    options = (delta, EVO_UNITS[unit], 0.1, pairs == "all", True)
    try:
        return [evo_stats(evo.RPE(relation, *options), ref, est) for relation in (TRANS, ROT)]
    except FilterException:
        return None


def assert_same(stats: PoseErrorStats, expected):
    if expected is None:
        assert np.isnan(stats.trans_m.rmse)
        return
    for ours, evos in zip(stats, expected, strict=True):
        assert asdict(ours) == pytest.approx(evos, rel=0, abs=1e-9)


def random_case(case, random_pair):
    """One of the 200: length, noise, and kind of path go with the number."""
    rng = np.random.default_rng(case)
    noise = 10.0 ** rng.uniform(-6, 0)
    ref_T, est_T = random_pair(case, int(rng.integers(4, 61)), noise, planar=case % 2 == 1, pauses=case % 4 >= 2)
    est_T[:, :3, 3] *= rng.uniform(0.3, 3.0) if case % 5 == 0 else 1.0
    return ref_T, est_T


@pytest.mark.parametrize("case", CASES)
def test_ate(case, random_pair):
    ref_T, est_T = random_case(case, random_pair)
    for alignment in ALIGNMENTS:
        assert_same(ate(ref_T, est_T, alignment), evo_ate(*evo_aligned(ref_T, est_T, alignment)))


@pytest.mark.parametrize("case", CASES)
def test_rpe(case, random_pair):
    ref_T, est_T = random_case(case, random_pair)
    ref, est = evo_aligned(ref_T, est_T, "none")
    for delta, unit in ((1, "frames"), (2, "frames"), (3, "frames"), (2.5, "metres")):
        for pairs in ("all", "consecutive"):
            ours = rpe(ref_T, est_T, delta, unit, pairs=pairs)
            assert_same(ours, evo_rpe(ref, est, delta, unit, pairs))


@pytest.mark.parametrize("case", CASES)
def test_rpe_of_a_scaled_estimate(case, random_pair):
    ref_T, est_T = random_case(case, random_pair)
    scaled_T = align(ref_T, est_T, "sim3").apply(est_T)
    ref, est = evo_aligned(ref_T, est_T, "sim3")
    for delta, unit, pairs in ((1, "frames", "all"), (2.5, "metres", "consecutive")):
        assert_same(rpe(ref_T, scaled_T, delta, unit, pairs=pairs), evo_rpe(ref, est, delta, unit, pairs))


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-9, 1e-5, 0.5, 3.0, np.pi - 1e-5, np.pi - 1e-9, np.pi])
def test_both_know_a_given_angle(angle, random_pair):
    ref_T, _ = random_pair(1, 2)
    est_T = ref_T.copy()
    est_T[1, :3, :3] = est_T[1, :3, :3] @ Rotation.from_rotvec([0.0, angle, 0.0]).as_matrix()
    # Products of matrices round by some 1e-16 radians, 1e-14 degrees.
    exact = pytest.approx(np.degrees(angle), rel=1e-14, abs=1e-13)
    assert absolute_errors(ref_T, est_T)[1][1] == exact
    assert rpe(ref_T, est_T).rot_deg.max == exact
    ref, est = evo_aligned(ref_T, est_T, "none")
    assert evo_rpe(ref, est, 1, "frames", "all")[1]["max"] == exact


def associated(ref, est, max_difference_ns, convention):
    i, j = associate(ref, est, max_difference_ns, convention)
    return ref.T[i], est.T[j]


@pytest.fixture(scope="module")
def fr2_desk(shared_data):
    folder = shared_data / "trajectories"
    with pytest.warns(TrajectoryWarning):
        ref = read_tum(folder / "fr2_desk_groundtruth.txt", repair=True)
    return ref, read_tum(folder / "fr2_desk_ORB.txt")


@pytest.fixture(scope="module")
def rgbdslam(shared_data):
    folder = shared_data / "trajectories"
    return read_tum(folder / "freiburg1_xyz-groundtruth.txt"), read_tum(folder / "freiburg1_xyz-rgbdslam.txt")


@pytest.fixture(scope="module", params=["fr2_desk", "rgbdslam"])
def real_pair(request):
    return associated(*request.getfixturevalue(request.param), 10_000_000, "evo")


@pytest.mark.parametrize("alignment", ALIGNMENTS)
def test_ate_of_real_trajectories(alignment, real_pair):
    assert_same(ate(*real_pair, alignment), evo_ate(*evo_aligned(*real_pair, alignment)))


@pytest.mark.parametrize("pairs", ["all", "consecutive"])
@pytest.mark.parametrize(("delta", "unit"), [(1, "frames"), (30, "frames"), (0.05, "metres"), (1.0, "metres")])
def test_rpe_of_real_trajectories(delta, unit, pairs, real_pair):
    expected = evo_rpe(*evo_aligned(*real_pair, "none"), delta, unit, pairs)
    assert expected is not None
    assert_same(rpe(*real_pair, delta, unit, pairs=pairs), expected)


def test_published_ate_of_the_tum_tools(fr2_desk):
    ref_T, est_T = associated(*fr2_desk, 20_000_000, "tum")
    assert len(ref_T) == 2223
    published = ErrorStats(rmse=0.008144, mean=0.007514, median=0.007432, std=0.003140, min=0.000332, max=0.024329)
    assert asdict(ate(ref_T, est_T).trans_m) == pytest.approx(asdict(published), abs=6e-7)


def test_published_ate_of_evo(fr2_desk):
    ref_T, est_T = associated(*fr2_desk, 10_000_000, "evo")
    published = ErrorStats(rmse=0.008119, mean=0.007492, median=0.007415, std=0.003129, min=0.000350, max=0.024300)
    stats = ate(ref_T, est_T).trans_m
    assert asdict(stats) == pytest.approx(asdict(published), abs=6e-7)
    # One estimate lies exactly between two true poses; evo's float stamps round that tie to the later one.
    assert stats.rmse**2 * len(ref_T) == pytest.approx(0.143305, abs=2.5e-6)


def test_published_rpe(fr2_desk):
    stats = rpe(*associated(*fr2_desk, 10_000_000, "evo")).trans_m
    published = {"rmse": 0.003490, "mean": 0.003038, "median": 0.002750, "max": 0.019485}
    assert {key: asdict(stats)[key] for key in published} == pytest.approx(published, abs=6e-7)


def test_published_ate_of_rgbdslam(rgbdslam):
    assert ate(*associated(*rgbdslam, 10_000_000, "evo")).trans_m.rmse == pytest.approx(0.013470, abs=6e-7)
