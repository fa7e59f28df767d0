# SPDX-License-Identifier: MIT
"""The result of learning."""

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
        k of the step.
    interactions : int
        So far.
    classes : int
        After it.
    splits : int
        Made in it.
    episodes : int
        Ended since the step before.
    mean_return : float
        Their mean undiscounted return, exploration included; NaN if there are none.
    """

    step: int
    interactions: int
    classes: int
    splits: int
    episodes: int
    mean_return: float


class Run:
    """What :func:`learn` or :func:`learn_from` made.

    Attributes
    ----------
    agent : Agent
    encoder : Encoder or None
        None if percepts are the agent's own.
    history : list of Record
        One a learning step; where trials are over and a policy is chosen, one an episode.
    seed : int
    interrupted : bool
        Whether Ctrl-C ended it early.
    small : SmallPolicy or None
        Where learning was by trials, the policy of few leaves that did best: it is what acts, while
        the agent's tree is what it was made from.
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
        """Give the learnt policy's action.

        Parameters
        ----------
        observation : element of the environment's space
        policy : Policy or None
            What ``run.agent.compact()`` made, to be asked instead.

        Returns
        -------
        int
            In the environment's space: ``Discrete.start`` is added.
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
        """Play with the learnt policy.

        Parameters
        ----------
        env : gymnasium.Env
        episodes : int
        seed : int
            Of the first reset.
        policy : Policy or None
            What ``run.agent.compact()`` made, to be played with instead.

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
        """Print the tree, its tests in words of the environment's space.

        Returns
        -------
        str
        """
        text = self.small.text() if self.small else self.agent.print("text")
        return self.encoder.explain(text) if self.encoder else text

    def __repr__(self) -> str:
        """Say what it is."""
        return f"<rlvc.Run: {self.agent!r}>"
