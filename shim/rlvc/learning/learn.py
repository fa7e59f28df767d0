# SPDX-License-Identifier: MIT
"""Learning from a Gymnasium environment: the loop of section 4.2.1."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..agent.agent import Agent
from ..agent.config import Config
from ..agent.results import Choice
from ..checks import whole
from ..domains.bits import Bits
from ..domains.domain import Domain
from ..domains.thresholds import Thresholds
from ..errors import ConfigError, Error
from .encode import Encoder
from .environment import Environment
from .interact import Interaction, collect, packed
from .run import Record, Run
from .shrink import shrink
from .small_policy import SmallPolicy
from .trials import Trials

if TYPE_CHECKING:
    import gymnasium

_CAPACITY_MAX = 1_000_000
_LEAVES = 12  # maximum number of leaves of a policy on trial
_RANDOM_AT_FIRST = 1000  # random interactions before the first trial
_LAST = 0.25  # share of the interactions, at the end, that only compare the policies tried before
# With trials: min_samples of the config. With fewer, the tree spends its classes on frequent situations
# before it sees rare ones, such as the end of a track.
_MIN_SAMPLES = 64


def _bar(total: int, wanted: bool) -> Any:
    if not wanted:
        return None
    try:
        from tqdm import tqdm
    except ImportError:
        raise ImportError("a progress bar needs tqdm: pip install 'rlvc[gym]'") from None
    return tqdm(total=total, unit=" interactions")


def _note(run: Run, learner: Interaction, splits: int, bar: Any) -> None:
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
    """Return the domain of an encoder's percepts: its ``domain``, or Bits of its ``bits``.

    Parameters
    ----------
    encoder : object

    Returns
    -------
    Domain
    """
    domain = getattr(encoder, "domain", None)
    if not callable(getattr(encoder, "encode", None)) or not (
        isinstance(domain, Domain) or hasattr(encoder, "bits")
    ):
        raise ConfigError(
            f"encoder: {type(encoder).__name__} needs encode(observation), and domain or bits"
        )
    return domain if isinstance(domain, Domain) else Bits(encoder.bits)


def default_config(actions: int, interactions: int, seed: int, changes: dict[str, Any]) -> Config:
    """Return the default config of :func:`learn`, with the caller's changes.

    Parameters
    ----------
    actions, interactions, seed : int
    changes : dict
        Fields set by the caller.

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


