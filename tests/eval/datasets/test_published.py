import pytest

from slamgym.eval.datasets import published


@pytest.mark.parametrize(
    ("name", "sequence", "ate_rmse_m"),
    [
        ("rgbd_dataset_freiburg1_xyz", "fr1/xyz", 0.010),
        ("fr1_xyz", "fr1/xyz", 0.010),
        ("tum_fr1_xyz_100", "fr1/xyz", 0.010),
        ("rgbd_dataset_freiburg1_desk", "fr1/desk", 0.016),
        ("rgbd_dataset_freiburg1_desk2", "fr1/desk2", 0.022),
        ("Freiburg1_Room", "fr1/room", 0.047),
        ("freiburg2_desk", "fr2/desk", 0.009),
        ("fr2/xyz", "fr2/xyz", 0.004),
        ("rgbd_dataset_freiburg3_long_office_household", "fr3/office", 0.010),
        ("tum_fr3_office_500", "fr3/office", 0.010),
        ("rgbd_dataset_freiburg3_nostructure_texture_near_withloop", "fr3/nst", 0.019),
    ],
)
def test_the_figure_of_a_sequence_is_found_by_its_folder(name, sequence, ate_rmse_m):
    row = published(name)
    assert (row.sequence, row.system, row.sensor, row.ate_rmse_m) == (sequence, "ORB-SLAM2", "RGB-D", ate_rmse_m)
    assert ("Table III" in row.source) == (sequence != "fr1/xyz")


@pytest.mark.parametrize(
    "name",
    [
        "xyz",
        "freiburg1",
        "rgbd_dataset_freiburg3_xyz",
        "rgbd_dataset_freiburg2_desk_with_person",
        "rgbd_dataset_freiburg3_long_office_household_validation",
        "fr1_desk3",
        "fr1_desk_2",
        "afr1_desk",
        "",
    ],
)
def test_other_sequences_have_none(name):
    assert published(name) is None
