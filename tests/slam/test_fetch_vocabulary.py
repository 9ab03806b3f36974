import hashlib
import io
import os
import signal
import subprocess
import sys
import tarfile
import threading
import time
from dataclasses import replace
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

from slamgym.cli import main
from slamgym.errors import OutputError, SlamError
from slamgym.slam import fetch_vocabulary as fetching
from slamgym.slam.fetch_vocabulary import ORBVOC, Source, fetch_vocabulary, fetched_vocabulary

TEXT = ("2 1  0 0\n" + "\n".join(f"0 1 {' '.join([bits] * 32)}  1" for bits in ("0", "255")) + "\n").encode()


def archive(**files):
    """A tar.gz of the files, a name's `__` standing for a dot, after a link and a file that leads out of the folder."""
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w:gz") as tar:
        link = tarfile.TarInfo("ORBvoc.txt")
        link.type, link.linkname = tarfile.SYMTYPE, "/etc/passwd"
        tar.addfile(link)
        for name, content in {"../outside.txt": b"bad", **files}.items():
            member = tarfile.TarInfo(name.replace("__", "."))
            member.size = len(content)
            tar.addfile(member, io.BytesIO(content))
    return packed.getvalue()


GOOD = archive(ORBvoc__txt=TEXT)


def sha256(content):
    return hashlib.sha256(content).hexdigest()


class Server(ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self):
        super().__init__(("127.0.0.1", 0), Handler)
        self.asked = []
        self.closing = threading.Event()


