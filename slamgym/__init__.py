"""slamgym measures how robust visual SLAM is.

Importing it registers the Gymnasium ids `HomeRobot-v0` and `HomeRobotSLAM-v0`.
"""

import gymnasium as gym
from gymnasium.envs.registration import WrapperSpec

MAX_EPISODE_STEPS = 10_000

gym.register(id="HomeRobot-v0", entry_point="slamgym.env:HomeRobotEnv", max_episode_steps=MAX_EPISODE_STEPS)
gym.register(
    id="HomeRobotSLAM-v0",
    entry_point="slamgym.env:HomeRobotForSlamEnv",
    additional_wrappers=(WrapperSpec("SlamWrapper", "slamgym.wrappers:SlamWrapper", {}),),
    max_episode_steps=MAX_EPISODE_STEPS,
    nondeterministic=True,
)
