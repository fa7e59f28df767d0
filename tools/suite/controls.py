# SPDX-License-Identifier: MIT
"""Tasks of control on real numbers: Gymnasium's classic ones, some changed, and a ball to catch."""

import gymnasium
import numpy as np
from gymnasium import spaces

_TYPICAL = np.array([1.0, 1.0, 0.2, 1.0])  # size of CartPole's components


def _noisy(rows, random, components, error):
    """Observations [n, 4] with noise: float32 [n, 4 + components]."""
    seen = rows + error * _TYPICAL * random.standard_normal(rows.shape)
    more = random.standard_normal((len(rows), components))
    return np.concatenate([seen, more], axis=1).astype(np.float32)


class Noise(gymnasium.ObservationWrapper):
    """CartPole with ``components`` more that are normal noise, or with sensors that err.

    ``error`` is the standard deviation of a sensor's error, as a share of the component's typical size.
    """

    def __init__(self, env, components=0, error=0.0):
        super().__init__(env)
        self.components, self.error = components, error
        self.observation_space = spaces.Box(-np.inf, np.inf, (4 + components,), np.float32)

    def observation(self, observation):
        """The observation with noise."""
        return _noisy(observation[None], self.unwrapped.np_random, self.components, self.error)[0]


class Torques(gymnasium.ActionWrapper):
    """An environment with one real action, of which three values can be chosen."""

    def __init__(self, env):
        super().__init__(env)
        self.torques = np.linspace(env.action_space.low, env.action_space.high, 3)
        self.action_space = spaces.Discrete(3)

    def action(self, action):
        """The torque of an action."""
        return self.torques[action].astype(np.float32)


class Catch(gymnasium.Env):
    """A ball falls in 20 steps and bounces off two walls; a paddle below it moves by 0, -0.08 or 0.08.

    All rewards are 0 but the last one: 1 if the ball is caught, less than 0.15 away from the middle of
    the paddle, else -1. An observation has the ball's place x and height y, its drift in a step, the
    paddle's place, and how far the ball is from the paddle.
    """

    def __init__(self):
        self.observation_space = spaces.Box(-2, 2, (5,), np.float32)
        self.action_space = spaces.Discrete(3)

    def _see(self):
        away = self.x - self.paddle
        return np.array([self.x, self.height, self.drift, self.paddle, away], np.float32)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.x, self.drift = self.np_random.uniform((-1, -0.05), (1, 0.05))
        self.height, self.paddle = 1.0, 0.0
        return self._see(), {}

    def step(self, action):
        self.paddle = np.clip(self.paddle + (0, -0.08, 0.08)[action], -1, 1)
        self.x, self.height = self.x + self.drift, self.height - 0.05
        if abs(self.x) > 1:
            self.x, self.drift = np.clip(self.x, -1, 1), -self.drift
        landed = self.height < 0.025
        caught = abs(self.x - self.paddle) < 0.15
        return self._see(), (1.0 if caught else -1.0) if landed else 0.0, landed, False, {}


def balance(act, episodes, components=0, error=0.0):
    """The mean return of episodes of CartPole with such noise, played at once."""
    limit = gymnasium.spec("CartPole-v1").max_episode_steps
    env = gymnasium.make_vec(
        "CartPole-v1", num_envs=episodes, vectorization_mode="vector_entry_point"
    )
    rows, _ = env.reset(seed=0)
    random = np.random.default_rng(1)
    alive, total = np.ones(episodes, bool), 0
    for _ in range(limit):
        actions = act(_noisy(rows, random, components, error))
        rows, _, fell, _, _ = env.step(actions.astype(np.int64))
        total += alive.sum()
        alive &= ~fell
        if not alive.any():
            break
    return float(total / episodes)


def mean_return(make, act, episodes):
    """The mean return of episodes, played side by side."""
    envs = [make() for _ in range(episodes)]
    rows = np.array([env.reset(seed=seed)[0] for seed, env in enumerate(envs)])
    total, alive = 0.0, np.arange(episodes)
    while len(alive):
        actions = act(rows[alive])
        goes_on = []
        for i, action in zip(alive.tolist(), np.asarray(actions).tolist(), strict=True):
            rows[i], reward, ended, cut, _ = envs[i].step(action)
            total += float(reward)
            if not (ended or cut):
                goes_on.append(i)
        alive = np.array(goes_on, np.intp)
    return total / episodes
