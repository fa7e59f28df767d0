# SPDX-License-Identifier: MIT
"""What the environments have in common: four moves, until the goal is reached."""

from __future__ import annotations

import abc
from typing import Any, Generic, TypeVar

import gymnasium
import numpy as np
from gymnasium import spaces

from ..checks import shown

_Observation = TypeVar("_Observation")


class Moving(gymnasium.Env[_Observation, np.int64], Generic[_Observation]):
    """Base class of the environments: something moves up, right, down or left to a goal."""

    def __init__(self) -> None:
        self.action_space = spaces.Discrete(4)
        self._over = True

    @abc.abstractmethod
    def _start(self) -> None:
        """Begin an episode; if :meth:`reset` got a seed, ``np_random`` is a new generator."""

    @abc.abstractmethod
    def _move(self, action: int) -> tuple[float, bool, bool]:
        """Move; return the reward, terminated, and truncated."""

    @abc.abstractmethod
    def _observe(self) -> _Observation:
        """Return the observation at the present place."""

    @abc.abstractmethod
    def _info(self) -> dict[str, Any]:
        """Return the present place."""

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[_Observation, dict[str, Any]]:
        """Start an episode at a random place.

        Parameters
        ----------
        seed : int or None
            Seed of all random numbers from now on. None: continue the sequence.
        options : dict or None
            Ignored.

        Returns
        -------
        tuple
            The observation, and the place as a dict.

        Raises
        ------
        ConfigError
            There is no place to start.
        """
        super().reset(seed=seed)
        self._start()
        self._over = False
        return self._observe(), self._info()

    def step(self, action: Any) -> tuple[_Observation, float, bool, bool, dict[str, Any]]:
        """Move: 0 up, 1 right, 2 down, 3 left. A wall or the edge stops the move.

        Parameters
        ----------
        action : int

        Returns
        -------
        tuple
            The observation, the reward, terminated, truncated, and the place as a dict.

        Raises
        ------
        gymnasium.error.InvalidAction
            The action does not exist.
        gymnasium.error.ResetNeeded
            The episode is over.
        """
        if not self.action_space.contains(action):
            raise gymnasium.error.InvalidAction(f"{shown(action)} is not in [0, 3]")
        if self._over:
            raise gymnasium.error.ResetNeeded("call reset first")
        reward, terminated, truncated = self._move(int(action))
        self._over = terminated or truncated
        return self._observe(), reward, terminated, truncated, self._info()