def _leaves(wanted: int | None, able: bool) -> int:
    """The leaves of a policy on trial; 0: no trials. `able`: whether trials are possible."""
    if wanted is None:
        return _LEAVES if able else 0
    wanted = whole("leaves", wanted, 0, 2**16)
    if wanted > 0 and not able:
        raise ConfigError(
            "leaves: trials need a single environment, percepts of real numbers, and the residual "
            "criterion"
        )
    return wanted


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
        The actions must be Discrete; :mod:`rlvc.learning.encode` lists the spaces of observations.
    interactions : int
        Number of interactions, at least 1.
    encoder : object or None
        Turns observations into percepts: it has ``encode(observation) -> bytes``, and either
        ``bits`` or the ``domain`` of the percepts, as :class:`rlvc.vision.Eye` has. None: an
        :class:`rlvc.Encoder` for the environment's space.
    every : int or None
        Interactions between two learning steps. None: a hundredth of all, at least 100.
    seed : int or None
        Seed of the environment and of the agent: the same seed gives the same tree. None: a random
        seed.
    thresholds : int
        Maximum number of cutpoints for each element of a Box in one class; 0: no limit.
    leaves : int or None
        Learn by trials (:mod:`rlvc.learning.trials`). The policies that act are small trees of at
        most this many leaves, made from the agent's values; the one with the best mean return is
        kept. A learning step follows each trial, so ``every`` is not used. The first interactions
        are random (1000, or a tenth of all), and ``epsilon`` is not used after them. In the last
        quarter the best policy so far acts and learning stops, to detect policies that were only
        lucky. 0: no trials. None: 12 if percepts are real numbers and there is a single
        environment, else 0. Trials need both, and do not support the criterion of returns.
    progress : bool
        Whether to show a progress bar with classes, mean return and splits.
    callback : callable or None
        Called with the run after each learning step, and with trials also after each episode of the
        last quarter. Learning ends if it returns True.
    **config
        Fields of :class:`Config`. Defaults that differ: ``capacity`` holds all interactions (at
        most a million), ``classes`` is 512, ``discount`` 0.99, ``tolerance`` 0.001 and, with
        trials, ``min_samples`` 64. If the environment changes over time, use a smaller
        ``capacity``: the agent forgets old interactions sooner.

    Returns
    -------
    Run

    Raises
    ------
    SpaceError
        The actions are not Discrete, or the observations cannot be encoded.
    ConfigError
        A field of the config, ``interactions``, ``every`` or ``leaves`` is out of range.

    EnvError, RewardError, PerceptError
        The environment returned a value that Gymnasium's interface does not allow. The message
        names the interaction, the episode and the value.

    Notes
    -----
    Ctrl-C ends learning: the run so far is returned, with ``interrupted`` True. Any exception, also
    of the environment, the encoder or the callback, has the run so far in its attribute ``run``.
    """
    interactions = whole("interactions", interactions, 1, 2**53)
    every = max(100, interactions // 100) if every is None else whole("every", every, 1, 2**53)
    if seed is None:
        seed = int(np.random.SeedSequence().generate_state(1)[0])
    seed = whole("seed", seed, 0, 2**63 - 1)
    if callback is not None and not callable(callback):
        raise ConfigError(f"callback: {callback!r:.80} is not a function")
    stream = Environment(env, seed)
    if stream.vector and config.get("criterion") == "returns":
        raise ConfigError("criterion: returns needs a single environment, not a vector")
    learner = Interaction(stream, interactions, every)
    if encoder is None:
        encoder = Encoder(stream.observation_space, thresholds)
    domain = domain_of(encoder)
    able = isinstance(domain, Thresholds) and not stream.vector
    leaves = _leaves(leaves, able and config.get("criterion") != "returns")
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
    except BaseException as error:
        _explain(error, run, learner)
        raise
    finally:
        if bar is not None:
            bar.close()
    return run


def _explain(error: BaseException, run: Run, learner: Interaction) -> None:
    """Add to an exception where it was raised, and the run so far."""
    where = f"interaction {learner.at}, episode {learner.episodes}"
    if isinstance(error, Error):
        error.args = (f"{where}: {error}",)
    with contextlib.suppress(AttributeError, TypeError):  # a class may not let one
        error.run = run  # type: ignore[attr-defined]
        if not isinstance(error, Error) and hasattr(error, "add_note"):  # from Python 3.11 on
            error.add_note(f"rlvc.learn: {where}; the attribute run is what was learnt until then")


def _learn(
    run: Run,
    learner: Interaction,
    bar: Any,
    callback: Callable[[Run], object] | None,
) -> None:
    if not learner.stream.vector:
        run.agent.begin(packed(run.encoder, [learner.stream.current], run.agent.domain)[0])
    for _ in collect(run, learner):
        splits = run.agent.learn().splits
        _note(run, learner, splits, bar)
        if callback is not None and callback(run) is True:
            return


def _shrunk(agent: Agent, percepts: npt.NDArray[Any], leaves: int) -> SmallPolicy:
    """A small policy from the agent's values; untried actions count as the worst of their class."""
    tried = agent.samples > 0
    least = np.min(agent.q, axis=1, where=tried, initial=np.inf, keepdims=True)
    values = np.where(tried, agent.q, np.where(np.isinf(least), 0.0, least))
    return shrink(percepts, values[agent.predict(percepts).class_id], leaves)


def _learn_by_trials(
    run: Run,
    learner: Interaction,
    leaves: int,
    bar: Any,
    callback: Callable[[Run], object] | None,
) -> None:
    """Let small policies act and learn after each trial; at the end compare the best ones."""
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
