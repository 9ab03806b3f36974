"""A program that damages the files of a scene many times and has each read by a loader, in this process.

    python fuzzing.py LOADER READER FOLDER COUNT SEED FILE...

LOADER, READER: "module:name" of the loader's class and of the function of a path and options that reads in this
process. FOLDER: files that are right, all small. FILE: those in it that are read. It prints JSON: how many were read
and refused, by file, and what went wrong: another exception than SceneError, a hang, or anything opened, started or
connected to outside the folder.
"""

import importlib
import json
import os
import resource
import signal
import sys
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

from slamgym.errors import SceneError

CASE_S = 20
MEMORY_BYTES = 6 << 30
WORDS = (
    *("nan", "-inf", "1e999", "-1", "0", "1", "4294967295", "99999999999999999999", "1e38", "0x10", "null", "[]", "{}"),
    *('"x"', "true", "-0.5", "2147483648", "1e-300", "..", "/", "é", "\\", "\0", "[" * 2000, "9" * 5000, '{"a": 1}'),
)
PATHS = (
    *("../../../../../../etc/passwd", "/etc/passwd", "file:///etc/passwd", "http://127.0.0.1:9/x.png", "/dev/zero"),
    *("..\\..\\secret.png", "%2e%2e/%2e%2e/secret.png", "link.png", "pipe.png", "//127.0.0.1/x.png", "C:\\x.png"),
    *("../secret.png", "data:;base64,AAAA", "data:image/png;base64,!!!!", "x" * 5000, "loop.png", ".", "~/x.png"),
)
COUNTS = (
    b"\xff\xff\xff\xff",
    b"\xff\xff\xff\x7f",
    b"\x00\x00\x00\x80",
    b"\x00\x00\xc0\x7f",
    b"\x00\x00\x80\x7f",
    b"\0" * 4,
)
LIBRARIES = tuple(str(Path(p).resolve()) for p in (*sys.path, sys.prefix, sys.base_prefix) if p and p != ".")
SYSTEM = ("/usr/lib", "/usr/share", "/usr/local/lib", "/lib", "/proc", "/sys", "/etc/ld.so", "/etc/mime", "/dev/null")
FORBIDDEN = (
    "socket.connect",
    "socket.getaddrinfo",
    "socket.bind",
    "subprocess.Popen",
    "os.system",
    "os.exec",
    "os.fork",
)


def flip_bits(rng, data):
    changed = bytearray(data)
    for k in rng.integers(len(data), size=rng.integers(1, 8)):
        changed[k] ^= 1 << int(rng.integers(8))
    return bytes(changed)


def truncate(rng, data):
    return data[: rng.integers(len(data))]


def cut_out(rng, data):
    k = int(rng.integers(len(data)))
    return data[:k] + data[k + int(rng.integers(1, 60)) :]


def double(rng, data):
    k, n = int(rng.integers(len(data))), int(rng.integers(1, 200))
    return data[: k + n] + data[k:]


def write_count(rng, data):
    k = int(rng.integers(len(data)))
    return data[:k] + COUNTS[rng.integers(len(COUNTS))] + data[k + 4 :]


def replace_word(rng, data):
    """Replace a number or a word, or a name in quotes or with a dot, by one that means harm."""
    text = data.decode("latin-1")
    start = int(rng.integers(len(text)))
    ends = ' \n\t,:[]{}"'
    while start < len(text) and text[start] in ends:
        start += 1
    stop = start
    while start and text[start - 1] not in ends:
        start -= 1
    while stop < len(text) and text[stop] not in ends:
        stop += 1
    choice = PATHS if "." in text[start:stop] or rng.random() < 0.3 else WORDS
    word = choice[rng.integers(len(choice))]
    return with_glb_length(
        data, (text[:start] + word.replace("\\", "\\\\")).encode("utf-8", "replace") + text[stop:].encode("latin-1")
    )


