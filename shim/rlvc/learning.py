# SPDX-License-Identifier: MIT
"""Learning from Gymnasium environments, and what comes out of it."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from . import _lib
from .agent import Agent
from .batch import Batch
from .config import Config
from .domain import Bits, Domain
from .encode import Encoder, needs_samples
from .errors import ConfigError, SpaceError
from .policy import Policy
from .results import CHOICE

if TYPE_CHECKING:
    import gymnasium

_WARM_UP = 1000  # observations from which a Box gets its thresholds
_CAPACITY_MAX = 1_000_000


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
        One a learning step.
    seed : int
    interrupted : bool
        Whether Ctrl-C ended it early.
    """

    def __init__(self, agent: Agent, encoder: Encoder | None, seed: int, start: int = 0) -> None:
        self.agent = agent
        self.encoder = encoder
        self.seed = seed
        self.history: list[Record] = []
        self.interrupted = False
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
        action = self.agent.predict(percept).action if policy is None else policy.act(percept)
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
        """
        total = 0.0
        for episode in range(episodes):
            observation, _ = env.reset(seed=seed if episode == 0 else None)
            over = False
            while not over:
                observation, reward, terminated, truncated, _ = env.step(
                    self.act(observation, policy)
                )
                total += float(reward)
                over = terminated or truncated
        return total / episodes

    def text(self) -> str:
        """Print the tree, its tests in words of the environment's space.

        Returns
        -------
        str
        """
        text = self.agent.print("text")
        return self.encoder.explain(text) if self.encoder else text

    def __repr__(self) -> str:
        """Say what it is."""
        return f"<rlvc.Run: {self.agent!r}>"


def _actions(space: Any) -> tuple[int, int]:
    """How many actions there are, and the number of the first."""
    from gymnasium import spaces

    if not isinstance(space, spaces.Discrete):
        raise SpaceError(f"an agent has a finite set of actions, and not {space}")
    if not 1 <= space.n <= 255:
        raise SpaceError(f"an agent has at most 255 actions, and {space} has {space.n}")
    return int(space.n), int(space.start)


class _Stream:
    """One environment, or a vector of them, as batches of live transitions."""

    def __init__(self, env: Any, seed: int) -> None:
        self.env = env
        self.count = int(getattr(env, "num_envs", 0))
        self.vector = self.count > 0
        self.count = max(self.count, 1)
        self.observation_space = (
            env.single_observation_space if self.vector else env.observation_space
        )
        self.action_space = env.single_action_space if self.vector else env.action_space
        self.actions, self.start = _actions(self.action_space)
        mode = str(env.metadata.get("autoreset_mode", "")) if self.vector else ""
        self.same_step = "SAME" in mode.upper()
        self.manual = "DISABLED" in mode.upper()
        self.current, _ = env.reset(seed=seed)
        self.dead = np.zeros(self.count, np.bool_)

    def split(self, batch: Any) -> list[Any]:
        """The observations of a batch, one by one."""
        if not self.vector:
            return [batch]
        from gymnasium.vector.utils import iterate

        return list(iterate(self.env.observation_space, batch))

    def step(self, actions: npt.NDArray[Any]) -> tuple[list[Any], Any, Any, Any]:
        """Act in every environment: s', rewards, terminated, truncated of each.

        Those that were dead before, whose step only reset them, are to be left out by the caller.
        """
        actions = actions.astype(np.int64) + self.start
        if not self.vector:
            following, reward, terminated, truncated, _ = self.env.step(int(actions[0]))
            reached = [following]
            self.current = self.env.reset()[0] if terminated or truncated else following
            return reached, np.array([reward]), np.array([terminated]), np.array([truncated])
        following, rewards, terminated, truncated, info = self.env.step(actions)
        over = terminated | truncated
        reached = self.split(following)
        if self.same_step and over.any():
            for i in np.flatnonzero(over):
                reached[i] = info["final_obs"][i]
        elif self.manual and over.any():
            following, _ = self.env.reset(options={"reset_mask": over})
        elif not self.same_step:
            self.dead = over
        self.current = following
        return reached, rewards, terminated, truncated


class _Learner:
    """The loop of section 4.2.1 around an environment."""

    def __init__(self, stream: _Stream, interactions: int, every: int) -> None:
        self.stream = stream
        self.interactions = interactions
        self.every = every
        self.done = 0
        self.sums = np.zeros(stream.count)
        self.returns: list[float] = []  # of the episodes ended since the last learning step

    def warm_up(self, count: int, random: np.random.Generator) -> list[tuple[Any, ...]]:
        """Walk at random, before there are percepts: (s, actions, r, s', terminated, truncated)."""
        walked = []
        while self.done < count:
            actions = random.integers(self.stream.actions, size=self.stream.count)
            walked.append(self.transition(actions))
        return walked

    def transition(self, actions: Any) -> tuple[Any, ...]:
        """Act, and leave out what is dead or too much."""
        stream = self.stream
        before = stream.split(stream.current)
        live = np.flatnonzero(~stream.dead)[: self.interactions - self.done]
        reached, rewards, terminated, truncated = stream.step(np.asarray(actions))
        self.sums[live] += rewards[live]
        for i in live[(terminated | truncated)[live]]:
            self.returns.append(float(self.sums[i]))
            self.sums[i] = 0.0
        self.done += len(live)
        return (
            [before[i] for i in live],
            np.asarray(actions)[live],
            rewards[live],
            [reached[i] for i in live],
            terminated[live],
            truncated[live],
        )

    def due(self, before: int) -> bool:
        return self.done // self.every > before // self.every or self.done >= self.interactions


def _packed(encoder: Any, observations: list[Any], size: int) -> npt.NDArray[np.uint8]:
    joined = b"".join(encoder.encode(observation) for observation in observations)
    return np.frombuffer(joined, np.uint8).reshape(len(observations), size)


def ends_of(terminated: Any, truncated: Any) -> npt.NDArray[np.uint8]:
    """Give how interactions ended, as :meth:`rlvc.Agent.observe_many` takes it.

    Parameters
    ----------
    terminated, truncated : array of bool, [n]

    Returns
    -------
    ndarray of uint8, [n]
    """
    return np.where(terminated, _lib.TERMINATED, np.where(truncated, _lib.TRUNCATED, 0)).astype(
        np.uint8
    )


def _store(
    run: Run, percepts: Any, transition: tuple[Any, ...], choices: npt.NDArray[Any], resume: bool
) -> None:
    _, _, rewards, reached, terminated, truncated = transition
    run.agent.observe_many(
        percepts,
        choices,
        np.asarray(rewards, np.float32),
        _packed(run.encoder, reached, run.agent.domain.percept_bytes),
        ends_of(terminated, truncated),
        resume,
    )


def _fill(run: Run, batch: Batch, transition: tuple[Any, ...]) -> int:
    """Write what came of a vector's step into its arrays; how many interactions that is."""
    _, _, rewards, reached, terminated, truncated = transition
    count = len(reached)
    batch.rewards[:count] = rewards
    batch.next_percepts[:count] = _packed(run.encoder, reached, run.agent.domain.percept_bytes)
    batch.ends[:count] = ends_of(terminated, truncated)
    return count


def _collect(run: Run, learner: _Learner) -> Iterator[None]:
    """Interact; yields whenever a learning step is due."""
    stream, agent = learner.stream, run.agent
    size = agent.domain.percept_bytes
    batch = agent.batch(stream.count)
    while learner.done < learner.interactions:
        before = learner.done
        live = np.flatnonzero(~stream.dead)
        everyone = stream.split(stream.current)
        percepts = _packed(run.encoder, [everyone[i] for i in live], size)
        if stream.vector:
            batch.percepts[: len(live)] = percepts
            choices = batch.act(len(live))
        else:
            choices = np.array([agent.act()], CHOICE)
        actions = np.zeros(stream.count, np.int64)
        actions[live] = choices["action"]
        transition = learner.transition(actions)
        if stream.vector:
            batch.observe(_fill(run, batch, transition))
        else:
            _store(run, percepts, transition, choices, resume=True)
            if transition[4][0] or transition[5][0]:
                agent.begin(run.encoder.encode(stream.current))  # type: ignore[union-attr]
        if learner.due(before):
            yield


def _bar(total: int, wanted: bool) -> Any:
    if not wanted:
        return None
    try:
        from tqdm import tqdm
    except ImportError:
        raise ImportError("a progress bar needs tqdm: pip install 'rlvc[gym]'") from None
    return tqdm(total=total, unit=" interactions")


def _note(run: Run, learner: _Learner, splits: int, bar: Any) -> None:
    statistics = run.agent.statistics
    mean = float(np.mean(learner.returns)) if learner.returns else float("nan")
    run.history.append(
        Record(
            statistics.step, learner.done, statistics.classes, splits, len(learner.returns), mean
        )
    )
    learner.returns = []
    if bar is not None:
        bar.update(learner.done - bar.n)
        bar.set_postfix({"classes": statistics.classes, "return": f"{mean:.3g}", "splits": splits})


def domain_of(encoder: Any) -> Domain:
    """Give the domain of an encoder's percepts: its own, or that of bits.

    Parameters
    ----------
    encoder : object

    Returns
    -------
    Domain
    """
    domain = getattr(encoder, "domain", None)
    return domain if isinstance(domain, Domain) else Bits(encoder.bits)


def default_config(
    actions: int, interactions: int, seed: int, changes: dict[str, Any], real: bool
) -> Config:
    """Give the config of :func:`learn`: that of an agent, with room for all interactions.

    Parameters
    ----------
    actions, interactions, seed : int
    changes : dict
        Fields that the caller chose.
    real : bool
        Whether percepts hold thresholds of real numbers: what these foretell of each other never ends,
        so that ``successors`` is off.

    Returns
    -------
    Config
    """
    fields: dict[str, Any] = {
        "capacity": min(2 * interactions, _CAPACITY_MAX),
        "classes": 512,
        "seed": seed,
        "discount": 0.99,
        "tolerance": 0.001,
    }
    if changes.get("criterion") == "returns":
        fields |= {"epsilon": 0.8, "alpha_known": 0.0001, "explore": "uniform"}
    if real:
        fields["successors"] = False
    try:
        return Config(actions, **(fields | changes))
    except TypeError as error:
        raise ConfigError(f"no such field: {error}") from None


def learn(
    env: gymnasium.Env[Any, Any] | gymnasium.vector.VectorEnv[Any, Any, Any],
    interactions: int,
    *,
    encoder: Encoder | None = None,
    every: int | None = None,
    seed: int | None = None,
    thresholds: int = 15,
    progress: bool = False,
    callback: Callable[[Run], object] | None = None,
    **config: Any,
) -> Run:
    """Learn from an environment: the loop of section 4.2.1.

    Parameters
    ----------
    env : gymnasium.Env or gymnasium.vector.VectorEnv
        Its actions are Discrete. What its observations may be, :mod:`rlvc.encode` says.
    interactions : int
        How many to have.
    encoder : object or None
        Turns observations into percepts: it has ``encode(observation) -> bytes`` and ``bits``, or the
        ``domain`` that the percepts are of, as :class:`rlvc.vision.Eye` has. None:
        an :class:`~rlvc.encode.Encoder` for the environment's space; where that has a Box, the first
        interactions (at most 1000, and a tenth of all) are a random walk that finds the thresholds.
    every : int or None
        Interactions from one learning step to the next. None: a hundredth of all, at least 100.
    seed : int or None
        Of the environment and of all choices: the same seed gives the same tree. None: any.
    thresholds : int
        For each element of a Box, at most.
    progress : bool
        Whether to show a progress bar, with classes, return and refinements.
    callback : callable or None
        Called with the run after each learning step; if it returns True, learning ends.
    **config
        Fields of :class:`Config`. Unlike its defaults, ``capacity`` holds all interactions (at most a
        million), ``classes`` is 512, ``discount`` 0.99 and ``tolerance`` 0.001.

    Returns
    -------
    Run

    Raises
    ------
    SpaceError
        The actions are not Discrete, or the observations cannot be encoded.
    ConfigError
        A field of the config, ``interactions`` or ``every`` is out of range.

    Notes
    -----
    Ctrl-C ends learning; the run so far is returned, and is ``interrupted``.
    """
    if interactions < 1 or (every is not None and every < 1):
        raise ConfigError("interactions and every are at least 1")
    if seed is None:
        seed = int(np.random.SeedSequence().generate_state(1)[0])
    stream = _Stream(env, seed)
    if stream.vector and config.get("criterion") == "returns":
        raise ConfigError(
            "criterion: returns need episodes in one piece, and so a single environment"
        )
    learner = _Learner(stream, interactions, every or max(100, interactions // 100))
    walked: list[tuple[Any, ...]] = []
    if encoder is None:
        samples: list[Any] = []
        if needs_samples(stream.observation_space):
            count = max(1, min(_WARM_UP, interactions // 10))
            walked = learner.warm_up(count, np.random.default_rng([seed, 2]))
            samples = [one for transition in walked for one in transition[0]]
        encoder = Encoder(stream.observation_space, samples, thresholds)
    real = getattr(encoder, "real", False)
    settings = default_config(stream.actions, interactions, seed % 2**32, config, real)
    run = Run(Agent(domain_of(encoder), settings), encoder, seed, stream.start)
    for transition in walked:
        choices = np.zeros(len(transition[1]), CHOICE)
        choices["action"] = transition[1]
        percepts = _packed(encoder, transition[0], run.agent.domain.percept_bytes)
        _store(run, percepts, transition, choices, resume=False)
    bar = _bar(interactions, progress)
    try:
        _learn(run, learner, bar, callback)
    except KeyboardInterrupt:
        run.interrupted = True
    finally:
        if bar is not None:
            bar.close()
    return run


def _learn(
    run: Run,
    learner: _Learner,
    bar: Any,
    callback: Callable[[Run], object] | None,
) -> None:
    if not learner.stream.vector:
        run.agent.begin(run.encoder.encode(learner.stream.current))  # type: ignore[union-attr]
    for _ in _collect(run, learner):
        splits = run.agent.learn().splits
        _note(run, learner, splits, bar)
        if callback is not None and callback(run) is True:
            return
