# SPDX-License-Identifier: MIT
"""The result of learning: :class:`Run`."""

from __future__ import annotations

import dataclasses
import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from .. import _native
from ..agent.agent import Agent
from ..agent.planned_policy import PlannedPolicy
from ..agent.planner import Planner
from ..agent.policy import Policy
from ..agent.results import PlannerStatistics
from ..checks import one_of, pickled
from ..errors import PerceptError, RunError
from ..files import replace
from ..words import explain
from . import explanation
from .actions import Actions
from .encode import Encoder
from .evaluation import Evaluation, evaluate
from .explanation import Explanation, Seen
from .masks import at_hand as masks_at_hand
from .masks import best_allowed

if TYPE_CHECKING:
    import gymnasium

_VERDICTS = {
    "learnt": "",
    "no_episode": "nothing was learnt: no episode ended",
    "no_difference": "nothing was learnt: all episodes had the same return",
    "no_model": "perhaps nothing was learnt: the model of the world does not predict returns",
}


_UNSOLVED = {
    "cut short": "the values have not converged: raise max_sweeps, or lower the discount",
    "endless": "from some classes no end of the episode is known, and the discount is 1: their values"
    " are a bound",
}


_UNREWARDED = (
    "no reward other than 0 was seen, so that all actions are worth the same: give more interactions, "
    "or explore more (epsilon)"
)


