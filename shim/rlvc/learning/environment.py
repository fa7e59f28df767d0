# SPDX-License-Identifier: MIT
"""One interface to a Gymnasium environment and to a vector of them."""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..checks import shown
from ..errors import ConfigError, EnvError
from . import boundary
from .actions import Actions
from .encode import Encoder
from .masks import masks_of

if TYPE_CHECKING:
    from .run import Run


class Environment:
    """A Gymnasium environment or a vector of them, through one interface.

    Attributes
    ----------
    current : observation, or a batch of them
        What was seen last.
    masks : ndarray of bool, [n, actions], or None
        Which actions the environment allows now; None: all.
    masked : bool
        Whether there was a mask since the start.
    dead : ndarray of bool, [n]
        Environments of a vector whose next step only resets them.
    """

    def __init__(self, env: Any) -> None:
        boundary.check(env)
        self.env = env
        self.count = int(getattr(env, "num_envs", 0))
        self.vector = self.count > 0
        self.count = max(self.count, 1)
        self.observation_space = (
            env.single_observation_space if self.vector else env.observation_space
        )
        self.action_space = env.single_action_space if self.vector else env.action_space
        mode = str(env.metadata.get("autoreset_mode", "")) if self.vector else ""
        self.same_step = "SAME" in mode.upper()
        self.manual = "DISABLED" in mode.upper()
        self.dead = np.zeros(self.count, np.bool_)
        self.masks: npt.NDArray[np.bool_] | None = None
        self.masked = False
        self.current: Any = None

    def need_fit(self, run: Run, learns: bool) -> None:
        """Raise ConfigError if a run's actions or observations are not those of the environment.

        Parameters
        ----------
        run : Run
        learns : bool
            Whether it is to learn on: then it must have all actions.

        Raises
        ------
        ConfigError
        SpaceError
            The environment's actions or observations are of no kind that can be learnt.
        """
        actions, encoder, space = run.actions, run.encoder, self.action_space
        hint = "begin a new run" if learns else "pass an environment like the one that it learnt in"
        if not (actions.fit(space) if learns else actions.within(space)):
            raise ConfigError(
                f"run: its {actions.count} actions, {actions.name(0)} and so on, are not those of "
                f"{space!s:.80}: {hint}"
            )
        if isinstance(encoder, Encoder) and not encoder.fits(self.observation_space):
            count = len(encoder.elements)
            raise ConfigError(
                f"run: its observations, {count} number{'s' * (count > 1)}, are not those of "
                f"{self.observation_space!s:.80}: {hint}"
            )

    def start(self, actions: Actions, seed: int | None) -> None:
        """Reset the environment.

        Parameters
        ----------
        actions : Actions
            What the indices mean that it is stepped by.
        seed : int or None
            None: its random numbers go on.
        """
        self.actions = actions
        if self.vector and actions.hold > 1:
            raise ConfigError("hold: needs a single environment, not a vector")
        self.masked = False
        self._table = [actions.of(index) for index in range(actions.count)]
        self.dead = np.zeros(self.count, np.bool_)
        self._see(*boundary.reset(self.env, **({} if seed is None else {"seed": seed})))

    def restart(self) -> None:
        """Begin a new episode of a single environment, whether or not the last one ended."""
        self._see(*boundary.reset(self.env))

    def _see(self, observation: Any, info: Any) -> None:
        self.current = observation
        mask = info.get("action_mask") if isinstance(info, dict) else None
        if mask is None and isinstance(observation, dict):
            mask = observation.get("action_mask")
        if mask is None:
            self.masks = None
            return
        self.masks = masks_of(mask, self.count, self.actions.count)
        self.masked = self.masked or self.masks is not None

    def split(self, batch: Any) -> list[Any]:
        """Return the observations of a batch as a list."""
        if not self.vector:
            return [batch]
        from gymnasium.vector.utils import iterate

        try:
            observations = list(iterate(self.env.observation_space, batch))
        except Exception as error:  # whatever Gymnasium raises
            raise EnvError(f"observations: {shown(batch)} cannot be taken apart: {error}") from error
        if len(observations) != self.count:
            raise EnvError(f"observations: {len(observations)}, expected {self.count}")
        return observations

    def step(self, index: int) -> tuple[Any, float, bool, bool]:
        """Step a single environment by an action, for as long as it is held.

        Returns
        -------
        observation, float, bool, bool
            What it led to, the sum of the rewards, terminated and truncated. If the episode ended,
            call :meth:`restart`, when what it led to is no longer needed: an environment may write
            over its observation.
        """
        actions = self.actions
        following, reward, terminated, truncated, info = boundary.step(
            self.env, self._table[index] if actions.table is None else actions.of(index)
        )
        for _ in range(actions.hold - 1):
            if terminated or truncated:
                break
            following, more, terminated, truncated, info = boundary.step(
                self.env, actions.of(index)
            )
            reward += more
        if info.__class__ is not dict or info or self.masks is not None or isinstance(following, dict):
            self._see(following, info)
        else:
            self.current = following
        return following, reward, terminated, truncated

    def step_all(self, indices: npt.NDArray[Any]) -> tuple[Any, Any, Any, Any]:
        """Step every environment of a vector; return s', rewards, terminated and truncated.

        s' is a batch, or a list of observations if one is not in the batch. The caller leaves out
        environments that were ``dead`` before: their step only reset them.
        """
        chosen = self.actions.of_many(indices)
        following, rewards, terminated, truncated, info = boundary.step_all(self.env, chosen)
        over = terminated | truncated
        reached = following
        if self.same_step and over.any():
            if not isinstance(info, dict) or "final_obs" not in info:
                raise EnvError("info has no final_obs, which same-step autoreset must give")
            reached = self.split(following)
            for i in np.flatnonzero(over):
                reached[i] = info["final_obs"][i]
        elif self.manual and over.any():
            reached = copy.deepcopy(self.split(following))  # the environments may write over it
            following, info = boundary.reset(self.env, options={"reset_mask": over})
        elif not self.same_step:
            self.dead = over & ~self.dead  # a step that only resets ends nothing
        self._see(following, info)
        return reached, rewards, terminated, truncated
