"""The shortest use: one drive with ORB-SLAM3 in the loop, and what became of it."""

import gymnasium as gym

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower

env = gym.make("HomeRobotSLAM-v0", scene="procedural", speed=0.4, path_length_m=4.0)
obs, info = env.reset(seed=7)
agent = PathFollower()
done = False
while not done:
    obs, reward, terminated, truncated, info = env.step(agent.act(obs, info))
    done = terminated or truncated
env.close()

result = info["episode_slam"]
print(f"{result['status']}: ATE {result['ate_rmse_m']:.4f} m, completion {result['completion']:.0%}, ", end="")
print(f"{result['loss_count']} losses in {result['distance_m']:.1f} m")
