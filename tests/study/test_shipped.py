import pytest

from slamgym.errors import ConfigError
from slamgym.report.shares import FEWEST_PATHS
from slamgym.study.estimate import estimate
from slamgym.study.plan import plan_study
from slamgym.study.shipped import find_study, shipped_studies
from slamgym.study.spec import factor_names, read_study

STUDIES = ("computer", "light", "mva2019", "overlap", "quick", "speed")


def plans(name):
    """The runs in each size of a study."""
    sizes = ["small", "full"] if name != "quick" else [None]
    return [plan_study(read_study(name, size)) for size in sizes]


def test_they_are_found_by_name(tmp_path, monkeypatch):
    assert tuple(shipped_studies()) == STUDIES
    monkeypatch.chdir(tmp_path)
    (tmp_path / "quick").mkdir()  # as a folder of results may be called
    assert find_study("quick") == shipped_studies()["quick"]
    (tmp_path / "mine.yaml").write_text("name: mine\n")
    assert find_study("mine.yaml").read_text() == "name: mine\n"


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("quik", r"unknown study 'quik'; did you mean 'quick'\? Valid: computer, .*or give the yaml file of your own"),
        ("quick.yaml", r"quick\.yaml: expected the yaml file of a study, got none there"),
        ("a/b", "a/b: expected the yaml file of a study, got none there"),
        (".", "expected the yaml file of a study, got a folder"),
    ],
)
def test_what_is_none_of_them_is_told(tmp_path, monkeypatch, name, told):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ConfigError, match=told):
        find_study(name)


@pytest.mark.parametrize("name", STUDIES)
def test_each_can_be_planned_in_every_size(name):
    sizes = plans(name)
    assert [len(runs) for runs in sizes] == sorted(len(runs) for runs in sizes)
    for runs in sizes:
        # They return to their start; where loop closing is what matters, they see it again from the same side.
        assert {run.drive.agent for run in runs} == {"lap" if name == "mva2019" else "patrol"}
        assert {run.slam["slam"] for run in runs} == {"orbslam3"}
        # Seeds from 1,000,000 on are those that the vocabulary was trained on.
        assert all(int(run.drive.params["scene"].rpartition(":")[2]) < 1_000_000 for run in runs)


@pytest.mark.parametrize("name", STUDIES)
def test_each_has_enough_paths_for_its_report_to_tell_something(name):
    assert all(len({run.drive.path for run in runs}) >= FEWEST_PATHS for runs in plans(name))


@pytest.mark.parametrize("name", STUDIES)
def test_its_description_is_a_sentence_for_people(name):
    spec = read_study(name)
    assert spec.name == name
    assert 20 < len(spec.description) < 200
    assert "\n" not in spec.description


def test_the_quick_one_is_quick():
    assert estimate(plans("quick")[0]).seconds(2) < 5 * 60


def test_the_papers_experiment_is_whole():
    small, full = plans("mva2019")
    spec = read_study("mva2019")
    assert factor_names(spec) == ("stride", "loop_closure")
    assert {(run.levels["stride"], run.levels["loop_closure"]) for run in small} == {
        (stride, on) for stride in range(4) for on in (True, False)
    }
    assert (estimate(small).drives, len(small)) == (12, 12 * 8 * 3)
    assert (estimate(full).drives, len(full)) == (60, 60 * 8 * 10)


def test_the_papers_experiment_takes_recorded_sequences(sequences):
    runs = plan_study(read_study("mva2019", sequences=sequences))
    assert len(runs) == (12 + 3) * 8 * 3
    assert {run.drive.dataset for run in runs} == {"procedural", "straight"}


def test_what_the_computer_does_is_measured_one_run_at_a_time():
    assert read_study("computer").max_workers == 1
    small, full = plans("computer")
    assert {run.busy_processes for run in small} == {0, 4}
    assert {run.busy_processes for run in full} == {0, 1, 2, 4, 8}


def test_small_studies_need_no_furniture_of_others():
    for name in STUDIES:
        assert all(run.drive.params["scene"].startswith("procedural:") for run in plan_study(read_study(name)))
