# SPDX-License-Identifier: MIT
"""Learning from a Gymnasium environment."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from ..agent.agent import Agent
from ..agent.config import Config
from ..agent.planner import Planner
from ..checks import whole
from ..domains.bits import Bits
from ..domains.domain import Domain
from ..domains.thresholds import Thresholds
from ..errors import ConfigError, Error
from . import planning
from .encode import Encoder
from .environment import Environment
from .interact import Interaction, collect, packed
from .run import Record, Run

if TYPE_CHECKING:
    import gymnasium

Method = Literal["planner", "classes"]
_CAPACITY_MAX = 1_000_000


def _bar(total: int, wanted: bool) -> Any:
    if not wanted:
        return None
    try:
        from tqdm import tqdm
    except ImportError:
        raise ImportError("a progress bar needs tqdm: pip install 'rlvc[gym]'") from None
    return tqdm(total=total, unit=" interactions")


def _note(run: Run, learner: Interaction, splits: int, bar: Any) -> None:
    mean = float(np.mean(learner.returns)) if learner.returns else float("nan")
    step, leaves = len(run.history) + 1, run.leaves
    run.history.append(Record(step, learner.done, leaves, splits, len(learner.returns), mean))
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


def _method(wanted: str | None, domain: Domain, stream: Environment) -> str:
    """Choose the method: as wanted, or a planner where it can learn."""
    if wanted not in (None, *get_args(Method)):
        raise ConfigError(f"method: {wanted!r:.80} is not one of {', '.join(get_args(Method))}")
    why = planning.refusal(domain, stream)
    if wanted == "planner" and why:
        raise ConfigError(f"method: {why}")
    if wanted == "classes" or why:
        return "classes"
    if stream.vector:
        raise ConfigError(
            "env: of real numbers a planner learns from one environment, not from a vector: pass "
            "one, or choose the method 'classes'"
        )
    return "planner"


def learn(
    env: gymnasium.Env[Any, Any] | gymnasium.vector.VectorEnv[Any, Any, Any],
    interactions: int,
    *,
    encoder: Encoder | None = None,
    every: int | None = None,
    seed: int | None = None,
    thresholds: int = 15,
    method: Method | None = None,
    progress: bool = False,
    callback: Callable[[Run], object] | None = None,
    **config: Any,
) -> Run:
    """Learn from an environment: on bits by classes (section 4.2.1), on real numbers by a planner.

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
        Seed of the environment and of the learner: the same seed gives the same tree. None: a random
        seed.
    thresholds : int
        Maximum number of cutpoints for each element of a Box in one class; 0: no limit.
    method : {"planner", "classes"} or None
        How to learn. classes: the loop of section 4.2.1, with an :class:`rlvc.Agent`. planner: an
        :class:`rlvc.Planner`, which learns small trees on real numbers from one environment; it
        learns after each episode, and uses neither ``every`` nor ``thresholds``. None: planner if
        percepts are real numbers, at most 64, and there are 2 to 64 actions; else classes.
    progress : bool
        Whether to show a progress bar with leaves, mean return and splits.
    callback : callable or None
        Called with the run after each learning step. Learning ends if it returns True.
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
        The actions are not Discrete, or the observations cannot be encoded.
    ConfigError
        A field of the config, ``interactions``, ``every`` or ``method`` is out of range; or percepts
        are real numbers, ``method`` is None and ``env`` is a vector.
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
    fields = (stream.actions, interactions, seed % 2**32, config)
    made: Agent | Planner
    if _method(method, domain, stream) == "planner":
        assert isinstance(domain, Thresholds)
        made = Planner(domain, planning.default_config(*fields))
    else:
        made = Agent(domain, default_config(*fields))
    run = Run(made, encoder, seed, stream.start)
    bar = _bar(interactions, progress)
    try:
        for splits in _steps(run, learner):
            _note(run, learner, splits, bar)
            if callback is not None and callback(run) is True:
                break
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


def _steps(run: Run, learner: Interaction) -> Iterator[int]:
    """Interact and learn; yield the number of splits of each learning step."""
    if isinstance(run.learner, Planner):
        for _ in planning.episodes(run, learner):
            yield 0
        return
    if not learner.stream.vector:
        run.agent.begin(packed(run.encoder, [learner.stream.current], run.agent.domain)[0])
    for _ in collect(run, learner):
        yield run.agent.learn().splits
