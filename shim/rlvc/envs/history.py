# SPDX-License-Identifier: MIT
"""A wrapper for tasks whose state is hidden: what was seen and done lately is observed, too."""

from __future__ import annotations

import copy
from collections import OrderedDict, deque
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from ..checks import whole
from ..errors import EnvError, SpaceError


class History(gymnasium.Wrapper[Any, Any, Any, Any]):
    """Observes the last n observations, and the n - 1 actions between them.

    Parameters
    ----------
    env : gymnasium.Env
        Its actions are Discrete or a Box.
    n : int
        [1, 64]

    Notes
    -----
    An observation is a dict of ``now``, ``1 ago``, ``action 1 ago``, and so on. Before the first
    observation of an episode that one is repeated; an action is its number + 1, and 0 if there was
    none, or of a Box 0.

    Raises
    ------
    EnvError
        ``env`` is none, or a vector of them.
    SpaceError
        The actions are of another space.
    """

    def __init__(self, env: gymnasium.Env[Any, Any], n: int) -> None:
        if not isinstance(env, gymnasium.Env):
            raise EnvError(f"env: {type(env).__name__} is not a single environment of Gymnasium")
        super().__init__(env)
        self._n = whole("n", n, 1, 64)
        actions: spaces.Space[Any]
        if isinstance(env.action_space, spaces.Discrete):
            actions = spaces.Discrete(int(env.action_space.n) + 1)
            self._none: Any = np.int64(0)
        elif isinstance(env.action_space, spaces.Box):
            actions = env.action_space
            self._none = np.zeros(actions.shape, actions.dtype)
        else:
            raise SpaceError(f"History: {env.action_space}: it takes Discrete actions or a Box")
        parts: list[tuple[str, spaces.Space[Any]]] = [("now", env.observation_space)]
        for ago in range(1, self._n):
            parts += [(f"{ago} ago", env.observation_space), (f"action {ago} ago", actions)]
        self.observation_space = spaces.Dict(OrderedDict(parts))
        self._seen: deque[Any] = deque(maxlen=self._n)
        self._done: deque[Any] = deque(maxlen=max(self._n - 1, 1))

    def _observed(self) -> OrderedDict[str, Any]:
        seen, done = list(self._seen)[::-1], list(self._done)[::-1]
        parts = [("now", seen[0])]
        for ago in range(1, self._n):
            parts += [(f"{ago} ago", seen[ago]), (f"action {ago} ago", done[ago - 1])]
        return OrderedDict(parts)

    def reset(self, **arguments: Any) -> tuple[Any, dict[str, Any]]:
        """Begin an episode: the past is empty."""
        observation, info = self.env.reset(**arguments)
        self._seen.extend([copy.deepcopy(observation)] * self._n)  # it may be written over
        self._done.extend([self._none] * self._n)
        return self._observed(), info

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Act, and remember what was done and seen."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        self._seen.append(copy.deepcopy(observation))
        if isinstance(self.env.action_space, spaces.Discrete):
            action = np.int64(int(action) - int(self.env.action_space.start) + 1)
        self._done.append(copy.deepcopy(action))
        return self._observed(), reward, terminated, truncated, info
