import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import norm

from slamgym.sensors import icl_nuim_depth_noise, rgb_noise
from slamgym.types import FloatArray


def wall(depth_m: float, shape: tuple[int, int] = (120, 160)) -> NDArray[np.float32]:
    return np.full(shape, depth_m, np.float32)


def slanted_wall(depth_m: float) -> NDArray[np.float32]:
    """A wall whose disparity changes by some levels, so that rounding errors are spread evenly."""
    return wall(depth_m) * np.linspace(0.97, 1.03, 160, dtype=np.float32)


@pytest.mark.parametrize("depth_m", [1.0, 2.0, 3.0, 4.0])
def test_depth_noise_has_no_bias_and_the_models_deviation(depth_m: float) -> None:
    truth = slanted_wall(depth_m)
    disparity_error = 351.3 / icl_nuim_depth_noise(truth, np.random.default_rng(0)) - 351.3 / truth
    level = 351.3 / depth_m * 0.06 / 160  # what a shift by one pixel changes
    expected = np.sqrt(1 / 36 + 1 / 12 + (0.5 * level) ** 2)  # noise, rounding, shift
    assert abs(disparity_error.mean()) < 4 * expected / np.sqrt(truth.size)
    assert disparity_error.std() == pytest.approx(expected, rel=0.05)


@pytest.mark.parametrize("depth_m", [1.0, 2.0, 3.0, 4.0])
def test_depth_noise_in_metres_grows_with_the_square_of_depth(depth_m: float) -> None:
    truth = slanted_wall(depth_m)
    error = icl_nuim_depth_noise(truth, np.random.default_rng(1)) - truth
    assert abs(error.mean()) < 2e-4 * depth_m**2
    assert error.std() == pytest.approx(np.sqrt(1 / 36 + 1 / 12) * depth_m**2 / 351.3, rel=0.1)


def on_a_flat_wall(depth_m: float) -> tuple[FloatArray, FloatArray]:
    """Depths, metres, that the model can measure of a flat wall, and how probable each is.

    Reading beside the pixel changes nothing there: disparity 351.3 / z plus N(0, 1/6), rounded to whole numbers.
    """
    levels = np.arange(1.0, 1000.0)
    below, above = (norm.cdf((levels + side - 351.3 / depth_m) * 6.0) for side in (-0.5, 0.5))
    return 351.3 / levels, above - below


@pytest.mark.parametrize("depth_m", [1.0, 2.0, 3.0, 4.0])
def test_depth_noise_on_a_flat_wall_is_the_formulas(depth_m: float) -> None:
    measured = icl_nuim_depth_noise(wall(depth_m, (480, 640)), np.random.default_rng(7)).astype(np.float64)
    values, probability = on_a_flat_wall(depth_m)
    mean = values @ probability
    deviation = np.sqrt((values - mean) ** 2 @ probability)
    assert measured.mean() - depth_m == pytest.approx(mean - depth_m, abs=4 * deviation / np.sqrt(measured.size))
    assert measured.std() == pytest.approx(deviation, rel=0.02)
    steps = np.diff(np.unique(measured))
    assert steps == pytest.approx(np.full(steps.shape, depth_m**2 / 351.3), rel=0.02)  # 351.3 / d changes by that


def test_depth_noise_reads_beside_the_pixel() -> None:
    step = np.where(np.arange(160) < 80, 1.0, 2.0).astype(np.float32) * wall(1.0)
    changed = np.abs(icl_nuim_depth_noise(step, np.random.default_rng(2)) - step) > 0.1
    assert changed[:, 79:81].mean() > 0.3  # the shift has to reach past the step: P(N > 0.2 to 0.5)
    assert not changed[:, :75].any()
    assert not changed[:, 85:].any()


@pytest.mark.parametrize("axis", [0, 1])
def test_depth_noise_shifts_by_half_a_pixel_along_both_axes(axis: int) -> None:
    disparity = 400.0 + 4.0 * np.indices((150, 150))[axis]  # four levels a pixel, so that shifts outweigh the rest
    depth = (351.3 / disparity).astype(np.float32)
    measured = 351.3 / icl_nuim_depth_noise(depth, np.random.default_rng(8))
    error = (measured - disparity)[5:-5, 5:-5]
    assert error.std() == pytest.approx(np.sqrt(1 / 36 + 1 / 12 + (0.5 * 4.0) ** 2), rel=0.03)
    assert abs(error.mean()) < 0.06


def test_depth_noise_leaves_holes_and_does_not_mix_them_in() -> None:
    depth = wall(2.0)
    depth[40:60, 50:90] = 0.0
    depth[100, 100] = 0.0
    noisy = icl_nuim_depth_noise(depth, np.random.default_rng(3))
    assert noisy.dtype == np.float32
    assert (noisy[depth == 0.0] == 0.0).all()
    measured = noisy[(depth > 0.0) & (noisy > 0.0)]
    assert np.abs(measured - 2.0).max() < 0.05
    beside_hole = noisy[38:40, 50:90]
    assert (beside_hole == 0.0).mean() < 0.3
    assert (icl_nuim_depth_noise(wall(0.0), np.random.default_rng(3)) == 0.0).all()


def test_depth_beyond_the_last_disparity_is_no_measurement() -> None:
    noisy = icl_nuim_depth_noise(wall(1e5), np.random.default_rng(4))
    assert (noisy == 0.0).mean() > 0.99  # a disparity of 0 and noise of three deviations still reads as 1
    assert np.isfinite(noisy).all()


def test_depth_noise_depends_on_the_generator_alone_and_leaves_its_input() -> None:
    depth = slanted_wall(2.0)
    before = depth.copy()
    first, again = (icl_nuim_depth_noise(depth, np.random.default_rng(5)) for _ in range(2))
    assert (first == again).all()
    assert (first != icl_nuim_depth_noise(depth, np.random.default_rng(6))).any()
    assert (depth == before).all()


@pytest.mark.parametrize("sigma", [1.0, 5.0, 20.0])
def test_rgb_noise_has_the_deviation_asked_for(sigma: float) -> None:
    grey = np.full((120, 160, 3), 128, np.uint8)
    noise = rgb_noise(grey, sigma, np.random.default_rng(0)).astype(float) - 128.0
    assert noise.std() == pytest.approx(np.sqrt(sigma**2 + 1 / 12), rel=0.02)
    assert abs(noise.mean()) < 4 * sigma / np.sqrt(noise.size)
    assert abs(np.corrcoef(noise[..., 0].ravel(), noise[..., 1].ravel())[0, 1]) < 0.03


def test_rgb_noise_saturates_and_zero_changes_nothing() -> None:
    image = np.random.default_rng(0).integers(0, 256, (60, 80, 3), dtype=np.uint8)
    assert (rgb_noise(image, 0.0, np.random.default_rng(1)) == image).all()
    black = rgb_noise(np.zeros((60, 80, 3), np.uint8), 10.0, np.random.default_rng(1))
    assert black.dtype == np.uint8
    assert black.max() < 60
