"""Any program that reads a sequence in the format of TUM RGB-D and writes a trajectory, run when all frames are there.

Such are the `rgbd_tum` of ORB-SLAM2 and ORB-SLAM3. What a program does not write about a frame, such as whether it was
lost or guessed, nobody can know: a frame counts as tracked when the trajectory has a pose at its stamp.
"""

import tempfile
import warnings
from collections.abc import Callable
from contextlib import chdir
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field

from slamgym.errors import ConfigError, SlamError, TrajectoryError, TrajectoryWarning
from slamgym.eval.datasets import SequenceWriter
from slamgym.eval.datasets.camera_file import TUM_DEPTH_SCALE
from slamgym.eval.trajectories import Trajectory, match_stamps, read_trajectory
from slamgym.files import recorded_hash
from slamgym.slam.backend import SlamConfig, untracked
from slamgym.slam.command_template import PLACEHOLDERS, Template
from slamgym.slam.orb_settings import OrbOptions, classic_settings
from slamgym.slam.program import run_program
from slamgym.slam.vocabulary import vocabulary_hash, vocabulary_path
from slamgym.types import Frame, IntArray, SlamTrajectory, TrackingState, TrackResult


def _split_commas(codes: Any) -> Any:
    return codes.split(",") if isinstance(codes, str) else codes


class CommandOptions(OrbOptions):
    """The command, and the settings of the ORB-SLAMs that are written for it when it holds {settings}."""

    command: str = Field(
        "rgbd_tum {vocabulary} {settings} {sequence} {associations}",
        description="program and arguments; in braces: " + ", ".join(PLACEHOLDERS),
    )
    trajectory: str = Field(
        "CameraTrajectory.txt", description="TUM file that it writes, relative to the folder that it is started in"
    )
    settings: Path | None = Field(None, description="settings file of your own; None: one for the camera is written")
    accept_exit_codes: Annotated[tuple[int, ...], BeforeValidator(_split_commas)] = Field(
        (0,), description="exit codes after which the trajectory counts, as a shell has them: 139 is a SIGSEGV"
    )


class Command:
    """One run of a program over all frames that were fed, in a folder of its own."""

    Options = CommandOptions
    loop_closures = (True, False)
    has_background_threads = False
    offline = True

    @classmethod
    def check(cls, config: SlamConfig) -> None:
        options = CommandOptions.checked(config.options)
        template = Template.parse(options.command)
        _refuse_unused(config, options, template)
        if Path(options.trajectory).is_absolute() or ".." in Path(options.trajectory).parts:
            raise ConfigError(
                "slam option 'trajectory': expected a path inside the folder that the program is started in, so that "
                f"runs do not overwrite each other's, got {options.trajectory!r}; {{trajectory}} tells the program"
            )
        if template.program() is None:
            raise SlamError(
                f"slam backend 'command': expected a program, found no executable {template.words[0]!r}; build it, and "
                "give its path in the slam option 'command' or put its folder on PATH"
            )
        if options.settings is not None and not options.settings.expanduser().is_file():
            raise SlamError(f"slam option 'settings': expected a file, got {options.settings}; leave it out for ours")
        if "vocabulary" in template.placeholders:
            vocabulary_path(options.vocabulary)

    @classmethod
    def versions(cls, config: SlamConfig) -> dict[str, str]:
        options = CommandOptions.checked(config.options)
        template = Template.parse(options.command)
        versions = {f"{word}_sha256": recorded_hash(path) for word, path in template.files().items()}
        if options.settings is not None:
            versions["settings_sha256"] = recorded_hash(options.settings.expanduser())
        if "vocabulary" in template.placeholders:
            versions["vocabulary_sha256"] = vocabulary_hash(options.vocabulary)
        return versions

    def __init__(self, config: SlamConfig) -> None:
        self._config = config
        self._options = CommandOptions.checked(config.options)
        self._template = Template.parse(self._options.command)
        self._folder = tempfile.TemporaryDirectory(prefix="command-")
        self._sequence = Path(self._folder.name) / "sequence"
        self._started_in = Path(self._folder.name) / "run"
        self._writer = SequenceWriter(self._sequence, config.camera, config.fps)
        self._stamps_ns: list[int] = []

    def track(self, frame: Frame) -> TrackResult:
        self._writer.add(frame)
        self._stamps_ns.append(frame.stamp_ns)
        return untracked(TrackingState.NOT_INITIALIZED)

    def finish(self) -> SlamTrajectory:
        """Raises SlamError when the program fails, or what it writes is no trajectory of these frames."""
        self._writer.close()
        saved = Trajectory(np.empty(0, np.int64), np.empty((0, 4, 4)))
        if self._stamps_ns:
            path = Path(self._options.trajectory)
            (self._started_in / path.parent).mkdir(parents=True)
            run_program(self._template.filled(self._values()), self._started_in, self._options.accept_exit_codes)
            with chdir(self._started_in):  # what is said about the file outlives this folder, and does not name it
                saved = _read(path)
        return at_frames(saved, np.array(self._stamps_ns, dtype=np.int64), self._config.fps)

    def _values(self) -> dict[str, object]:
        """What stands for each placeholder that the command has; no other is looked up or written."""
        values: dict[str, Callable[[], object]] = {
            "vocabulary": lambda: vocabulary_path(self._options.vocabulary).absolute(),
            "settings": self._settings,
            "sequence": lambda: self._sequence,
            "associations": lambda: self._sequence / "associations.txt",
            "trajectory": lambda: self._started_in / self._options.trajectory,
            "loop_closure": lambda: int(self._config.loop_closure is not False),
        }
        return {name: values[name]() for name in self._template.placeholders}

    def _settings(self) -> Path:
        if self._options.settings is not None:
            return self._options.settings.expanduser().absolute()
        path = Path(self._folder.name) / "settings.yaml"
        # The images are read from files, in OpenCV's order of the colours.
        path.write_text(
            classic_settings(self._config, self._options, is_rgb=False, depth_units=TUM_DEPTH_SCALE), encoding="utf-8"
        )
        return path