def with_glb_length(before, after):
    """A .glb whose JSON has changed in length says so, else it would be refused for that alone."""
    if before[:4] != b"glTF" or len(after) < 20:
        return after
    old = int.from_bytes(before[12:16], "little")
    new = max(0, old + len(after) - len(before))
    return after[:8] + len(after).to_bytes(4, "little") + new.to_bytes(4, "little") + after[16:]


MUTATIONS = (flip_bits, truncate, cut_out, double, write_count, write_count, *([replace_word] * 5))


def watch(folder, told):
    """Note what is opened outside the folder and the libraries, and what is started or connected to."""

    def hook(event, args):
        if event in FORBIDDEN:
            told.append(f"{event} {args!r:.100}")
        if event == "open" and isinstance(args[0], (str, bytes)) and not allowed(os.fsdecode(args[0])):
            told.append(f"opened {args[0]!r:.100}")

    def allowed(name):
        path = os.path.realpath(name)
        return path.startswith((folder, *LIBRARIES, *SYSTEM)) and "secret" not in path

    sys.addaudithook(hook)


def give_up(number, frame):
    raise TimeoutError(f"more than {CASE_S} s")


def check(house):
    assert house.parts
    for part in house.parts:
        assert len(part.faces)
        assert np.isfinite(part.vertices).all()
        assert part.faces.min() >= 0
        assert part.faces.max() < len(part.vertices)
        for array, width in ((part.uv, 2), (part.colour, 3)):
            assert array is None or (array.shape == (len(part.vertices), width) and np.isfinite(array).all())
        assert part.material.texture is None or max(part.material.texture.shape) <= 2048
        assert part.material.texture is None or part.uv is not None
    assert all(len(line.splitlines()) == 1 for line in house.assumptions + house.defects)


def outcome(read, path, options):
    try:
        house = read(path, options)
    except SceneError as error:
        message = str(error)
    except MemoryError:  # the loader's own process makes a SceneError of it
        return "refused"
    else:
        check(house)
        return "read"
    assert len(message.splitlines()) == 1, message
    assert len(message) < 2000, message
    assert path.name in message, message
    return "refused"


def named(target):
    module, _, name = target.partition(":")
    return getattr(importlib.import_module(module), name)


def fuzz(loader, reader, folder, count, seed, entries):
    read, options = named(reader), named(loader).Options()
    originals = {
        path: path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file() and not path.is_symlink()
    }
    targets = [path for path in originals if "secret" not in path.name]
    for entry in entries:
        assert outcome(read, folder / entry, options) == "read", entry
    told, wrong, rng = Counter(), [], np.random.default_rng(seed)
    opened = []
    watch(str(folder.resolve()), opened)
    for k in range(count):
        entry = folder / entries[k % len(entries)]
        victim = entry if rng.random() < 0.7 else targets[rng.integers(len(targets))]
        mutate = MUTATIONS[rng.integers(len(MUTATIONS))]
        victim.write_bytes(mutate(rng, originals[victim]))
        signal.alarm(CASE_S)
        try:
            told[entry.name, outcome(read, entry, options)] += 1
        except Exception as error:
            wrong.append(
                f"case {k} of seed {seed}, {victim.name} {mutate.__name__}: {type(error).__name__}: {error}"[:500]
            )
        finally:
            signal.alarm(0)
        wrong += [f"case {k} of seed {seed}, {victim.name} {mutate.__name__}: {event}" for event in opened]
        opened.clear()
        victim.write_bytes(originals[victim])
    return {"told": [[*key, n] for key, n in told.items()], "wrong": wrong}


def main():
    loader, reader, folder, count, seed, *entries = sys.argv[1:]
    warnings.simplefilter("ignore")
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
    signal.signal(signal.SIGALRM, give_up)
    result = fuzz(loader, reader, Path(folder), int(count), int(seed), entries)
    sys.stdout.write(json.dumps(result))


if __name__ == "__main__":
    main()
