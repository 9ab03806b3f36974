"""What may have been to blame: changes that are tried one at a time."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf
from typing import Any

from slamgym.params import DriveParams, SlamInLoopParams
from slamgym.render import MAX_BRIGHTNESS

RICHEST_TEXTURE = 2.0
"""The most that loaders with an option `texture` take."""
STRAIGHT_RADPS = 0.1
"""Turning no quicker than that, it drove straight on."""


@dataclass(frozen=True, slots=True)
class Setup:
    """All that a run depends on besides its path. busy_processes: how many kept the computer busy meanwhile.
    turned_radps: the quickest that it turned around the loss, which may be far below its top turn rate.
    """

    drive: DriveParams
    slam: SlamInLoopParams
    busy_processes: int = 0
    turned_radps: float = inf

    def with_drive(self, **params: Any) -> "Setup":
        return replace(self, drive=self.drive.model_copy(update=params))

    def with_slam(self, **params: Any) -> "Setup":
        return replace(self, slam=self.slam.model_copy(update=params))


Change = Callable[[Setup], Setup | None]
"""The changed setup, or None where there is nothing to change."""


def _half_the_turn_rate(setup: Setup) -> Setup | None:
    """Half of what it turned at: half of a top rate that it never reached would change nothing."""
    turn_rate = min(setup.drive.top_turn_rate, setup.turned_radps)
    return setup.with_drive(turn_rate=turn_rate / 2) if turn_rate > STRAIGHT_RADPS else None


def _half_the_speed(setup: Setup) -> Setup:
    # A turn rate that is left open would be halved along with the speed.
    return setup.with_drive(speed=setup.drive.speed / 2, turn_rate=setup.drive.top_turn_rate)


def _more_light(setup: Setup) -> Setup | None:
    """Twice as much, at least as much as is usual."""
    brightness = min(max(2 * setup.drive.brightness, 1.0), MAX_BRIGHTNESS)
    return setup.with_drive(brightness=brightness) if brightness > setup.drive.brightness else None


def _richer_texture(setup: Setup) -> Setup | None:
    texture = getattr(setup.drive.scene_source().options, "texture", RICHEST_TEXTURE)
    richer = {**setup.drive.scene_options, "texture": RICHEST_TEXTURE}
    return setup.with_drive(scene_options=richer) if texture < RICHEST_TEXTURE else None


CHANGES: dict[str, Change] = {
    "half the turn rate": _half_the_turn_rate,
    "half the speed": _half_the_speed,
    "every frame": lambda setup: setup.with_slam(stride=0) if setup.slam.stride else None,
    "more light": _more_light,
    "richer texture": _richer_texture,
    "no depth noise": lambda setup: setup.with_drive(depth_noise="none") if setup.drive.depth_noise != "none" else None,
    "no image noise": lambda setup: setup.with_drive(rgb_noise=0.0) if setup.drive.rgb_noise else None,
    "no motion blur": lambda setup: setup.with_drive(motion_blur=0.0) if setup.drive.motion_blur else None,
    "lock-step": lambda setup: setup.with_slam(slam_sync="lockstep") if setup.slam.slam_sync != "lockstep" else None,
    "an idle computer": lambda setup: replace(setup, busy_processes=0) if setup.busy_processes else None,
}
"""Name, to be read after "with", -> change. A new one is one line here."""


def changes_of(setup: Setup) -> dict[str, Setup]:
    """The setup with each of the CHANGES for itself, those that have nothing to change left out."""
    changed = {name: change(setup) for name, change in CHANGES.items()}
    return {name: other for name, other in changed.items() if other is not None}
