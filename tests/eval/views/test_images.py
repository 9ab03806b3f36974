import cv2
import numpy as np
import pytest

from slamgym.eval.views import brightness, keypoint_count, sharpness

SIZE = (480, 640)


def image(values):
    return np.rint(np.clip(values, 0, 255)).astype(np.uint8)


@pytest.fixture(scope="module")
def texture():
    """Random grey patches of some 8 pixels, as of things seen from a few metres."""
    patches = np.random.default_rng(0).uniform(40, 220, (60, 80)).astype(np.float32)
    return image(cv2.resize(patches, SIZE[::-1], interpolation=cv2.INTER_NEAREST))


def test_dots_are_keypoints_when_they_differ_by_more_than_20_grey_levels():
    grey = np.full(SIZE, 100, np.uint8)
    grey[20:460:20, 20:620:20] = 121  # 22 rows of 30, too far apart to share a circle of radius 3
    assert keypoint_count(grey) == 660
    grey[grey == 121] = 120
    assert keypoint_count(grey) == 0


@pytest.mark.parametrize("omega", [0.1, 0.3, 0.5])
def test_sharpness_of_two_waves(omega):
    """Along each axis, in steps of 2 pixels, the second difference is 2 sin(omega) times the first, and the gradient
    has both axes: (2 sin(omega))^2 / 2. The smoothing lowers both alike.
    """
    rows, columns = np.mgrid[: SIZE[0], : SIZE[1]]
    grey = image(128 + 60 * np.sin(omega * rows) + 60 * np.sin(omega * columns))
    assert sharpness(grey) == pytest.approx(2 * np.sin(omega) ** 2, rel=0.06)


def test_sharpness_knows_no_brightness_no_contrast_and_no_offset(texture):
    assert sharpness(image(texture * 0.3)) == pytest.approx(sharpness(texture), rel=0.01)
    assert sharpness(image(texture * 0.5 + 100)) == pytest.approx(sharpness(texture), rel=0.01)


def test_a_bare_wall_over_most_of_the_view_is_not_blur(texture):
    bare = texture.copy()
    bare[:, :576] = 130  # nine tenths
    assert sharpness(bare) == pytest.approx(sharpness(texture), rel=0.1)
    variance = [np.var(cv2.Laplacian(grey, cv2.CV_64F)) for grey in (bare, texture)]
    assert variance[0] < 0.12 * variance[1]  # which is why sharpness is not the variance of the Laplacian


@pytest.mark.parametrize("blurred", [lambda g: cv2.GaussianBlur(g, (0, 0), 6), lambda g: cv2.blur(g, (41, 1))])
@pytest.mark.parametrize("noise", [0, 3])
def test_blur_lowers_it_along_any_axis_and_under_noise(texture, blurred, noise):
    grain = np.random.default_rng(1).normal(0, noise, SIZE)
    usual = sharpness(image(texture + grain))
    assert sharpness(image(blurred(texture) + grain)) < 0.3 * usual
    across = np.ascontiguousarray(blurred(texture.T).T)
    assert sharpness(image(across + grain)) < 0.3 * usual


@pytest.mark.parametrize("shape", [(480, 640), (1, 1), (5, 640)])
def test_sharpness_needs_something_to_see(shape):
    assert np.isnan(sharpness(np.full(shape, 90, np.uint8)))


def test_what_glare_leaves_over_is_not_blur(texture):
    glare = image(texture.astype(int) + 212)
    assert 0.001 < (glare < 255).mean() < 0.1
    assert np.isnan(sharpness(glare))


def test_brightness_is_the_mean():
    assert brightness(np.array([[0, 100], [50, 250]], np.uint8)) == 100.0
