"""Path planning and agents that drive the robot."""

from slamgym.agents.cautious import Cautious
from slamgym.agents.follower import Agent, PathFollower
from slamgym.agents.lap import Lap
from slamgym.agents.look_around import LookAround
from slamgym.agents.patrol import Patrol

AGENTS: dict[str, type[Agent]] = {
    "cautious": Cautious,
    "follower": PathFollower,
    "lap": Lap,
    "look_around": LookAround,
    "patrol": Patrol,
}
"""Name -> class. A new agent is one file and one line here."""

__all__ = ["AGENTS", "Agent", "Cautious", "Lap", "LookAround", "PathFollower", "Patrol"]
