# SPDX-License-Identifier: MIT
"""Stable-Baselines3's DQN and PPO, with their defaults but the discount."""


def learn(task, seed, check, algorithm, times=1, checks=20):
    """One run of ``times`` the task's interactions; see the head of this package."""
    import stable_baselines3
    import torch
    from stable_baselines3.common.callbacks import BaseCallback

    torch.set_num_threads(1)
    learner = getattr(stable_baselines3, algorithm)
    model = learner("MlpPolicy", task.make(seed), gamma=task.discount, seed=seed, device="cpu")

    class Checks(BaseCallback):
        def _on_step(self):
            if self.num_timesteps % (task.interactions // checks) == 0:
                check(self.num_timesteps, lambda rows: model.predict(rows, deterministic=True)[0])
            return True

    model.learn(times * task.interactions, callback=Checks())
    return {"bytes": sum(p.numel() * p.element_size() for p in model.policy.parameters())}
