import json
import re
from pkgutil import resolve_name

import pytest
import trimesh

from slamgym.cli import main
from slamgym.cli.options import option_group
from slamgym.errors import ConfigError
from slamgym.params import DriveParams
from slamgym.scene_report import inspect_scene
from slamgym.scenes.registry import SCENES

FAST = ["--camera", "small", "--lighting", "flat", "--path-length-m", "3"]


OBJ = """mtllib gone.mtl
o floor
v 0 0 0
v 6 0 0
v 6 0 -4
v 0 0 -4
f 1 2 3 4
"""


def words(text):
    return " ".join(text.split())


def scene(*arguments, out):
    main(["scene", *arguments, "--out", str(out), *FAST])
    return json.loads((out / "scene.json").read_text())


def test_scene_writes_the_report_and_prints_its_figures(tmp_path, capsys):
    out = tmp_path / "house"
    small = ("procedural:2", "--scene-options", "size", "small")
    figures = scene(*small, "--seed", "5", "--export", "glb", "suncg", "glb", out=out)
    printed = words(capsys.readouterr().out)
    assert f"rooms {len(figures['rooms'])}, {figures['rooms_m2']:.1f} m²" in printed
    assert f"unobstructed floor {figures['unobstructed_m2']:.1f} m²" in printed
    assert f"free for the robot {figures['free_m2']:.1f} m²" in printed
    assert figures["free_m2"] < figures["unobstructed_m2"] < figures["rooms_m2"]
    assert f"triangles {figures['triangles']:,}" in printed
    assert "nothing behind" not in printed
    assert str(out) in printed
    params = DriveParams(
        scene="procedural:2", scene_options={"size": "small"}, camera="small", lighting="flat", path_length_m=3
    )
    assert figures == inspect_scene(params, seed=5).figures != inspect_scene(params, seed=0).figures
    assert len(trimesh.load(out / "house.glb").geometry) > 10
    (house_json,) = out.glob("suncg/house/*/house.json")
    assert scene(str(house_json), out=tmp_path / "again")["triangles"] == figures["triangles"]
    assert "assumption: " in capsys.readouterr().out


def test_a_damaged_file_is_told_of_and_so_is_what_is_black(tmp_path, capsys):
    file = tmp_path / "flat.obj"
    file.write_text(OBJ)
    figures = scene(str(file), out=tmp_path / "out")
    told = capsys.readouterr()
    assert re.search(r"^defect: flat\.obj: 'gone\.mtl' left out", told.out, re.MULTILINE)
    assert re.search(r"^slamgym: warning: flat\.obj: 'gone\.mtl' left out", told.err, re.MULTILINE)
    assert "rooms not known" in words(told.out)
    share = 100 * figures["open_share"]
    assert 60 < share < 100
    assert f"nothing behind {share:.0f} % of the pixels: they are black" in words(told.out)


def test_a_taken_folder_is_told_of_before_the_work(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("slamgym.cli.scene.inspect_scene", lambda *_: pytest.fail("worked for nothing"))
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(SystemExit):
        main(["scene", "procedural", "--out", str(tmp_path)])
    assert "new or empty folder" in capsys.readouterr().err


def test_help_names_what_can_be_given(capsys):
    with pytest.raises(SystemExit):
        main(["scene", "--help"])
    told = words(capsys.readouterr().out.replace("│", " "))
    assert "--camera default|small|tum_fr1|tum_fr2|tum_fr3" in told
    assert "PinholeCamera" not in told
    assert "house.json" in told
    assert "(default: )" not in told
    assert "the drive through it" not in told
    names = {name for target in SCENES.values() for name in resolve_name(target).Options.model_fields}
    (options,) = re.findall(r"--scene-options NAME VALUE (.*?) \(default", told)
    assert len(names) > 5
    assert names <= set(re.findall(r"\w+", options))


def test_options_of_misspelt_parameters_are_refused():
    with pytest.raises(ConfigError, match="unknown parameter 'brigthness'; did you mean 'brightness'"):
        option_group(DriveParams, ["camera", "brigthness"])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["procedurl"], "did you mean 'procedural'"),
        (["nowhere.glb"], "which is not there"),
        (["procedural", "--scene-options", "size", "huge"], "did you mean"),
        (["procedural", "--scene-options", "sise", "small"], "did you mean 'size'"),
        (["procedural", "--scene-options", "size", "small", "--scene-options", "clutter", "1"], "expected it once"),
        (["procedural", "--scene-options", "size", "small", "size", "large"], "each name once, got size twice"),
        (["procedural", "--export", "gbl"], "did you mean 'glb'"),
        (["procedural", "--brightness", "0"], "brightness"),
        (["procedural", "--occupancy-map", "nowhere.yaml"], "which is not there"),
        (["procedural", "--seed", "-1"], "seed of at least 0"),
    ],
)
def test_bad_input_is_one_clear_line(arguments, message, tmp_path, capsys):
    with pytest.raises(SystemExit) as exit_info:
        main(["scene", *arguments, "--out", str(tmp_path / "out")])
    assert exit_info.value.code == 2
    said = capsys.readouterr().err
    assert message in said
    assert len(said.strip().splitlines()) == 1
    assert not (tmp_path / "out").exists()
