import json
import re

import cv2
import numpy as np
import pytest

from slamgym.cli import main
from slamgym.slam.vocabulary import vocabulary_hash


@pytest.fixture
def images(tmp_path):
    """A folder of three noisy images, in the layout of a sequence."""
    rng = np.random.default_rng(0)
    (tmp_path / "sequence" / "rgb").mkdir(parents=True)
    for number in range(3):
        image = cv2.resize(rng.integers(0, 256, (60, 80, 3), dtype=np.uint8), (320, 240))
        cv2.imwrite(str(tmp_path / "sequence" / "rgb" / f"{number}.png"), image)
    return tmp_path / "sequence"


def test_trained_on_a_folder_described_and_the_same_again(images, tmp_path, capsys):
    out = tmp_path / "deep" / "voc.txt"
    options = ["--images", str(images), "--branching", "4", "--depth", "5", "--features", "300"]
    main(["vocab", "train", "--out", str(out), *options])
    printed = capsys.readouterr()
    assert str(out) in printed.out
    assert vocabulary_hash(out) in printed.out
    assert re.search(r"[\d,]+ words of 3 images, in \d+ s", printed.out)
    assert f"--slam-options vocabulary {out}" in printed.err.replace("\n", "")
    assert list(out.parent.iterdir()) == [out]
    main(["vocab", "info", str(out), "--json"])
    info = json.loads(capsys.readouterr().out)
    assert (info["branching"], info["depth"], info["bytes"]) == (4, 5, out.stat().st_size)
    assert info["nodes"] == len(out.read_text().splitlines()) - 1
    assert 100 < info["words"] < info["nodes"]
    assert info["sha256"].startswith(info["vocabulary_sha256"])
    (tmp_path / "empty.txt").touch()
    main(["vocab", "train", "--out", str(tmp_path / "empty.txt"), *options])
    assert (tmp_path / "empty.txt").read_text() == out.read_text()


def test_trained_on_a_house_and_used_by_orbslam(tmp_path, capsys):
    voc, run = tmp_path / "voc.txt", tmp_path / "run"
    main(["vocab", "train", "--out", str(voc), "--seeds", "0", "--images-per-house", "2"])
    assert "warning: results from houses that a vocabulary was trained on flatter" in capsys.readouterr().err
    drive = ["--camera", "small", "--path-length-m", "0.5", "--speed", "0.5", "--out", str(run)]
    main(["run", *drive, "--slam-options", "vocabulary", str(voc)])
    assert json.loads((run / "episode.json").read_text())["status"] == "ok"
    assert f"vocabulary_sha256: {vocabulary_hash(voc)}" in (run / "config.yaml").read_text()


def test_info_of_our_own(capsys):
    main(["vocab", "info"])
    printed = capsys.readouterr().out
    assert "words: 40,348" in printed
    assert f"vocabulary_sha256: {vocabulary_hash()}" in printed
    assert "scoring: L1" in printed


def test_unreadable_images_are_named_and_left_out(images, tmp_path, capsys):
    broken = [images / "rgb" / f"{number}.png" for number in range(3, 10)]
    for path in broken:
        path.write_bytes(b"broken")
    main(["vocab", "train", "--images", str(images), "--out", str(tmp_path / "voc.txt"), "--features", "50"])
    printed = capsys.readouterr()
    named = ", ".join(map(str, broken[:5]))
    assert f"warning: left out, since unreadable: {named} and 2 more" in printed.err
    assert "of 3 images" in printed.out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["train", "--images", "{}/sequence", "--out", "{}"], "new or empty file"),
        (["train", "--images", "{}/sequence", "--out", "{}/sequence/rgb/0.png"], "new or empty file"),
        (["train", "--images", "{}/sequence", "--out", "{}/sequence/rgb/0.png/voc.txt"], "cannot write in"),
        (["train", "--images", "{}/sequence", "--seeds", "1000000"], "one of --images and --seeds"),
        (["train", "--images", "{}/sequence", "--branching", "1"], "got 1 and 6"),
        (["train", "--images", "{}/sequence", "--max-images", "0"], "--max-images of at least 1, got 0; leave"),
        (["train", "--images", "{}/nowhere"], "expected a folder of images"),
        (["train", "--images", "{}/broken"], "images that can be read in"),
        (["train", "--images", "{}/black"], "expected at least 6 descriptors, got 0"),
        (["train", "--seeds", "3", "-1"], "expected --seeds of at least 0, got -1; leave"),
        (["info", "{}/broken/0.png"], "in the first line of"),
        (["info", "{}/nowhere"], "expected a file"),
    ],
)
def test_bad_input_is_one_line_and_leaves_nothing(images, tmp_path, capsys, arguments, message):
    black = cv2.imencode(".png", np.zeros((90, 90)))[1].tobytes()
    for name, content in {"broken": b"no image", "black": black}.items():
        (tmp_path / name).mkdir()
        (tmp_path / name / "0.png").write_bytes(content)
    before = sorted(tmp_path.rglob("*"))
    out = [] if "--out" in arguments or arguments[0] == "info" else ["--out", str(tmp_path / "voc.txt")]
    with pytest.raises(SystemExit) as stopped:
        main(["vocab", *(word.format(tmp_path) for word in arguments), *out])
    assert stopped.value.code == 2
    error = capsys.readouterr().err.strip()
    assert message in error
    assert len(error.splitlines()) == 1
    assert sorted(tmp_path.rglob("*")) == before
