# SPDX-License-Identifier: MIT
"""Learning from a Gymnasium environment."""

from __future__ import annotations

import contextlib
import dataclasses
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from ..agent.agent import Agent
from ..agent.config import Config
from ..agent.planned_policy import PlannedPolicy
from ..agent.planner import Planner
from ..agent.planner_config import PlannerConfig
from ..checks import flag, known, one_of, shown, whole
from ..domains.bits import Bits
from ..domains.domain import Domain
from ..domains.thresholds import Thresholds
from ..errors import ConfigError, Error
from . import planning, side_by_side
from .actions import Actions, actions_of
from .encode import Encoder
from .environment import Environment
from .interact import Interaction, collect
from .names import known_names
from .run import Record, Run

if TYPE_CHECKING:
    import gymnasium

Method = Literal["planner", "classes"]
_CAPACITY_MAX = 1_000_000


def _bar(total: int, wanted: bool) -> Any:
    if not wanted:
        return None
    try:
        from tqdm.auto import tqdm
    except ImportError:
        raise ImportError("a progress bar needs tqdm: pip install 'rlvc[gym]'") from None
    return tqdm(total=total, unit=" interactions")


def _note(run: Run, learner: Interaction, splits: int, bar: Any) -> None:
    mean = float(np.mean(learner.returns)) if learner.returns else float("nan")
    step, leaves = len(run.history) + 1, run.leaves
    done = learner.before + learner.done
    run.history.append(Record(step, done, leaves, splits, len(learner.returns), mean))
    learner.returns = []
    if bar is not None:
        bar.update(learner.done - bar.n)
        shown = {"leaves": leaves, "return": f"{mean:.3g}"}
        bar.set_postfix(shown if isinstance(run.learner, Planner) else shown | {"splits": splits})


def domain_of(encoder: Any) -> Domain:
    """Return the domain of an encoder's percepts: its ``domain``, or Bits of its ``bits``.

    Parameters
    ----------
    encoder : object

    Returns
    -------
    Domain
    """
    try:
        encode, domain = encoder.encode, getattr(encoder, "domain", None)
        bits: Any = None if isinstance(domain, Domain) else encoder.bits
    except Exception:  # it has none, or making it fails
        encode = None
    if not callable(encode):
        raise ConfigError(
            f"encoder: {type(encoder).__name__} needs encode(observation), and domain or bits"
        )
    return domain if isinstance(domain, Domain) else Bits(bits)


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
    for name in changes:
        if not hasattr(Config, name) and hasattr(PlannerConfig, name):
            raise ConfigError(f"{name}: an agent has no such field, the method 'planner' has it")
    there = [field.name for field in dataclasses.fields(Config) if field.name != "actions"]
    known(changes, there, "an agent")
    return Config(actions, **(fields | changes))


def _method(wanted: str | None, domain: Domain, actions: int) -> str:
    """Choose the method: as wanted, or a planner where it can learn."""
    if wanted is not None:
        one_of("method", wanted, get_args(Method))
    why = planning.refusal(domain, actions)
    if wanted == "planner" and why:
        raise ConfigError(f"method: {why}")
    return "classes" if wanted == "classes" or why else "planner"


