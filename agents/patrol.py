"""An agent that comes back to where it started."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from slamgym.agents.follower import PathFollower


@dataclass(frozen=True, slots=True)
class Patrol(PathFollower):
    """A path follower on a round trip: the SLAM sees its start again, and may close the loop."""

    reset_options: ClassVar[Mapping[str, Any]] = {"tour": "round_trip"}
