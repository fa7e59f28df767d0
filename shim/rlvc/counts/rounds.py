# SPDX-License-Identifier: MIT
"""A learning step from counts: rounds of the tree, and passes over the data."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

from ..agent.agent import Agent
from ..agent.config import Config
from ..domains.bits import Bits
from ..domains.domain import Domain
from ..errors import ConfigError, CountError
from .part import Part, Question

CELL_BITS_MAX = 64


@dataclasses.dataclass
class Progress:
    """How far learning is.

    Attributes
    ----------
    passes, rounds, splits : int
        Made so far.
    done : bool
    """

    passes: int = 0
    rounds: int = 0
    splits: int = 0
    done: bool = False


def why_not(domain: Domain, config: Config) -> str:
    """Say, in one sentence, why what an agent is to do does not follow from counts; empty if it does.

    Parameters
    ----------
    domain : Domain
    config : Config
    """
    if not isinstance(domain, Bits):
        return (
            f"domain: counts are of bits; the candidates of {type(domain).__name__} depend on the "
            "percepts of each class: encode them as bits, with thresholds of your own"
        )
    if config.criterion == "returns":
        return "criterion: returns depend on the order of a whole episode, which counts do not keep"
    if config.solver in ("q_learning", "sarsa"):
        return f"solver: {config.solver} depends on the order of interactions, which counts do not keep"
    if config.score == "ranks":
        return "score: ranks are not made from counts yet: use the information gain"
    if config.dependence is not False and config.successors is not False:
        return "dependence: counts do not keep the order of interactions: set dependence to False"
    return ""


def without_order(config: Config) -> Config:
    """Return a config as counts need it: unless the caller chose otherwise, without dependence.

    Parameters
    ----------
    config : Config
    """
    return config.replace(dependence=False) if config.dependence is None else config


def refuse(agent: Agent) -> None:
    """Raise ConfigError if what an agent is to do does not follow from counts.

    Parameters
    ----------
    agent : Agent
    """
    why = why_not(agent.domain, agent.config)
    if why:
        raise ConfigError(why)


def question_of(agent: Agent, tested: tuple[int, ...], sums: bool) -> Question:
    """Return what is to be counted for an agent.

    Parameters
    ----------
    agent : Agent
    tested : tuple of int
        Features that cells tell apart.
    sums : bool
        Whether rewards are rounded, and summed beside.
    """
    domain, config = agent.domain, agent.config
    assert isinstance(domain, Bits)
    return Question(domain.bits, config.actions, tested, agent.successors, sums)


def tested_by(agent: Agent) -> set[int]:
    """Return the features that the tree tests.

    Parameters
    ----------
    agent : Agent
    """
    return {int(split.feature) for split in agent.splits}


def learn(
    agent: Agent,
    count: Callable[[tuple[int, ...]], Part],
    progress: Progress,
    tested: set[int],
    passed: Callable[[Part, tuple[int, ...]], None] | None = None,
) -> None:
    """Learn: count, refine the tree until it tests something new, count again.

    Parameters
    ----------
    agent : Agent
    count : callable
        Makes a pass over the data: given the features of a cell, in order, it returns the counts.
    progress : Progress
        Is kept up to date.
    tested : set of int
        Features that the first pass tells apart besides those of the tree: a good guess saves passes,
        and changes nothing else.
    passed : callable or None
        Called with the counts and the features after each pass, before the tree is refined.
    """
    domain = agent.domain
    assert isinstance(domain, Bits)
    feature = np.arange(domain.bits, dtype=np.uint16)
    while not progress.done:
        tested = tested | tested_by(agent)
        if len(tested) > CELL_BITS_MAX:
            raise CountError(
                f"the tree tests {len(tested)} features; counts tell at most {CELL_BITS_MAX} apart"
            )
        cell = tuple(sorted(tested))
        part = count(cell)
        progress.passes += 1
        if passed:
            passed(part, cell)
        counts = part.native(feature, np.array(cell, np.uint32))
        while not progress.done and tested_by(agent) <= tested:
            made = agent.learn_counts(counts)
            progress.rounds += 1
            progress.splits += made.splits
            progress.done = made.done