def learn(
    env: gymnasium.Env[Any, Any] | gymnasium.vector.VectorEnv[Any, Any, Any],
    interactions: int,
    *,
    encoder: Encoder | None = None,
    every: int | None = None,
    seed: int | None = None,
    thresholds: int = 15,
    names: Sequence[str] | None = None,
    bins: int | Sequence[int] | None = None,
    hold: int = 1,
    method: Method | None = None,
    progress: bool = False,
    callback: Callable[[Run], object] | Sequence[Callable[[Run], object]] | None = None,
    run: Run | None = None,
    **config: Any,
) -> Run:
    """Learn from an environment: on bits by classes (section 4.2.1), on real numbers by a planner.

    Parameters
    ----------
    env : gymnasium.Env or gymnasium.vector.VectorEnv
        :mod:`rlvc.learning.encode` lists the spaces of observations, :mod:`rlvc.learning.actions`
        those of actions. If its info or observation has an ``action_mask``, only actions that it
        allows are taken.
    interactions : int
        Number of interactions, at least 1.
    encoder : object or None
        Turns observations into percepts: it has ``encode(observation) -> bytes``, and either
        ``bits`` or the ``domain`` of the percepts, as :class:`rlvc.vision.Eye` has. None: an
        :class:`rlvc.Encoder` for the environment's space.
    every : int or None
        Interactions between two learning steps. None: a hundredth of all, at least 100.
    seed : int or None
        Seed of the environment and of the learner: the same seed gives the same tree. None: a random
        seed.
    thresholds : int
        Maximum number of cutpoints for each element of a Box in one class; 0: no limit.
    names : sequence of str or None
        A name for each number of an observation, for trees and figures. None: from the space, or
        known ones of Gymnasium's classic tasks.
    bins : int, sequence of int or None
        If actions are a Box: into how many numbers each element is divided, from low to high.
    hold : int
        For how many steps of the environment an action is taken; the rewards are summed. Such a
        decision is one interaction.
    method : {"planner", "classes"} or None
        How to learn. classes: the loop of section 4.2.1, with an :class:`rlvc.Agent`. planner: an
        :class:`rlvc.Planner`, which learns small trees on real numbers; it learns after each episode
        (from a vector after one of each environment), and uses neither ``every`` nor ``thresholds``.
        None: planner if percepts are real numbers, at most 64, and there are 2 to 64 actions; else
        classes.
    progress : bool
        Whether to show a progress bar with leaves, mean return and splits.
    callback : callable, sequence of callables, or None
        Called with the run after each learning step; :mod:`rlvc.learning.callbacks` has some.
        Learning ends if one returns True.
    run : Run or None
        A run to go on with: it keeps its learner, encoder, actions and config. The environment must
        have the same spaces.
    **config
        Fields of :class:`Config`, or with a planner of :class:`PlannerConfig`. Defaults that differ:
        ``capacity`` holds all interactions (at most a million) and, of an agent, ``classes`` is 512,
        ``discount`` 0.99 and ``tolerance`` 0.001. If the environment changes over time, use a
        smaller ``capacity``: old interactions are forgotten sooner.

    Returns
    -------
    Run

    Raises
    ------
    SpaceError
        The actions are not finite, or the observations cannot be encoded.
    ConfigError
        A field of the config, ``interactions``, ``every`` or ``method`` is out of range; or a run's
        spaces are not those of the environment.
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
    calls = _callbacks(callback)
    stream = Environment(env)
    if run is not None:
        _need_same(run, [encoder, names, bins, method, *config.values()], hold)
        stream.need_fit(run, learns=True)
    else:
        actions = actions_of(stream.action_space, bins, hold)
        if encoder is None:
            known = names if names is not None else known_names(env, stream.observation_space)
            encoder = Encoder(stream.observation_space, thresholds, known)
        run = _begun(stream, interactions, seed, encoder, actions, method, config)
    stream.start(run.actions, seed)
    run.small = run.compaction = None
    learner = Interaction(stream, interactions, every, run.interactions)
    bar = _bar(interactions, flag("progress", progress))
    try:
        for splits in _steps(run, learner):
            run.masked = run.masked or stream.masked
            _note(run, learner, splits, bar)
            answers = [call(run) for call in calls]  # all are called
            if any(answer is True for answer in answers):
                break
    except KeyboardInterrupt:
        run.interrupted = True
    except BaseException as error:
        _explain(error, run, learner)
        raise
    finally:
        run.masked = run.masked or stream.masked
        if bar is not None:
            bar.close()
    return run


def _callbacks(callback: Any) -> list[Callable[[Run], object]]:
    """The functions to call, as a list."""
    calls = list(callback) if isinstance(callback, list | tuple) else [callback]
    calls = [call for call in calls if call is not None]
    for call in calls:
        if isinstance(call, type):
            raise ConfigError(f"callback: {call.__name__} is a class: make one, and pass that")
        if not callable(call):
            raise ConfigError(f"callback: {shown(call)} is not a function")
    return calls


def _need_same(run: Run, given: list[Any], hold: int) -> None:
    """Raise ConfigError if a run cannot go on in an environment, or is given other settings."""
    if not isinstance(run, Run):
        raise ConfigError(f"run: {shown(run)} is not a run that rlvc.learn returned")
    if any(value is not None for value in given) or hold not in (1, run.actions.hold):
        raise ConfigError("run: it keeps its encoder, actions, method and config: leave them out")
    if isinstance(run.learner, PlannedPolicy):
        raise ConfigError("run: a policy by itself cannot learn on")
    if run.encoder is None:
        raise ConfigError("run: it learnt from percepts, and has no encoder for observations")


def _begun(
    stream: Environment,
    interactions: int,
    seed: int,
    encoder: Any,
    actions: Actions,
    method: Method | None,
    config: dict[str, Any],
) -> Run:
    """Make a run that has learnt nothing yet."""
    if stream.vector and config.get("criterion") == "returns":
        raise ConfigError("criterion: returns needs a single environment, not a vector")
    domain = domain_of(encoder)
    fields = (actions.count, interactions, seed % 2**32, config)
    made: Agent | Planner
    if _method(method, domain, actions.count) == "planner":
        assert isinstance(domain, Thresholds)
        made = Planner(domain, planning.default_config(*fields))
    else:
        made = Agent(domain, default_config(*fields))
    return Run(made, encoder, seed, actions)


def _explain(error: BaseException, run: Run, learner: Interaction) -> None:
    """Add to an exception where it was raised, and the run so far."""
    where = f"interaction {learner.at}, episode {learner.episodes}"
    if isinstance(error, Error):
        error.args = (f"{where}: {error}",)
    with contextlib.suppress(AttributeError, TypeError):  # a class may not let one
        error.run = run  # type: ignore[attr-defined]
        if not isinstance(error, Error) and hasattr(error, "add_note"):  # from Python 3.11 on
            error.add_note(f"rlvc.learn: {where}; the attribute run is what was learnt until then")


def _steps(run: Run, learner: Interaction) -> Iterator[int]:
    """Interact and learn; yield the number of splits of each learning step."""
    if isinstance(run.learner, Planner):
        method = side_by_side if learner.stream.vector else planning
        for _ in method.episodes(run, learner):
            yield 0
        return
    for _ in collect(run, learner):
        yield run.agent.learn().splits
