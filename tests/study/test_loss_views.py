import numpy as np

from slamgym.study.loss_views import frames_around

SECOND = 1_000_000_000


def test_frames_to_show_for_a_loss():
    stamps_ns = np.arange(101) * SECOND // 10
    # Every other frame was fed: 4.8 s was tracked, 5.0 s was not.
    assert frames_around(stamps_ns, 48 * SECOND // 10, 5 * SECOND) == [40, 47, 48, 50, 53, 60]


def test_no_frame_from_outside_the_sequence_and_none_twice():
    stamps_ns = np.arange(8) * SECOND // 10
    # 0.3 s before the loss at 0.4 s is row 1, 1 s before it there is none, nor is there one at 1.4 s.
    assert frames_around(stamps_ns, 3 * SECOND // 10, 4 * SECOND // 10) == [1, 3, 4, 7]
    # A slow camera: 0.3 s before and after are nearest to frames that are shown already.
    assert frames_around(np.arange(5) * SECOND, SECOND, 2 * SECOND) == [1, 2, 3]
