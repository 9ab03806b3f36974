import io
import os
import signal
import subprocess
import sys
from collections import Counter
from pathlib import Path

import cv2
import gymnasium as gym
import numpy as np
import pytest
from PIL import Image
from rerun.chunk import RrdReader

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.cli import main
from slamgym.errors import ConfigError, OutputError
from slamgym.geometry import inverse
from slamgym.live import live_view
from slamgym.rollout import EpisodeInterrupted, run_episode

SMALL = {"camera": "small", "path_length_m": 1.0, "speed": 0.6}


def drive(path, agent=None, env_id="HomeRobotSLAM-v0", **params):
    env = gym.make(env_id, **{**SMALL, **params})
    try:
        with live_view(path) as show:
            return run_episode(show(env), agent or PathFollower(), seed=7)
    finally:
        env.close()


def rows(path, entity, component):
    """(stamp in ns, value) of every row of an entity's component."""
    found = []
    for chunk in RrdReader(str(path)).stream().filter(content=f"/{entity}").to_chunks():
        batch = chunk.to_record_batch()
        if not chunk.is_static and component in batch.schema.names:
            stamps = batch.column("stamp").cast("int64").to_pylist()
            found += zip(stamps, batch.column(component).to_pylist(), strict=True)
    return sorted(found, key=lambda row: row[0])


def row_counts(path):
    counts = Counter[str]()
    for chunk in RrdReader(str(path)).stream().to_chunks():
        if not chunk.is_static:
            counts[chunk.entity_path.removeprefix("/")] += chunk.num_rows
    return counts


class Stops:
    """Follows the path until somebody presses Ctrl-C."""

    reset_options = PathFollower.reset_options

    def __init__(self, after):
        self.left = after

    def act(self, obs, info):
        self.left -= 1
        if self.left < 0:
            raise KeyboardInterrupt
        return PathFollower().act(obs, info)


class Watches(PathFollower):
    __slots__ = ("seen",)

    def act(self, obs, info):
        self.seen.append((info["stamp_ns"], obs["rgb"].copy(), obs["depth"].copy()))
        return PathFollower().act(obs, info)


