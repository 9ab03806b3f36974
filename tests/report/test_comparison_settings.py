from slamgym.report.comparison import compare_studies
from tests.report.made_up import runs, study
from tests.report.made_up_pairs import compared, repeated


def test_what_differs_is_told_first():
    old = runs(seed=2).assign(
        **{"slam": "orbslam2", "loop_closure": None, "run.versions.pyorbslam3": "0.1.0", "scene": "procedural:1"}
    )
    new = runs(seed=1).assign(loop_closure=False, scene="procedural:2", path_length_m=8.0)
    comparison = compare_studies(study(new, ("speed",)), study(old, ("speed",), folder="old"))
    assert [str(change) for change in comparison.settings] == [
        "slam: orbslam2 -> orbslam3",
        "loop_closure: default -> off",
        "path_length_m: not told -> 8",
        "versions.pyorbslam3: 0.1.0 -> 0.1.1",
    ]
    assert next(iter(comparison.content.facts.items())) == ("Changed: slam", "orbslam2 → orbslam3")
    assert any(
        "the drives are not the same in both (path_length_m)" in text.lower() for text in comparison.content.headlines
    )


def test_another_house_tour_or_agent_is_another_drive():
    house = "run.versions.house_sha256"
    old = repeated([(f"p{k}", 1, 0) for k in range(8)], **{"run.agent": "lap:Lap", "run.reset_options.tour": "lap"})
    old[house] = old["path"].map({f"p{k}": f"{k}aaa" for k in range(8)})
    assert compared(old, old).settings == ()
    # One house beyond those that are shown, then two that changed places.
    for changes in ({"p7": "7bbb"}, {"p6": "7aaa", "p7": "6aaa"}):
        new = old.assign(**{house: old["path"].map(changes).fillna(old[house])})
        (change,) = compared(new, old).settings
        assert (change.name, change.of_drive) == ("versions.house_sha256", True)
        for path, value in changes.items():
            assert f"{value} ({path})" in change.new
        assert change.new != change.baseline
        told = " ".join(compared(new, old).content.headlines)
        assert "The drives are not the same in both (versions.house_sha256)" in told
    new = old.assign(**{"run.agent": "patrol:Patrol", "run.reset_options.tour": "round_trip"})
    comparison = compared(new, old)
    assert [str(change) for change in comparison.settings] == [
        "agent: lap:Lap -> patrol:Patrol",
        "reset_options.tour: lap -> round_trip",
    ]
    assert "The drives are not the same in both (agent, reset_options.tour)" in " ".join(comparison.content.headlines)


def test_of_many_values_the_differing_ones_are_shown_first():
    old = repeated([("a", level, 0) for level in range(8)], 1).assign(**{"slam_options.features": range(8)})
    (change,) = compared(old.assign(**{"slam_options.features": [*range(7), 9]}), old, ("speed",)).settings
    assert str(change) == "slam_options.features: 7, 0, 1, 2, 3 and 3 more -> 9, 0, 1, 2, 3 and 3 more"


def test_another_computer_is_told():
    old = repeated([("a", 1, 0)], **{"timing.computer": "AMD EPYC, 2 cores"})
    new = old.assign(**{"timing.computer": "AMD EPYC, 8 cores"})
    assert [str(change) for change in compared(new, old).settings] == [
        "computer: AMD EPYC, 2 cores -> AMD EPYC, 8 cores"
    ]