def _refuse_unused(config: SlamConfig, options: CommandOptions, template: Template) -> None:
    """Raise ConfigError for what was set and cannot reach the program."""
    written = [name for name in OrbOptions.model_fields if name != "vocabulary"]
    reaches = {"vocabulary": ["vocabulary"], "settings": ["settings", *written]}
    for placeholder, names in reaches.items():
        changed = [n for n in names if getattr(options, n) != CommandOptions.model_fields[n].default]
        if changed and placeholder not in template.placeholders:
            raise ConfigError(_unreachable(f"slam option {changed[0]!r}", placeholder, options.command))
        if placeholder == "settings" and options.settings is not None and changed[1:]:
            raise ConfigError(
                f"slam option {changed[1]!r}: expected it in {options.settings}, the settings file of your own, got it "
                "as an option as well; leave one of the two out"
            )
    if config.loop_closure is not None and "loop_closure" not in template.placeholders:
        raise ConfigError(_unreachable("loop_closure", "loop_closure", options.command))


def _unreachable(name: str, placeholder: str, command: str) -> str:
    return (
        f"{name}: expected {{{placeholder}}} in the slam option 'command', by which alone it reaches the program, got "
        f"{command!r}; put it there, or leave {name} out"
    )


def _read(path: Path) -> Trajectory:
    if not path.is_file():
        written = ", ".join(sorted(file.name for file in path.parent.iterdir())) or "nothing"
        raise SlamError(
            f"slam backend 'command': expected the trajectory {path.name}, the program wrote {written}; give the name "
            "of its file in the slam option 'trajectory'"
        )
    try:
        return read_trajectory(path, "tum", repair=True, allow_empty=True)
    except TrajectoryError as error:
        raise SlamError(f"slam backend 'command': the program's trajectory cannot be read: {error}") from None


def at_frames(saved: Trajectory, fed_ns: IntArray, fps: float) -> SlamTrajectory:
    """The poses at the stamps of the frames, int64 (N,), that they belong to: programs write few decimals.

    That is the nearest frame, within half of the least time between two. Says by a TrajectoryWarning how many poses
    belong to none; raises SlamError when none does.
    """
    least_ns = int(np.diff(fed_ns).min()) if len(fed_ns) > 1 else round(1e9 / fps)
    frames, poses = match_stamps(fed_ns, saved.stamps_ns, least_ns // 2)
    if len(saved) and not len(poses):
        raise SlamError(
            f"slam backend 'command': expected poses with stamps of frames, {fed_ns[0] * 1e-9:.6f} to "
            f"{fed_ns[-1] * 1e-9:.6f} s, got {saved.stamps_ns[0] * 1e-9:.6f} to {saved.stamps_ns[-1] * 1e-9:.6f} s; "
            "write the stamps that associations.txt has"
        )
    if alone := len(saved) - len(poses):
        warnings.warn(f"{alone} of {len(saved)} poses belong to no frame: left out", TrajectoryWarning, stacklevel=2)
    return SlamTrajectory(fed_ns[frames], saved.T[poses], np.zeros(len(frames), dtype=np.int64))
