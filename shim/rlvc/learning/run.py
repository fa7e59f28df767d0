# SPDX-License-Identifier: MIT
"""The result of learning: :class:`Run`."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _native
from ..agent.agent import Agent
from ..agent.planned_policy import PlannedPolicy
from ..agent.planner import Planner
from ..agent.policy import Policy
from ..agent.results import PlannerStatistics
from ..checks import whole
from ..errors import RunError
from . import boundary
from .encode import Encoder

if TYPE_CHECKING:
    import gymnasium

_CLEARLY = 4  # standard deviations above the worst return: hardly by chance
_VERDICTS = {
    "learnt": "",
    "no_episode": "nothing was learnt: no episode ended",
    "no_difference": "nothing was learnt: all episodes had the same return",
    "no_model": "perhaps nothing was learnt: the model of the world does not predict returns",
}


def _warning(statistics: PlannerStatistics, returns: list[float]) -> str:
    """Why a planner has learnt nothing; empty if it has learnt something."""
    if statistics.episodes > 0 and statistics.fits == 0:
        return "nothing was learnt: too few interactions for a model of the world"
    # If all policies of late are good, there is nothing to predict about them.
    clearly = min(returns, default=math.nan) + _CLEARLY * statistics.deviation
    if statistics.verdict == "no_model" and statistics.score > clearly:
        return ""
    return _VERDICTS[statistics.verdict]


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
        Leaves of the tree after the step: of an agent its classes.
    splits : int
        Number made in the step; 0 of a planner.
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
    learner : Agent, Planner or PlannedPolicy
        What learnt: a planner on real numbers, else an agent. A copy of a planner's run, pickled or
        not, has only the planner's policy: it acts, but does not learn on.
    encoder : Encoder or None
        None if there are no observations, only percepts.
    history : list of Record
        One record for each learning step; of a planner one for each episode.
    seed : int
    interrupted : bool
        Whether Ctrl-C ended learning.
    """

    def __init__(
        self, learner: Agent | Planner, encoder: Encoder | None, seed: int, start: int = 0
    ) -> None:
        self.learner: Agent | Planner | PlannedPolicy = learner
        self._kept: tuple[int, str] | None = None  # of a copy: interactions and warning
        self.encoder = encoder
        self.seed = seed
        self.history: list[Record] = []
        self.interrupted = False
        self._start = start

    @property
    def agent(self) -> Agent:
        """The agent that learnt; :class:`~rlvc.errors.RunError` if a planner did."""
        if not isinstance(self.learner, Agent):
            raise RunError(
                "agent: a planner learnt: use run.planner, or learn with method='classes'"
            )
        return self.learner

    @property
    def planner(self) -> Planner:
        """The planner that learnt; :class:`~rlvc.errors.RunError` if an agent did."""
        if not isinstance(self.learner, Planner):
            raise RunError("planner: an agent learnt, or this is a copy: use run.learner")
        return self.learner

    @property
    def leaves(self) -> int:
        """Leaves of the tree that acts: of an agent its classes."""
        learner = self.learner
        if isinstance(learner, PlannedPolicy):
            return learner.info.leaves
        return learner.classes if isinstance(learner, Agent) else learner.statistics.leaves

    @property
    def interactions(self) -> int:
        """Number that was learnt from."""
        if isinstance(self.learner, PlannedPolicy):
            return self._kept[0] if self._kept else 0
        return self.learner.statistics.interactions

    @property
    def warning(self) -> str:
        """Why nothing was learnt, in one line; empty if something was."""
        if isinstance(self.learner, Planner):
            return _warning(
                self.learner.statistics, [record.mean_return for record in self.history]
            )
        if isinstance(self.learner, PlannedPolicy):
            return self._kept[1] if self._kept else ""
        if self.learner.classes > 1:
            return ""
        return "one class: no difference in rewards or in what follows was found"

    def policy(self) -> Policy:
        """Make a policy by itself, to export: that of the planner, or the agent's ``compact()``.

        Returns
        -------
        Policy
        """
        learner = self.learner
        if isinstance(learner, PlannedPolicy):
            return learner
        return learner.policy() if isinstance(learner, Planner) else learner.compact()

    def percept(self, observation: Any) -> Any:
        """Encode an observation; of a planner, numbers beyond its range are clipped.

        Parameters
        ----------
        observation : element of the environment's space

        Returns
        -------
        bytes or ndarray
            A percept that the agent or planner takes.
        """
        percept = self.encoder.encode(observation) if self.encoder else observation
        if isinstance(self.learner, Agent):
            return percept
        most = _native.PLANNER_NUMBER_MAX
        return np.frombuffer(self.learner.domain.pack(percept), np.float32).clip(-most, most)

    def act(self, observation: Any, policy: Policy | None = None) -> int:
        """Return the action of the learnt policy.

        Parameters
        ----------
        observation : element of the environment's space
        policy : Policy or None
            A result of :meth:`policy` to use instead.

        Returns
        -------
        int
            An element of the action space: ``Discrete.start`` is added.
        """
        percept = self.percept(observation)
        if policy is not None:
            action = policy.act(percept)
        elif isinstance(self.learner, PlannedPolicy):
            action = self.learner.act(percept)
        elif isinstance(self.learner, Planner):
            action = self.learner.predict(percept)
        else:
            action = self.learner.predict(percept).action
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
            A result of :meth:`policy` to use instead.

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
            If nothing was learnt, the last line is the :attr:`warning`.
        """
        text = self.learner.print("text")
        if self.encoder:
            text = self.encoder.explain(text)
        return f"{text}{self.warning}\n" if self.warning else text

    def __getstate__(self) -> dict[str, Any]:
        """Pickle the policy in place of a planner."""
        state = dict(self.__dict__)
        if isinstance(self.learner, Planner):
            state["learner"] = self.learner.policy()
            state["_kept"] = (self.interactions, self.warning)
        return state

    def __repr__(self) -> str:
        """Describe the run."""
        return f"<rlvc.Run: {self.learner!r}>"