def test_every_frame_is_there_as_the_robot_saw_it(tmp_path):
    agent = Watches()
    object.__setattr__(agent, "seen", [])
    episode = drive(tmp_path / "drive.rrd", agent, slam="groundtruth")
    frames = len(episode.steps)
    counts = row_counts(tmp_path / "drive.rrd")
    for entity in ("world/camera", "world/camera/rgb", "world/camera/depth", "robot/speed_mps", "slam/tracked_points"):
        assert counts[entity] == frames
    assert counts["world/map_points"] == 0
    stamps, positions = zip(*rows(tmp_path / "drive.rrd", "world/camera", "Transform3D:translation"), strict=True)
    assert list(stamps) == [step.stamp_ns for step in episode.steps]
    assert np.array(positions)[:, 0] == pytest.approx(episode.truth.positions, abs=1e-5)
    jpegs = rows(tmp_path / "drive.rrd", "world/camera/rgb", "EncodedImage:blob")
    pngs = rows(tmp_path / "drive.rrd", "world/camera/depth", "EncodedDepthImage:blob")
    for k in (0, frames // 2):
        stamp_ns, rgb, depth = agent.seen[k]
        assert (jpegs[k][0], pngs[k][0]) == (stamp_ns, stamp_ns)
        shown = np.asarray(Image.open(io.BytesIO(bytes(jpegs[k][1][0]))), dtype=float)
        assert np.abs(shown - rgb).mean() < 4
        millimetres = cv2.imdecode(np.frombuffer(bytes(pngs[k][1][0]), np.uint8), cv2.IMREAD_UNCHANGED)
        assert np.abs(millimetres / 1000 - depth).max() <= 0.0005 + 1e-6


def test_every_map_is_laid_to_the_truth_and_a_loss_breaks_the_estimate(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    path = tmp_path / "drive.rrd"
    episode = drive(path, slam="shown_backends:TwoMaps")
    assert [row[1] for row in rows(path, "slam/state", "StateChange:state")] == [["ok"], ["lost"], ["ok"]]
    events = [row[1][0] for row in rows(path, "slam/events", "TextLog:text")]
    assert events[:3] == ["initialized", "lost", "new_map"]
    assert events[3].startswith("end: ok, ATE 0.000 m, completion")
    strips = [np.array(strip) for strip in rows(path, "world/estimated_path", "LineStrips3D:strips")[-1][1]]
    assert len(strips) == 2
    true = episode.truth.positions
    assert strips[0][0] == pytest.approx(true[0], abs=1e-5)
    assert strips[1][0] == pytest.approx(true[15], abs=1e-5)
    for point in np.vstack(strips):
        assert np.linalg.norm(true - point, axis=1).min() < 1e-5
    # The points are told in the map's frame, one of them is NaN, and after the last frame there is no map to ask.
    told = [np.array(row[1]) for row in rows(path, "world/map_points", "Points3D:positions") if row[1]]
    assert len(told) == len(true) - 5 - 1
    for points in told:
        assert points == pytest.approx(np.array([[1.0, 2, 3], [4, 5, 6]]), abs=1e-5)


def test_map_points_of_orbslam3_lie_on_what_the_camera_sees(tmp_path):
    path = tmp_path / "drive.rrd"
    agent = Watches()
    object.__setattr__(agent, "seen", [])
    episode = drive(path, agent, slam="orbslam3", camera="default", path_length_m=0.6)
    assert episode.summary["status"] == "ok"
    told = rows(path, "world/map_points", "Points3D:positions")
    assert len(told) == len(episode.steps) - 1
    stamp_ns, points = told[-1]
    _, _, depth = next(seen for seen in agent.seen if seen[0] == stamp_ns)
    T_cam_world = inverse(next(step.T_world_cam for step in episode.steps if step.stamp_ns == stamp_ns))
    x, y, z = T_cam_world[:3, :3] @ np.array(points).T + T_cam_world[:3, 3:]
    u, v = np.rint(460 * np.array([x, y]) / z + [[319.5], [239.5]]).astype(int)
    seen = (u >= 0) & (u < 640) & (v >= 0) & (v < 480) & (z > 0)
    assert seen.sum() > 100
    assert seen.mean() > 0.95
    assert np.median(np.abs(depth[v[seen], u[seen]] - z[seen])) < 0.05


def test_wrong_map_points_are_told_where_they_are_given(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    episode = drive(tmp_path / "drive.rrd", slam="shown_backends:FlatMap")
    assert episode.summary["status"] == "crashed"
    assert "array (N, 3), got shape (2, 2)" in episode.summary["failure"]
    assert "when asked for its map after frame 0" in episode.summary["failure"]


def test_a_drive_without_a_slam_and_one_with_a_stride(tmp_path):
    bare = drive(tmp_path / "bare.rrd", env_id="HomeRobot-v0")
    assert {name for name in row_counts(tmp_path / "bare.rrd") if name.startswith("slam")} == set()
    strided = drive(tmp_path / "strided.rrd", slam="groundtruth", stride=2)
    counts = row_counts(tmp_path / "strided.rrd")
    assert counts["world/camera"] == len(bare.steps) == len(strided.steps)
    assert counts["slam/tracked_points"] == strided.summary["frames_fed"]


def test_an_interrupted_drive_leaves_a_whole_file(tmp_path):
    with pytest.raises(EpisodeInterrupted):
        drive(tmp_path / "drive.rrd", Stops(after=6), slam="groundtruth")
    assert row_counts(tmp_path / "drive.rrd")["world/camera/rgb"] == 7


def test_ctrl_c_on_the_command_line_leaves_both_files(tmp_path):
    command = [sys.executable, "-m", "slamgym.cli", "run", "--camera", "small", "--path-length-m", "30"]
    command += ["--slam", "groundtruth", "--rerun", str(tmp_path / "drive.rrd"), "--out", str(tmp_path / "run")]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL)
    watched = tmp_path / "drive.rrd"
    while process.poll() is None and (not watched.exists() or watched.stat().st_size < 300_000):
        os.sched_yield()
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130, said
    frames = (tmp_path / "run.interrupted" / "frames.csv").read_text().count("\n") - 1
    assert row_counts(watched)["world/camera"] == frames > 5


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--rerun", "drive.txt"], "expected a file name that ends in .rrd, got 'drive.txt'"),
        (["--rerun", "a.rrd", "b.rrd"], "expected one file, or none for the viewer, got a.rrd, b.rrd"),
        (["--rerun"], "there is no screen; name a .rrd file"),
    ],
)
def test_bad_input_is_one_line(arguments, message, tmp_path, monkeypatch, capsys):
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"):
        monkeypatch.delenv(name, raising=False)
    with pytest.raises(SystemExit) as exit_:
        main(["run", "--out", str(tmp_path / "run"), *arguments])
    said = capsys.readouterr().err
    assert exit_.value.code == 2
    assert message in said
    assert said.count("\n") == 1
    assert not (tmp_path / "run").exists()


def test_a_file_that_is_there_is_kept(tmp_path):
    path = tmp_path / "drive.rrd"
    path.write_text("mine")
    with pytest.raises(OutputError, match="expected a new or empty file"), live_view(path):
        pass
    assert path.read_text() == "mine"


def test_another_environment_is_refused(tmp_path):
    with pytest.raises(ConfigError, match="expected a HomeRobot environment"), live_view(tmp_path / "a.rrd") as show:
        show(gym.make("CartPole-v1"))


def test_without_rerun_one_line_says_what_to_install(tmp_path):
    code = "import sys; sys.modules['rerun'] = None; from slamgym.cli import main; main(sys.argv[1:])"
    arguments = ["run", "--out", str(tmp_path / "run"), "--rerun", str(tmp_path / "a.rrd")]
    result = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, timeout=60)
    assert result.returncode == 2
    assert result.stderr.strip().replace("\n", " ").endswith("pip install 'slamgym[rerun]'")
    assert "Traceback" not in result.stderr
