import json

import pytest
import trimesh

from slamgym.cli import main

FAST = ["--camera", "small", "--lighting", "flat", "--path-length-m", "3"]


def test_scene_writes_the_report_and_prints_its_figures(tmp_path, capsys):
    out = tmp_path / "house"
    main(
        [
            "scene",
            "procedural:2",
            "--scene-options",
            "size",
            "small",
            "--export",
            "glb",
            "suncg",
            "--out",
            str(out),
            *FAST,
        ]
    )
    printed = capsys.readouterr().out
    figures = json.loads((out / "scene.json").read_text())
    assert f"{figures['triangles']:,}" in printed
    assert str(out) in printed.replace("\n", "")
    assert len(trimesh.load(out / "house.glb").geometry) > 10
    (house_json,) = out.glob("suncg/house/*/house.json")
    again = tmp_path / "again"
    main(["scene", str(house_json), "--out", str(again), *FAST])
    assert json.loads((again / "scene.json").read_text())["triangles"] == figures["triangles"]
    assert "assumption: " in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["procedurl"], "did you mean 'procedural'"),
        (["nowhere.glb"], "which is not there"),
        (["procedural", "--scene-options", "size", "huge"], "did you mean"),
        (["procedural", "--scene-options", "sise", "small"], "did you mean 'size'"),
        (["procedural", "--scene-options", "size", "small", "--scene-options", "clutter", "1"], "expected it once"),
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
