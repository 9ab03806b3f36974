"""Broken lists and camera files: each is read or refused in one line, whatever happened to it."""

import warnings
from collections import Counter

import numpy as np
import pytest

from slamgym.errors import SequenceError, TrajectoryWarning
from slamgym.eval.datasets import read_sequence

WORDS = (
    *("nan", "-inf", "1e999", "1e999999999", "9" * 5000, "-1", "1_000", "0x10", "1403636579763555584", "\u0661"),
    *("../../rgb/1.0.png", "/dev/zero", "rgb", ".", "..", "rgb/\0.png", "x" * 5000, "é", "[" * 3000, "*a", "&a [*a]"),
    *("!!binary x", "2001-99-99", "{a: b}", "~", "true", "0o7", "'", '"', ":", "- ", "<<: {a: 1}", "? a"),
)


def flip_a_bit(rng, data):
    k = rng.integers(len(data))
    return data[:k] + bytes([data[k] ^ (1 << rng.integers(8))]) + data[k + 1 :]


def cut_out(rng, data):
    k = rng.integers(len(data))
    return data[:k] + data[k + rng.integers(1, 40) :]


def replace_a_word(rng, data):
    words = data.split(b" ")
    words[rng.integers(len(words))] = WORDS[rng.integers(len(WORDS))].encode()
    return b" ".join(words)


def shuffle_lines(rng, data):
    lines = data.splitlines(keepends=True)
    return b"".join(lines[k] for k in rng.integers(len(lines), size=len(lines)))


def encode_otherwise(rng, data):
    return data.decode(errors="replace").encode(["utf-16", "utf-8-sig", "cp500"][rng.integers(3)], errors="replace")


MUTATIONS = (flip_a_bit, cut_out, replace_a_word, replace_a_word, shuffle_lines, encode_otherwise)


def outcome(folder):
    message = ""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", TrajectoryWarning)
        try:
            sequence = read_sequence(folder)
            frames = list(sequence.frames())
        except SequenceError as error:
            message = str(error)
    if message:
        assert len(message.splitlines()) == 1
        assert len(message) < 1500
        return "refused"
    assert len(frames) == len(sequence) > 0
    assert np.isfinite(sequence.T_world_cam).all() or sequence.truth is None
    return "read"


def fuzz(folder, count, seed):
    rng = np.random.default_rng(seed)
    names = ("rgb.txt", "depth.txt", "groundtruth.txt", "camera.yaml", "associations.txt")
    pairs = "".join(f"{t} rgb/{t}.png {t} depth/{t}.png\n" for t in ("1.0", "1.1", "1.2"))
    originals = {name: (folder / name).read_bytes() for name in names[:-1]} | {"associations.txt": pairs.encode()}
    told = Counter()
    for k in range(count):
        name = names[k % len(names)]
        mutate = MUTATIONS[rng.integers(len(MUTATIONS))]
        (folder / name).write_bytes(mutate(rng, originals[name]))
        told[name, outcome(folder)] += 1
        (folder / name).write_bytes(originals[name])
        (folder / "associations.txt").unlink(missing_ok=True)
    return told


def test_150_broken_files(tum_folder):
    told = fuzz(tum_folder(true_s=(1.0, 1.1, 1.2)), 150, seed=1)
    # As it should be with mutations like these: some harmless, some beyond repair.
    assert all(told[name, result] for name, _ in told for result in ("read", "refused")), told


@pytest.mark.slow
def test_5_000_broken_files(tum_folder):
    assert sum(fuzz(tum_folder(true_s=(1.0, 1.1, 1.2)), 5_000, seed=2).values()) == 5_000
