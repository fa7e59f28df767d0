# SPDX-License-Identifier: MIT
"""One interface to a Gymnasium environment and to a vector of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..errors import EnvError
from . import boundary


class Environment:
    """A Gymnasium environment or a vector of them, through one interface."""

    def __init__(self, env: Any, seed: int) -> None:
        boundary.check(env)
        self.env = env
        self.count = int(getattr(env, "num_envs", 0))
        self.vector = self.count > 0
        self.count = max(self.count, 1)
        self.observation_space = (
            env.single_observation_space if self.vector else env.observation_space
        )
        self.action_space = env.single_action_space if self.vector else env.action_space
        self.actions, self.start = boundary.actions(self.action_space)
        mode = str(env.metadata.get("autoreset_mode", "")) if self.vector else ""
        self.same_step = "SAME" in mode.upper()
        self.manual = "DISABLED" in mode.upper()
        self.current = boundary.reset(env, seed=seed)
        self.dead = np.zeros(self.count, np.bool_)

    def split(self, batch: Any) -> list[Any]:
        """Return the observations of a batch as a list."""
        if not self.vector:
            return [batch]
        from gymnasium.vector.utils import iterate

        try:
            observations = list(iterate(self.env.observation_space, batch))
        except Exception as error:  # whatever Gymnasium raises
            raise EnvError(f"observations: {batch!r:.80} cannot be taken apart: {error}") from error
        if len(observations) != self.count:
            raise EnvError(f"observations: {len(observations)}, expected {self.count}")
        return observations

    def step(self, actions: npt.NDArray[Any]) -> tuple[list[Any], Any, Any, Any]:
        """Step every environment; return s', rewards, terminated and truncated.

        The caller leaves out environments that were ``dead`` before: their step only reset them.
        """
        actions = actions.astype(np.int64) + self.start
        if not self.vector:
            following, *rest = boundary.step(self.env, int(actions[0]))
            over = rest[1] or rest[2]
            self.current = boundary.reset(self.env) if over else following
            reward, terminated, truncated = (np.array([value]) for value in rest)
            return [following], reward, terminated, truncated
        following, rewards, terminated, truncated, info = boundary.step_all(self.env, actions)
        over = terminated | truncated
        reached = self.split(following)
        if self.same_step and over.any():
            if not isinstance(info, dict) or "final_obs" not in info:
                raise EnvError("info has no final_obs, which same-step autoreset must give")
            for i in np.flatnonzero(over):
                reached[i] = info["final_obs"][i]
        elif self.manual and over.any():
            following = boundary.reset(self.env, options={"reset_mask": over})
        elif not self.same_step:
            self.dead = over
        self.current = following
        return reached, rewards, terminated, truncated
