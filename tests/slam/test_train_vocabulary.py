import lzma

import cv2
import numpy as np
import pytest

from slamgym.errors import ConfigError
from slamgym.slam.train_vocabulary import image_descriptors, image_files, read_image, write_packed
from slamgym.slam.vocabulary_tree import train


@pytest.fixture
def noise():
    return np.random.default_rng(0).integers(0, 256, (120, 160, 3), dtype=np.uint8)


def touched(folder, *names):
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).touch()
    return folder


def test_image_descriptors(noise):
    found = image_descriptors(noise, features=200)
    assert found.dtype == np.uint8
    assert found.shape[1] == 32
    assert 50 < len(found) <= 200


@pytest.mark.parametrize("shape", [(120, 160, 3), (1, 1, 3), (1, 500, 3), (62, 500, 3)])
def test_nothing_to_see(shape):
    assert image_descriptors(np.zeros(shape, np.uint8)).shape == (0, 32)


def test_files_of_a_sequence_without_its_depth(tmp_path):
    names = ["rgb/2.png", "rgb/1.PNG", "deep/er/3.jpg", "4.jpeg", "depth/1.png", "a/depth/b/2.png", "rgb.txt", "png"]
    found = image_files(touched(tmp_path / "depth", *names), limit=10)
    assert [str(path.relative_to(tmp_path / "depth")) for path in found] == [
        "4.jpeg", "deep/er/3.jpg", "rgb/1.PNG", "rgb/2.png",
    ]  # fmt: skip


def test_files_are_spread_evenly(tmp_path):
    touched(tmp_path, *(f"{number}.png" for number in range(10, 19)))
    assert [path.stem for path in image_files(tmp_path, limit=3)] == ["10", "14", "18"]
    assert len(image_files(tmp_path, limit=1)) == 1


def test_no_images(tmp_path):
    with pytest.raises(ConfigError, match="expected images"):
        image_files(touched(tmp_path, "depth/1.png", "text.txt"), limit=10)
    with pytest.raises(ConfigError, match="expected a folder of images"):
        image_files(tmp_path / "text.txt", limit=10)


def test_read_image(tmp_path, noise):
    cv2.imwrite(str(tmp_path / "color.png"), noise[..., ::-1])
    np.testing.assert_array_equal(read_image(tmp_path / "color.png"), noise)
    cv2.imwrite(str(tmp_path / "grey.png"), noise[..., 0])
    np.testing.assert_array_equal(read_image(tmp_path / "grey.png"), np.repeat(noise[..., :1], 3, axis=2))
    cv2.imwrite(str(tmp_path / "large.jpg"), np.zeros((100, 2560, 3), np.uint8))
    assert read_image(tmp_path / "large.jpg").shape == (50, 1280, 3)


def test_unreadable_images_are_none_and_silent(tmp_path, noise, capfd):
    whole = cv2.imencode(".png", noise)[1].tobytes()
    for content in (b"", b"no image", whole[:60], whole[:8] + b"?" * 100):
        (tmp_path / "bad.png").write_bytes(content)
        assert read_image(tmp_path / "bad.png") is None
    assert read_image(tmp_path / "missing.png") is None
    assert read_image(tmp_path) is None
    assert capfd.readouterr() == ("", "")


def test_packed(tmp_path, noise):
    vocabulary = train([image_descriptors(noise)], branching=3, depth=2)
    write_packed(vocabulary, tmp_path / "voc.txt.xz")
    assert lzma.decompress((tmp_path / "voc.txt.xz").read_bytes()).decode() == vocabulary.to_text()
