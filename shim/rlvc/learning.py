# SPDX-License-Identifier: MIT
"""Learning from Gymnasium environments, and what comes out of it."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _lib
from .agent import Agent
from .batch import Batch
from .config import Config
from .domain import Bits, Domain, Thresholds
from .encode import Encoder
from .errors import ConfigError, SpaceError
from .policy import Policy
from .results import CHOICE, Choice
from .trials import SmallPolicy, Trials, shrink

if TYPE_CHECKING:
    import gymnasium

_CAPACITY_MAX = 1_000_000
_LEAVES = 12  # of a policy on trial
_RANDOM_AT_FIRST = 1000  # interactions before the first trial
_LAST = 0.25  # share of the interactions that choose among the policies tried before
# With trials, of a class that is tested. What is felt only seldom, as the end of the track, is not seen
# in fewer, and the classes are used up by what is felt always.
_MIN_SAMPLES = 64


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
        text = self.small.text() if self.small else self.agent.print("text")
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


def packed(encoder: Any, observations: Any, domain: Domain) -> npt.NDArray[Any]:
    """Encode observations as an array of percepts, as :meth:`rlvc.Agent.observe_many` takes it.

    Parameters
    ----------
    encoder : object
    observations : iterable
    domain : Domain

    Returns
    -------
    ndarray, [n, *percept_shape]
    """
    joined = b"".join(encoder.encode(observation) for observation in observations)
    return np.frombuffer(joined, domain.percept_dtype).reshape(-1, *domain.percept_shape)


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


def _store(run: Run, percepts: Any, transition: tuple[Any, ...], choices: npt.NDArray[Any]) -> None:
    _, _, rewards, reached, terminated, truncated = transition
    run.agent.observe_many(
        percepts,
        choices,
        np.asarray(rewards, np.float32),
        packed(run.encoder, reached, run.agent.domain),
        ends_of(terminated, truncated),
        resume=True,
    )


def _fill(run: Run, batch: Batch, transition: tuple[Any, ...]) -> int:
    """Write what came of a vector's step into its arrays; how many interactions that is."""
    _, _, rewards, reached, terminated, truncated = transition
    count = len(reached)
    batch.rewards[:count] = rewards
    batch.next_percepts[:count] = packed(run.encoder, reached, run.agent.domain)
    batch.ends[:count] = ends_of(terminated, truncated)
    return count


def _collect(run: Run, learner: _Learner) -> Iterator[None]:
    """Interact; yields whenever a learning step is due."""
    stream, agent = learner.stream, run.agent
    batch = agent.batch(stream.count)
    while learner.done < learner.interactions:
        before = learner.done
        live = np.flatnonzero(~stream.dead)
        everyone = stream.split(stream.current)
        percepts = packed(run.encoder, [everyone[i] for i in live], agent.domain)
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
            _store(run, percepts, transition, choices)
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


