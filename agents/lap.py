"""An agent that comes back to where it started, and goes on along its way."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from slamgym.agents.follower import PathFollower


@dataclass(frozen=True, slots=True)
class Lap(PathFollower):
    """A path follower on a round trip that takes its first metres once more: seen from the same side, the start closes
    the loop, which a `Patrol` that comes home from elsewhere often leaves open.
    """

    reset_options: ClassVar[Mapping[str, Any]] = {"tour": "lap"}