def _warning(statistics: PlannerStatistics) -> str:
    """Why a planner has learnt nothing; empty if it has learnt something."""
    if statistics.episodes == 1 and statistics.verdict == "no_difference":
        return "nothing was learnt: only one episode ended"
    if statistics.episodes > 0 and statistics.fits == 0:
        return "nothing was learnt: too few interactions for a model of the world"
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
    """The result of :func:`rlvc.learn` or :func:`rlvc.learn_from`: a policy and all that made it.

    What is printed, drawn, explained, exported and saved is the policy that acts.

    Attributes
    ----------
    learner : Agent, Planner or PlannedPolicy
        What learnt: a planner on real numbers, else an agent; a policy by itself acts, but does not
        learn on.
    encoder : Encoder or None
        None if there are no observations, only percepts.
    actions : Actions
        The actions of the environment, by their numbers in the tree.
    history : list of Record
        One record for each learning step; of a planner one for each episode.
    seed : int
    interrupted : bool
        Whether Ctrl-C ended learning.
    masked : bool
        Whether the environment forbade actions by an ``action_mask`` while learning. Where such a run
        acts without one, it gives a :class:`~rlvc.errors.MaskWarning`, once.
    small : Policy or None
        What :meth:`compact` made; it acts instead of the learner.
    seen : Seen
        Some of the percepts, for :meth:`importances`.
    """

    def __init__(
        self,
        learner: Agent | Planner | PlannedPolicy,
        encoder: Encoder | None,
        seed: int,
        actions: Actions,
    ) -> None:
        self.learner = learner
        self._kept: tuple[int, str] | None = None  # of a copy: interactions and warning
        self.encoder = encoder
        self.seed = seed
        self.actions = actions
        self.history: list[Record] = []
        self.interrupted = False
        self.masked = False
        self.told_of_masks = False
        self.small: Policy | None = None
        self.seen = Seen()
        self.compaction: dict[str, Any] | None = None  # the arguments of compact()
        self._tables: tuple[int, Any, Any] | None = None

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
    def acting(self) -> Agent | Planner | Policy:
        """What acts: the compact policy if there is one, else the learner."""
        return self.learner if self.small is None else self.small

    @property
    def leaves(self) -> int:
        """Leaves of the tree that acts: of an agent its classes."""
        acting = self.acting
        if isinstance(acting, Policy):
            return acting.info.leaves
        return acting.classes if isinstance(acting, Agent) else acting.statistics.leaves

    @property
    def interactions(self) -> int:
        """Number that was learnt from."""
        if isinstance(self.learner, PlannedPolicy):
            return self._kept[0] if self._kept else 0
        return self.learner.statistics.interactions

    @property
    def warning(self) -> str:
        """Why nothing was learnt, or why the values are not to be trusted, in one line; else empty."""
        if isinstance(self.learner, Planner):
            return _warning(self.learner.statistics)
        if isinstance(self.learner, PlannedPolicy):
            return self._kept[1] if self._kept else ""
        if self.learner.statistics.solution != "converged":
            return _UNSOLVED[self.learner.statistics.solution]
        if self.learner.classes > 1:
            return "" if self.learner.values.any() else _UNREWARDED
        if self.interrupted and self.learner.statistics.step == 0:
            return "nothing was learnt: the first learning step was not reached: give a smaller every"
        return "one class: no difference in rewards or in what follows was found"

    # -------------------------------------------------------------- acting

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

    def percepts(self, observations: Any) -> npt.NDArray[Any]:
        """Encode a batch of observations: ndarray, [n, *percept_shape]."""
        if isinstance(self.encoder, Encoder):
            rows = self.encoder.encode_many(observations)
        elif self.encoder is not None:
            domain = self.learner.domain
            flat = b"".join(self.encoder.encode(observation) for observation in observations)
            rows = np.frombuffer(flat, domain.percept_dtype).reshape(-1, *domain.percept_shape)
        else:
            rows = np.asarray(observations)
        if isinstance(self.learner, Agent):
            return rows
        most = np.float32(_native.PLANNER_NUMBER_MAX)
        return np.ascontiguousarray(rows.clip(-most, most), np.float32)

    def index(self, percept: Any) -> int:
        """Return the number of the action at a percept."""
        acting = self.acting
        if isinstance(acting, Agent):
            return int(acting.predict(percept).action)
        return int(acting.act(percept) if isinstance(acting, Policy) else acting.predict(percept))

    def indices(self, percepts: npt.NDArray[Any]) -> npt.NDArray[np.uint32]:
        """Return the numbers of the actions at percepts [n, *percept_shape]."""
        acting = self.acting
        if isinstance(acting, Agent):
            return np.asarray(acting.predict(percepts).action)
        found = acting.act(percepts) if isinstance(acting, Policy) else acting.predict(percepts)
        return np.asarray(found)

    def predict(self, observation: Any, action_masks: Any = None) -> Any:
        """Return the action of the learnt policy at an observation, or at each of a batch.

        Parameters
        ----------
        observation : element of the environment's space, or arrays of n of them
            A batch is what a vector environment returns: arrays [n, ...], in dicts or tuples; of a
            log's columns a table, or rows.
        action_masks : array of truth values, [actions], for a batch [n, actions], or None
            The actions that are allowed: the best of them is taken. None: the ``action_mask`` in the
            observation, if there is one, else all.

        Returns
        -------
        int or ndarray, or ndarray [n, ...] of them
            Elements of the environment's action space.

        Raises
        ------
        PerceptError
            It is not an element of the space, or contains NaN.
        ConfigError
            ``action_masks`` has another shape.

        Warns
        -----
        MaskWarning
            The run learnt with masks, and there is none.
        """
        try:
            if self._is_batch(observation):
                percepts = self.percepts(observation)
                chosen = self.indices(percepts)
                masks = masks_at_hand(self, observation, action_masks, len(percepts))
                for i, mask in enumerate(() if masks is None else masks):
                    chosen[i] = best_allowed(self, percepts[i], int(chosen[i]), mask)
                return self.actions.of_many(chosen)
            return self.act(observation, action_masks)
        except PerceptError:
            if isinstance(observation, tuple) and observation and isinstance(observation[-1], dict):
                raise PerceptError(
                    "observation: a pair (observation, info), as reset() returns: pass the first"
                ) from None
            raise

    def _is_batch(self, observation: Any) -> bool:
        if self.encoder is None:
            return np.ndim(observation) > len(self.learner.domain.percept_shape)
        return isinstance(self.encoder, Encoder) and self.encoder.is_batch(observation)

    def act(self, observation: Any, action_masks: Any = None) -> Any:
        """Return the action at one observation: as :meth:`predict`, which also takes batches.

        Parameters
        ----------
        observation : element of the environment's space
        action_masks : array of truth values, [actions], or None

        Returns
        -------
        int or ndarray
        """
        percept = self.percept(observation)
        chosen = self.index(percept)
        masks = masks_at_hand(self, observation, action_masks, 1)
        if masks is not None:
            chosen = best_allowed(self, percept, chosen, masks[0])
        return self.actions.of(chosen)

    def tables(self) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.uint32]]:
        """Return Q and the number of samples of each class and action of an agent."""
        step = self.agent.statistics.step
        if self._tables is None or self._tables[0] != step:
            self._tables = (step, self.agent.q, self.agent.samples)
        return self._tables[1:]

    def evaluate(
        self,
        env: gymnasium.Env[Any, Any] | gymnasium.vector.VectorEnv[Any, Any, Any],
        episodes: int = 100,
        seed: int = 0,
        max_steps: int = 100_000,
    ) -> Evaluation:
        """Play episodes with the learnt policy, without exploring.

        Parameters
        ----------
        env : gymnasium.Env or gymnasium.vector.VectorEnv
            With the observations that the run learnt, and its actions, perhaps among others. Of a
            vector, each environment plays its share of the episodes.
        episodes : int
        seed : int
            Seed of the first reset.
        max_steps : int
            An episode is cut off after so many decisions: a policy may go in circles for ever where
            the environment has no limit of time. Of a vector, an environment whose episode is cut
            off plays no more.

        Returns
        -------
        Evaluation
            Its ``mean``, ``std``, ``returns`` and ``lengths``, and how many episodes were ``cut``.

        Raises
        ------
        ConfigError
            ``episodes`` or ``max_steps`` is not at least 1, or ``seed`` not at least 0; or the
            run's actions or observations are not the environment's.
        EnvError, RewardError, PerceptError
            The environment returned something else than Gymnasium's interface says. The message
            names the episode and its step, both from 0 on; of a vector, how many episodes had ended
            and the vector's step.

        Notes
        -----
        Each action is held as in learning. Where the environment's info or observation has an
        ``action_mask``, only actions that it allows are taken.
        """
        return evaluate(self, env, episodes, seed, max_steps)

    # -------------------------------------------------------------- going on

    def learn(self, env: Any, interactions: int, **arguments: Any) -> Run:
        """Learn on: as :func:`rlvc.learn` with ``run=self``.

        Parameters
        ----------
        env : gymnasium.Env or gymnasium.vector.VectorEnv
        interactions : int
            How many more.
        **arguments
            ``every``, ``seed``, ``progress`` and ``callback`` of :func:`rlvc.learn`.

        Returns
        -------
        Run
            This one.
        """
        from .learn import learn

        return learn(env, interactions, run=self, **arguments)

    def compact(self, tolerance: float | None = None, **limits: Any) -> Run:
        """Let the smallest policy act that acts as well on all percepts in the replay buffer.

        Parameters
        ----------
        tolerance : float or None
        **limits
            As of :meth:`rlvc.Agent.compact`.

        Returns
        -------
        Run
            This one. Its ``small`` is the policy; learning on removes it. A planner's policy is small
            already.
        """
        if isinstance(self.learner, Agent):
            self.small = self._seeing().compact(tolerance, **limits)
            self.compaction = {"tolerance": tolerance, **limits}
        return self

    def _seeing(self) -> Agent:
        """The agent that holds the percepts at which a small policy must act as well."""
        return self.agent

    def policy(self) -> Policy:
        """Make a policy by itself: that of the planner, or the agent's ``compact()``.

        Returns
        -------
        Policy
        """
        acting = self.acting
        if isinstance(acting, Policy):
            return acting
        return acting.policy() if isinstance(acting, Planner) else self._seeing().compact()

    def save(self, file: str | Path) -> None:
        """Write the run to a file: :func:`rlvc.load` reads it.

        Parameters
        ----------
        file : str or Path

        Raises
        ------
        StoreError
            The file cannot be written, or is a link, a folder, a FIFO or a device.

        Notes
        -----
        The learner, the encoder, the actions and the history are in the file, bit for bit; of an
        encoder of the caller's own class only that there is one. A failure leaves the old file.
        """
        from .store import write

        write(self, file)

    # -------------------------------------------------------------- showing

    def in_words(self, text: str) -> str:
        """Replace the numbers of bits, components and actions in a text by their names."""
        if self.encoder is not None and hasattr(self.encoder, "explain"):
            text = self.encoder.explain(text)
        return self._in_actions(text)

    def _in_actions(self, text: str) -> str:
        if self.actions.plain():
            return text
        return re.sub(r"\baction (\d+)\b", lambda match: self.actions.name(int(match[1])), text)

    @property
    def tree(self) -> dict[str, Any]:
        """The tree that acts, as data; ``core/SPEC.md`` ("JSON of the tree") describes it."""
        tree: dict[str, Any] = json.loads(self.acting.print("json"))
        return tree

    def text(self, form: Literal["text", "dot"] = "text") -> str:
        """Return the tree, with tests and actions in words of the environment's spaces.

        Parameters
        ----------
        form : {"text", "dot"}

        Returns
        -------
        str
            If nothing was learnt, the last line of a text is the :attr:`warning`.
        """
        text = self.acting.print(form)
        if form == "dot" and type(self.encoder) is Encoder:  # words of a log are in quotes
            names = [name.replace('"', '\\"') for name in self.encoder.names]
            text = self._in_actions(explain(text, names, self.encoder.flags))
        else:
            text = self.in_words(text)
        return f"{text}{self.warning}\n" if self.warning and form == "text" else text

    def explain(self, observation: Any) -> Explanation:
        """Say why the policy acts as it does at an observation.

        Parameters
        ----------
        observation : element of the environment's space

        Returns
        -------
        Explanation
            The path through the tree, test by test, with the values; print it.
        """
        return explanation.explain(self, observation)

    def importances(self) -> dict[str, float]:
        """Measure how much each number of an observation matters to the policy.

        Returns
        -------
        dict
            For each name, the largest first, in how many of a thousand percepts that were seen the
            action becomes another if this number is taken from another percept: a share in [0, 1].
        """
        return explanation.importances(self)

    def export_c(self, file: str | Path | None = None, name: str = "policy") -> str:
        """Write the policy as a C99 header for a controller.

        Parameters
        ----------
        file : str, Path or None
            None: it is only returned.
        name : str
            A C identifier of at most 48 characters. The header defines ``NAME_act(percept)``, and a
            table ``NAME_actions`` if actions are no plain numbers from 0 on.

        Returns
        -------
        str
            The text of the header.

        Notes
        -----
        Compiled with ``-ffp-contract=off``, it acts as :meth:`predict`, bit for bit;
        :meth:`rlvc.Agent.export_c` says what a percept is in C.
        """
        from .export import header

        text = header(self, name)
        if file is not None:
            replace(file, text.encode())
        return text

    def plot(self, kind: str = "tree", file: str | Path | None = None, **arguments: Any) -> Any:
        """Draw the run: see :mod:`rlvc.plot`.

        Parameters
        ----------
        kind : str
            One of ``rlvc.plot.KINDS``.
        file : str, Path or None
            Where to save the figure.
        **arguments
            Of the function.

        Returns
        -------
        matplotlib.figure.Figure, or graphviz.Digraph of a tree
        """
        from .. import plot

        return plot.KINDS[one_of("kind", kind, plot.KINDS, RunError)](self, file, **arguments)

    def _repr_html_(self) -> str:
        """Show the tree in a notebook: as a picture, or as text where Graphviz is missing."""
        import html

        try:
            picture: str = self.plot("tree").pipe(format="svg").decode()
            return picture[picture.index("<svg") :]
        except (ImportError, OSError, RuntimeError):
            return f"<pre>{html.escape(self.text())}</pre>"

    # -------------------------------------------------------------- copies

    def __getstate__(self) -> dict[str, Any]:
        """Pickle what :meth:`save` writes, and an encoder by the caller."""
        from .store import packed

        own = None if type(self.encoder) is Encoder else self.encoder
        return {"content": packed(self), "encoder": own, "domain": self.learner.domain}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Make it again."""
        from .store import unpacked

        made = unpacked(*pickled(state, "content", "encoder", "domain"))
        self.__dict__ |= made.__dict__

    def __repr__(self) -> str:
        """Describe the run."""
        return f"<rlvc.Run: {self.acting!r}>"