def default_config(actions: int, interactions: int, seed: int, changes: dict[str, Any]) -> Config:
    """Give the config of :func:`learn`: that of an agent, with room for all interactions.

    Parameters
    ----------
    actions, interactions, seed : int
    changes : dict
        Fields that the caller chose.

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
    leaves: int | None = None,
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
        an :class:`~rlvc.encode.Encoder` for the environment's space.
    every : int or None
        Interactions from one learning step to the next. None: a hundredth of all, at least 100.
    seed : int or None
        Of the environment and of all choices: the same seed gives the same tree. None: any.
    thresholds : int
        For each element of a Box, at most so many cutpoints are looked at in a class; 0: all there are.
    leaves : int or None
        Learn by trials (:mod:`rlvc.trials`): what acts is a policy of at most so many leaves, made of
        the agent's values, and the one that earned most is kept. A learning step comes after each
        trial, and not ``every`` so many interactions; after a random beginning (1000 interactions, or
        a tenth of all) nothing explores but the trials. In the last quarter nothing is learnt; in each
        episode the best so far acts, so that what was good by luck is found out. 0: no trials. None: 12
        where percepts are real numbers and there is one environment, else 0. Trials need both, and are
        not for the criterion of returns.
    progress : bool
        Whether to show a progress bar, with classes, return and refinements.
    callback : callable or None
        Called with the run after each learning step, and each episode of the last quarter where
        learning is by trials; if it returns True, learning ends.
    **config
        Fields of :class:`Config`. Unlike its defaults, ``capacity`` holds all interactions (at most a
        million), ``classes`` is 512, ``discount`` 0.99, ``tolerance`` 0.001 and, with trials,
        ``min_samples`` 64. Where the world changes, a smaller ``capacity`` forgets sooner what was.

    Returns
    -------
    Run

    Raises
    ------
    SpaceError
        The actions are not Discrete, or the observations cannot be encoded.
    ConfigError
        A field of the config, ``interactions``, ``every`` or ``leaves`` is out of range.

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
    if encoder is None:
        encoder = Encoder(stream.observation_space, thresholds)
    domain = domain_of(encoder)
    able = isinstance(domain, Thresholds) and not stream.vector
    able = able and config.get("criterion") != "returns"
    if leaves is None:
        leaves = _LEAVES if able else 0
    if leaves < 0 or (leaves > 0 and not able):
        raise ConfigError(
            "leaves: trials need one environment, percepts that are real numbers, and not the criterion "
            "of returns"
        )
    if leaves > 0:
        config = {"min_samples": _MIN_SAMPLES} | config
    settings = default_config(stream.actions, interactions, seed % 2**32, config)
    run = Run(Agent(domain, settings), encoder, seed, stream.start)
    bar = _bar(interactions, progress)
    try:
        if leaves > 0:
            _learn_by_trials(run, learner, leaves, bar, callback)
        else:
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


def _shrunk(agent: Agent, percepts: npt.NDArray[Any], leaves: int) -> SmallPolicy:
    """A small policy by the agent's values; what was not tried in a class is worth the least there."""
    tried = agent.samples > 0
    least = np.min(agent.q, axis=1, where=tried, initial=np.inf, keepdims=True)
    values = np.where(tried, agent.q, np.where(np.isinf(least), 0.0, least))
    return shrink(percepts, values[agent.predict(percepts).class_id], leaves)


def _learn_by_trials(
    run: Run,
    learner: _Learner,
    leaves: int,
    bar: Any,
    callback: Callable[[Run], object] | None,
) -> None:
    """Let small policies act, and learn after each trial of one; then choose among them."""
    stream, agent, trials = learner.stream, run.agent, Trials()
    random = np.random.default_rng([run.seed, 2])
    percepts = np.empty((learner.interactions, *agent.domain.percept_shape), np.float32)
    at_first = max(1, min(_RANDOM_AT_FIRST, learner.interactions // 10))
    at_last = learner.interactions * (1 - _LAST)
    here = packed(run.encoder, [stream.current], agent.domain)[0]
    agent.begin(here)
    gained, since = 0.0, 0
    while learner.done < learner.interactions:
        percepts[learner.done] = here
        policy = trials.policy
        action = int(random.integers(stream.actions)) if policy is None else policy.act(here)
        _, _, rewards, reached, terminated, truncated = learner.transition(np.array([action]))
        here = packed(run.encoder, reached, agent.domain)[0]
        ends = {"terminated": bool(terminated[0]), "truncated": bool(truncated[0])}
        agent.observe(Choice(action, policy is not None), float(rewards[0]), here, **ends)
        gained += float(rewards[0])
        over = terminated[0] or truncated[0]
        if over:
            here = packed(run.encoder, [stream.current], agent.domain)[0]
            agent.begin(here)
        if not over and learner.done - since < at_first:
            continue
        due = learner.done >= at_first if policy is None else trials.end_episode(gained)
        gained, since = 0.0, learner.done
        splits = 0
        if policy is not None and learner.done >= at_last:
            trials.resume()
        elif due:
            splits = agent.learn().splits
            trials.start(_shrunk(agent, percepts[: learner.done], leaves))
        else:
            continue
        run.small = trials.best or trials.policy
        _note(run, learner, splits, bar)
        if callback is not None and callback(run) is True:
            return