class Handler(BaseHTTPRequestHandler):
    def do_GET(self):
        self.server.asked.append(self.path)
        getattr(self, self.path.rpartition("/")[0].strip("/"), self.missing)()

    def good(self):
        self._send(GOOD, len(GOOD))

    def unsized(self):
        self._send(GOOD, None)

    def moved(self):
        self.send_response(302)
        self.send_header("Location", "/good/ORBvoc.txt.tar.gz")
        self.end_headers()

    def wrong(self):
        self._send(b"<html>Please log in</html>", None)

    def empty(self):
        self._send(archive(readme__txt=b"nothing"), None)

    def truncated(self):
        self._send(GOOD[: len(GOOD) // 2], len(GOOD))

    def endless(self):
        self.send_response(200)
        self.end_headers()
        while not self.server.closing.is_set():
            self.wfile.write(b"0" * 100_000)

    def stalled(self):
        self._send(GOOD[: len(GOOD) // 2], len(GOOD))
        self.wfile.flush()
        self.server.closing.wait(60)

    def silent(self):
        self.server.closing.wait(60)

    def missing(self):
        self.send_error(404)

    def _send(self, content, length):
        self.send_response(200)
        if length is not None:
            self.send_header("Content-Length", str(length))
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, *args):
        """The list `asked` is enough."""


@pytest.fixture
def server(tmp_path, monkeypatch):
    """Address of a real server on this machine, and the paths that it has been asked for: `/good/NAME` and so on."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "temporary"))
    with Server() as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True)
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_port}", server.asked
        finally:
            server.closing.set()
            server.shutdown()
            thread.join()


def source(server, kind):
    return Source(f"{server[0]}/{kind}/ORBvoc.txt.tar.gz", sha256(GOOD), sha256(TEXT))


def files(folder):
    return {path.relative_to(folder) for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("kind", ["good", "unsized", "moved"])
def test_fetched_into_the_cache_and_found_there(server, tmp_path, kind):
    wanted = source(server, kind)
    assert fetched_vocabulary(source=wanted) is None
    told = []
    path = fetch_vocabulary(source=wanted, on_bytes=lambda done, total: told.append((done, total)))
    assert path == tmp_path / "cache" / "slamgym" / "ORBvoc.txt"
    assert path.read_bytes() == TEXT
    assert told[-1] == (len(GOOD), None if kind == "unsized" else len(GOOD))
    assert files(tmp_path) == {path.relative_to(tmp_path)}  # nothing else of the archive, no draft
    asked = len(server[1])
    assert fetched_vocabulary(source=wanted) == path
    assert len(server[1]) == asked


def test_a_damaged_cache_is_fetched_again(server):
    wanted = source(server, "good")
    path = fetch_vocabulary(source=wanted)
    path.write_bytes(TEXT[:-10])
    assert fetched_vocabulary(source=wanted) is None
    assert fetch_vocabulary(source=wanted) == path
    assert path.read_bytes() == TEXT


def test_to_a_file_of_ones_own(server, tmp_path):
    wanted, out = source(server, "good"), tmp_path / "deep" / "voc.txt"
    assert fetched_vocabulary(out, wanted) is None
    assert fetch_vocabulary(out, wanted) == out == fetched_vocabulary(out, wanted)
    assert files(tmp_path) == {Path("deep/voc.txt")}
    out.write_text("mine")
    assert fetched_vocabulary(out, wanted) is None
    with pytest.raises(OutputError, match="new or empty"):
        fetch_vocabulary(out, wanted)
    assert out.read_text() == "mine"


@pytest.mark.parametrize(
    ("kind", "reason"),
    [
        ("wrong", f"expected its archive to have the SHA-256 {sha256(GOOD)}, got "),
        ("missing", "HTTP Error 404"),
        ("truncated", f"the connection ended after {len(GOOD) // 2:,} of {len(GOOD):,} bytes"),
        ("stalled", "the server was silent for 0.3 s"),
        ("silent", "the server was silent for 0.3 s"),
        ("endless", "it is larger than 1,000,000 bytes"),
    ],
)
def test_failure_says_what_to_do_and_leaves_nothing(server, tmp_path, monkeypatch, kind, reason):
    monkeypatch.setattr(fetching, "MAX_ARCHIVE_BYTES", 1_000_000)
    with pytest.raises(SlamError) as raised:
        fetch_vocabulary(source=source(server, kind), timeout_s=0.3)
    message = str(raised.value)
    assert reason in message
    assert "UZ-SLAMLab/ORB_SLAM3" in message
    assert "tar -xf ORBvoc.txt.tar.gz" in message
    assert "--slam-options vocabulary ORBvoc.txt" in message
    assert "\n" not in message
    assert files(tmp_path) == set()


@pytest.mark.parametrize(
    "url", ["http://127.0.0.1:9/ORBvoc.txt.tar.gz", "http://slamgym.invalid/voc.tar.gz", "ORBvoc.txt.tar.gz"]
)
def test_no_server(server, tmp_path, url):
    with pytest.raises(
        SlamError, match=r"cannot be used: (Connection refused|Name or|Temporary|No address|unknown url type)"
    ):
        fetch_vocabulary(source=replace(ORBVOC, url=url), timeout_s=5)
    assert files(tmp_path) == set()


def test_another_text_in_the_archive(server, tmp_path):
    with pytest.raises(SlamError, match=f"expected its text to have the SHA-256 {'0' * 64}, got {sha256(TEXT)}"):
        fetch_vocabulary(source=replace(source(server, "good"), text_sha256="0" * 64))
    assert files(tmp_path) == set()


def test_only_the_one_file_and_no_link_is_unpacked(server, tmp_path, monkeypatch):
    empty = replace(source(server, "empty"), archive_sha256=sha256(archive(readme__txt=b"nothing")))
    with pytest.raises(SlamError, match=r"expected ORBvoc\.txt of at most"):
        fetch_vocabulary(source=empty)
    monkeypatch.setattr(fetching, "MAX_TEXT_BYTES", len(TEXT) - 1)
    with pytest.raises(SlamError, match=r"expected ORBvoc\.txt of at most"):
        fetch_vocabulary(source=source(server, "good"))
    assert files(tmp_path) == set()


def test_nowhere_to_write(server, tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert fetch_vocabulary(source=source(server, "good")).parent.parent == tmp_path / "temporary"
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "file"))
    with pytest.raises(OutputError, match="give --out"):
        fetch_vocabulary(source=source(server, "good"))
    assert len(server[1]) == 1


def test_interrupted_download_leaves_nothing(server, tmp_path):
    program = (
        # A program that is started in the background ignores Ctrl-C, and so do those that it starts.
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "from slamgym.slam.fetch_vocabulary import *\n"
        f"fetch_vocabulary(source=Source('{server[0]}/stalled/voc.tar.gz', '', ''),"
        " on_bytes=lambda done, total: print(done, flush=True))"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", program],
        env={**os.environ, "XDG_CACHE_HOME": str(tmp_path / "cache")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        deadline = time.monotonic() + 60
        while not server[1] and time.monotonic() < deadline:
            time.sleep(0.05)
        while not files(tmp_path) and time.monotonic() < deadline:
            time.sleep(0.05)
        assert files(tmp_path)
        process.send_signal(signal.SIGINT)
        assert "KeyboardInterrupt" in process.communicate(timeout=60)[1]
    finally:
        process.kill()
    assert files(tmp_path) == set()


def test_command(server, monkeypatch, capsys):
    monkeypatch.setattr("slamgym.cli.vocab.ORBVOC", source(server, "good"))
    for note in ("", "fetched already"):
        main(["vocab", "fetch", "--url", f"{server[0]}/good/voc.tar.gz"])
        printed = capsys.readouterr()
        path = Path(printed.out.strip())  # nothing else, so that a shell can use it
        assert path.read_bytes() == TEXT
        assert note in printed.err
        assert f"--slam-options vocabulary {path}" in printed.err.replace("\n", "")
    assert len(server[1]) == 1


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--url", "{}/wrong/voc.tar.gz"], "expected its archive to have the SHA-256 ff2d0e82a69a"),
        (["--url", "{}/silent/voc.tar.gz", "--timeout-s", "0.2"], "the server was silent for 0.2 s"),
        (["--timeout-s", "0"], "expected --timeout-s above 0, got 0"),
        (["--timeout-s", "nan"], "expected --timeout-s above 0, got nan"),
    ],
)
def test_command_fails_in_one_line(server, tmp_path, capsys, options, message):
    with pytest.raises(SystemExit) as stopped:
        main(["vocab", "fetch", *(option.format(server[0]) for option in options)])
    assert stopped.value.code == 2
    printed = capsys.readouterr()
    assert message in printed.err
    assert len(printed.err.strip().splitlines()) == 1
    assert printed.out == ""
    assert files(tmp_path) == set()
