import re
import subprocess
import sys

import pytest

from slamgym.study.canonical import canonical, name_for_folder, slug_of


def test_the_order_of_keys_and_how_numbers_are_written_do_not_matter():
    assert canonical({"a": 1, "b": [1.0, 2.5]}) == canonical({"b": (1, 2.5), "a": 1.0}) == '{"a":1,"b":[1,2.5]}'


def test_what_differs_is_told_apart():
    values = [1, True, "1", None, "null", [1], {"1": 1}, 1.5, "", [], {}]
    assert len({canonical(value) for value in values}) == len(values)


def test_names_are_the_same_in_every_process():
    program = "from slamgym.study.canonical import name_for_folder; print(name_for_folder('a', {'b': 1, 'c': [None]}))"
    printed = {
        subprocess.run(
            [sys.executable, "-c", program], env={"PYTHONHASHSEED": seed}, capture_output=True, text=True
        ).stdout
        for seed in ("1", "2")
    }
    # sha256('{"b":1,"c":[null]}'), first 8 digits, by coreutils' sha256sum
    assert printed == {"a_9d3a91e7\n"}
    assert name_for_folder("a", {"c": (None,), "b": 1.0}) == "a_9d3a91e7"


@pytest.mark.parametrize(
    ("first", "levels", "slug"),
    [
        ("procedural:1 #7", {"speed": 0.4}, "procedural-1-7_speed-0.4"),
        ("orbslam3", {"stride": 0, "loop_closure": True}, "orbslam3_stride-0_loop_closure-on"),
        ("x", {"loop_closure": False, "turn_rate": None}, "x_loop_closure-off_turn_rate-None"),
        ("x", {"scene_options.texture": 2.0}, "x_texture-2"),
        ("x", {"slam_options.vocabulary": "/data/my voc.txt"}, "x_vocabulary-my-voc.txt"),
        ("<script>alert(1)</script>", {}, "script-alert-1-script"),
        ("../../etc", {}, "etc"),
        ("...", {}, "x"),
        ("", {}, "x"),
        ("房子", {}, "x"),
        ("a" * 100, {"speed": 1}, "a" * 40),
        ("-rf", {}, "rf"),
    ],
)
def test_slugs_are_short_and_fit_for_folders(first, levels, slug):
    assert slug_of(first, levels) == slug
    assert re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9._-]{0,39}", slug)
