"""Broken files: each is read as a valid trajectory or refused in one line, whatever happened to it."""

import warnings
from collections import Counter

import numpy as np
import pytest

from slamgym.errors import TrajectoryError, TrajectoryWarning
from slamgym.eval.trajectories import FORMATS, Trajectory, read_stamps, read_trajectory
from slamgym.geometry import quaternion_xyzw

NUMBERS = (
    *("nan", "-nan", "inf", "-Infinity", "1e999", "-1e999", "-0", "0", "1e300", "-1e-320", "1.5e+", ".", "-", "+1"),
    *("1e999999999", "1e-999999999", "1e99999999999999999999", "9" * 400, "0." + "3" * 5000, "snan", "1_000"),
    *("1403636579763555584.000000", "9223372036854775808", "-9223372036854775809", "4600000000", "True", "'", "{}"),
    *("\u0661", "\uff11", "0x10", "1,5"),
)
INSERTED = (
    *(b"\0", b"#", b",", b" ", b"\t", b"\n", b"\r", b"\v", b"\x1c", b"\x85", b"\xff"),
    *("é".encode(), "\u2028".encode()),
)
WHITE_SPACE = ((b"\n", b"\r\n"), (b"\n", b"\r"), (b" ", b"\t"), (b" ", b"  "), (b",", b", "), (b" ", b","))
ENCODINGS = ("utf-8-sig", "utf-16", "utf-16-le", "utf-32", "utf-7", "cp500", "latin-1")


def tum(trajectory):
    values = np.hstack([trajectory.positions, quaternion_xyzw(trajectory.T)])
    stamps = [f"{ns // 10**9}.{ns % 10**9:09d}" for ns in trajectory.stamps_ns.tolist()]
    return "# head\n" + lines(stamps, values, " ")


def euroc(trajectory):
    values = np.hstack([trajectory.positions, np.roll(quaternion_xyzw(trajectory.T), 1, axis=1), trajectory.positions])
    return "#timestamp [ns],x,y,z,qw,qx,qy,qz,vx,vy,vz\n" + lines(trajectory.stamps_ns.tolist(), values, ",")


def kitti(trajectory):
    return "".join(" ".join(map(repr, row)) + "\n" for row in trajectory.T[:, :3].reshape(-1, 12).tolist())


def lines(stamps, values, separator):
    rows = zip(stamps, values.tolist(), strict=True)
    return "".join(separator.join([str(stamp), *map(repr, row)]) + "\n" for stamp, row in rows)


def flip_a_byte(rng, data):
    k = rng.integers(len(data))
    return data[:k] + bytes([data[k] ^ (1 << rng.integers(8))]) + data[k + 1 :]


def insert_a_byte(rng, data):
    k = rng.integers(len(data) + 1)
    return data[:k] + INSERTED[rng.integers(len(INSERTED))] + data[k:]


def delete_bytes(rng, data):
    k = rng.integers(len(data))
    return data[:k] + data[k + rng.integers(1, 6) :]


def cut_off(rng, data):
    return data[: rng.integers(len(data))]


def change_lines(rng, data):
    """A line is dropped, doubled, or swapped with another."""
    rows = data.splitlines(keepends=True) or [b""]
    i, j = rng.integers(len(rows), size=2)
    how = rng.integers(3)
    if how == 2:
        rows[i], rows[j] = rows[j], rows[i]
        return b"".join(rows)
    return b"".join(rows[:i] + [rows[i]] * (2 * how) + rows[i + 1 :])


def replace_a_number(rng, data):
    rows = data.split(b"\n")
    i = rng.integers(len(rows))
    separator = b"," if b"," in rows[i] else b" "
    words = rows[i].split(separator)
    words[rng.integers(len(words))] = NUMBERS[rng.integers(len(NUMBERS))].encode()
    rows[i] = separator.join(words)
    return b"\n".join(rows)


def encode_otherwise(rng, data):
    return data.decode(errors="replace").encode(ENCODINGS[rng.integers(len(ENCODINGS))], errors="replace")


def change_the_white_space(rng, data):
    old, new = WHITE_SPACE[rng.integers(len(WHITE_SPACE))]
    return data.replace(old, new)


MUTATIONS = (
    *(flip_a_byte, insert_a_byte, delete_bytes, cut_off, change_lines, change_lines),
    *(replace_a_number, replace_a_number, encode_otherwise, change_the_white_space),
)


def mutate(rng, data):
    """Mostly one mutation, so that much of the file stays valid; sometimes up to three."""
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        data = MUTATIONS[rng.integers(len(MUTATIONS))](rng, data) if data else data
    return data


def outcome(read):
    """The trajectory and the number of warnings, or None when it was refused as it should be."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("error")
        warnings.simplefilter("always", TrajectoryWarning)
        try:
            return read(), len(told)
        except TrajectoryError as error:
            message = str(error)
    assert 0 < len(message) < 1000
    assert len(message.splitlines()) == 1
    return None


def check(path, times, format_):
    """Read strictly and with repair; True when the strict one gave a trajectory."""
    strict, repaired = (
        outcome(lambda repair=repair: read_trajectory(path, format_, times=times, repair=repair, allow_empty=True))
        for repair in (False, True)
    )
    for result in filter(None, (strict, repaired)):
        assert isinstance(result[0], Trajectory)
        assert np.isfinite(result[0].T).all()
    if strict:
        # What is accepted as it is needs no repair, and repairing changes nothing.
        assert strict[1] == repaired[1] == 0
        np.testing.assert_array_equal(strict[0].stamps_ns, repaired[0].stamps_ns)
        np.testing.assert_array_equal(strict[0].T, repaired[0].T)
    return "read" if strict else "repaired" if repaired else "refused"


def fuzz(folder, trajectory, count, seed):
    """What became of the files, read in their own format."""
    rng = np.random.default_rng(seed)
    times = "".join(f"{ns / 1e9!r}\n" for ns in (trajectory.stamps_ns - trajectory.stamps_ns[0]).tolist()).encode()
    originals = [(write.__name__, write(trajectory).encode()) for write in (tum, euroc, kitti)]
    path, times_path = folder / "t.txt", folder / "times.txt"
    told = Counter()
    for k in range(count):
        name, data = originals[k % len(originals)]
        path.write_bytes(mutate(rng, data))
        times_path.write_bytes(mutate(rng, times) if k % 6 == 5 else times)
        for format_ in (None, *FORMATS):
            for given in (None, times_path):
                result = check(path, given, format_)
                told[name, result] += format_ == name and (given is not None) == (name == "kitti")
        told["stamps", "read" if outcome(lambda: read_stamps(path)) else "refused"] += 1
    return +told


def test_200_broken_files(tmp_path, random_trajectory):
    told = fuzz(tmp_path, random_trajectory(8), 200, seed=1)
    # As it should be with mutations like these: some harmless, some beyond repair.
    assert all(told[name, result] > 0 for name in ("tum", "euroc") for result in ("read", "repaired", "refused"))
    assert told["kitti", "read"] > 0
    assert told["kitti", "refused"] > 0


@pytest.mark.slow
def test_10_000_broken_files(tmp_path, random_trajectory, capsys):
    told = fuzz(tmp_path, random_trajectory(8), 10_000, seed=2)
    with capsys.disabled():
        print("".join(f"\n{name} {result}: {n}" for (name, result), n in sorted(told.items())))  # noqa: T201
    assert sum(n for (name, _), n in told.items() if name != "stamps") == 10_000
