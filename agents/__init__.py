"""Path planning and agents that drive the robot."""

from slamgym.agents.follower import Agent, PathFollower
from slamgym.agents.patrol import Patrol

AGENTS: dict[str, type[PathFollower]] = {"follower": PathFollower, "patrol": Patrol}
"""Name -> class. A new agent is one file and one line here."""

__all__ = ["AGENTS", "Agent", "PathFollower", "Patrol"]
