# SPDX-License-Identifier: MIT
"""The result of learning: :class:`Run`."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np

from ..agent.agent import Agent
from ..agent.policy import Policy
from ..checks import whole
from . import boundary
from .encode import Encoder
from .small_policy import SmallPolicy

if TYPE_CHECKING:
    import gymnasium


@dataclasses.dataclass(frozen=True)
class Record:
    """A learning step of a run.

    Attributes
    ----------
    step : int
        Its number k.
    interactions : int
        Number so far.
    classes : int
        Number after the step.
    splits : int
        Number made in the step.
    episodes : int
        Number that ended since the previous step.
    mean_return : float
        Their mean undiscounted return, with exploration; NaN if there are none.
    """

    step: int
    interactions: int
    classes: int
    splits: int
    episodes: int
    mean_return: float


class Run:
    """The result of :func:`rlvc.learn` or :func:`rlvc.learn_from`.

    Attributes
    ----------
    agent : Agent
    encoder : Encoder or None
        None if there are no observations, only percepts.
    history : list of Record
        One record for each learning step; with trials also one for each episode of the last
        quarter.
    seed : int
    interrupted : bool
        Whether Ctrl-C ended learning.
    small : SmallPolicy or None
        With trials: the best small policy. It acts in place of the agent's tree.
    """

    def __init__(self, agent: Agent, encoder: Encoder | None, seed: int, start: int = 0) -> None:
        self.agent = agent
        self.encoder = encoder
        self.seed = seed
        self.history: list[Record] = []
        self.interrupted = False
        self.small: SmallPolicy | None = None
        self._start = start

    def act(self, observation: Any, policy: Policy | None = None) -> int:
        """Return the action of the learnt policy.

        Parameters
        ----------
        observation : element of the environment's space
        policy : Policy or None
            A result of ``run.agent.compact()`` to use instead.

        Returns
        -------
        int
            An element of the action space: ``Discrete.start`` is added.
        """
        percept = self.encoder.encode(observation) if self.encoder else observation
        if policy is not None:
            action = policy.act(percept)
        elif self.small:
            action = self.small.act(np.frombuffer(self.agent.domain.pack(percept), np.float32))
        else:
            action = self.agent.predict(percept).action
        return int(action) + self._start

    def evaluate(
        self,
        env: gymnasium.Env[Any, Any],
        episodes: int = 100,
        seed: int = 0,
        policy: Policy | None = None,
    ) -> float:
        """Play episodes with the learnt policy.

        Parameters
        ----------
        env : gymnasium.Env
        episodes : int
        seed : int
            Seed of the first reset.
        policy : Policy or None
            A result of ``run.agent.compact()`` to use instead.

        Returns
        -------
        float
            The mean undiscounted return of an episode.

        Raises
        ------
        ConfigError
            ``episodes`` is not at least 1, or ``seed`` not at least 0.
        EnvError, RewardError, PerceptError
            The environment returned something else than Gymnasium's interface says.
        """
        boundary.check(env)
        episodes = whole("episodes", episodes, 1, 2**53)
        seed = whole("seed", seed, 0, 2**63 - 1)
        total = 0.0
        for episode in range(episodes):
            observation = boundary.reset(env, seed=seed if episode == 0 else None)
            over = False
            while not over:
                action = self.act(observation, policy)
                observation, reward, terminated, truncated = boundary.step(env, action)
                total += reward
                over = terminated or truncated
        return total / episodes

    def text(self) -> str:
        """Return the tree as text, with tests in words of the environment's space.

        Returns
        -------
        str
        """
        text = self.small.text() if self.small else self.agent.print("text")
        return self.encoder.explain(text) if self.encoder else text

    def __repr__(self) -> str:
        """Describe the run."""
        return f"<rlvc.Run: {self.agent!r}>"
