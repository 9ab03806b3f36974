import threading
import time
from dataclasses import replace

import numpy as np
import pytest

from slamgym.errors import SequenceError
from slamgym.eval.datasets import read_ahead, read_sequence


@pytest.fixture
def sequence(tum_folder):
    stamps = tuple(1 + k / 10 for k in range(9))
    return read_sequence(tum_folder(stamps, stamps))


def reading_threads():
    return [thread for thread in threading.enumerate() if thread.name.startswith("read-ahead")]


@pytest.mark.parametrize("depth", [1, 4, 50])
def test_the_frames_come_in_the_order_they_were_asked_for(sequence, depth):
    wanted = [0, 2, 4, 8, 3]
    frames = list(read_ahead(sequence, iter(wanted), depth))
    assert [frame.rgb[0, 0, 0] for frame in frames] == wanted
    assert [frame.stamp_ns for frame in frames] == sequence.stamps_ns[wanted].tolist()
    assert not reading_threads()


def test_an_error_comes_in_its_place(sequence, tmp_path):
    (tmp_path / "mine" / "depth" / "1.3.png").unlink()
    frames = read_ahead(sequence, range(9))
    assert [next(frames).rgb[0, 0, 0] for _ in range(3)] == [0, 1, 2]
    with pytest.raises(SequenceError, match=r"depth/1\.3\.png"):
        next(frames)
    assert not reading_threads()


def test_no_more_than_the_depth_is_read_ahead_and_closing_ends_it(sequence):
    read = []

    def read_images(k):
        read.append(k)
        return sequence.read_images(k)

    frames = read_ahead(replace(sequence, read_images=read_images), range(9), depth=3)
    assert read == []
    next(frames)
    while len(read) < 4:
        time.sleep(0.001)
    time.sleep(0.05)
    assert read == [0, 1, 2, 3]
    assert len(reading_threads()) == 1
    frames.close()
    assert not reading_threads()
    assert read == [0, 1, 2, 3]


def test_images_are_the_same_as_without(sequence):
    for ahead, plain in zip(read_ahead(sequence, range(9)), sequence.frames(), strict=True):
        np.testing.assert_array_equal(ahead.rgb, plain.rgb)
        np.testing.assert_array_equal(ahead.depth, plain.depth)
