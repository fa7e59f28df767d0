# SPDX-License-Identifier: MIT
"""Learning from the logs of a fleet: the front, which looks at what is asked for."""

from __future__ import annotations

import functools
from collections.abc import Callable
from pathlib import Path
from typing import Any, get_args

from ..agent.agent import Agent
from ..checks import flag, one_of, real, shown, whole
from ..counts import rounds
from ..counts.table import MEMORY
from ..domains.bits import Bits
from ..domains.domain import Domain
from ..errors import ConfigError
from ..learning.learn import Method, default_config
from . import counted, planned
from .counting import Counting, Rounding
from .engines import Engine, engine_of
from .run import Bar, FleetRun
from .sources import Source, opened

SAMPLE = 1 << 20  # interactions of which the first pass' features are guessed
_SAMPLE_MOST = 1 << 14  # percepts, which compact() looks at by default
_CAPACITY = 2000  # a controller's, to which the snapshot goes


def _domain_of(domain: Domain | int | None, source: Source) -> Domain:
    if domain is None:
        return Bits(source.bits)
    made = Bits(domain) if isinstance(domain, int) else domain
    # A log of whole bytes may be a controller's, whose last byte has bits to spare.
    spare = 7 if source.bits % 8 == 0 else 0
    if isinstance(made, Bits) and not source.bits - spare <= made.bits <= source.bits:
        raise ConfigError(f"domain: {made.bits} bits, but the log's percepts have {source.bits}")
    return made


def _agent_of(
    source: Source, domain: Domain | int | None, actions: int, seed: int, config: dict[str, Any]
) -> Agent:
    settings = default_config(actions, 1, seed, {"capacity": _CAPACITY} | config)
    agent = Agent(_domain_of(domain, source), rounds.without_order(settings))
    rounds.refuse(agent)
    return agent


def _rounding(bits: int | None, grid: float | None) -> Rounding:
    if bits is not None and grid is not None:
        raise ConfigError("reward_bits and reward_grid: give one of them")
    if bits is not None:
        bits = whole("reward_bits", bits, 0, 22)
    if grid is not None:
        grid = real("reward_grid", grid)
        if not 0 < grid <= 1e12:
            raise ConfigError(f"reward_grid: {grid} is not in (0, 1e12]")
    return Rounding(bits, grid)


def learn_from(
    source: Any,
    *,
    method: Method = "classes",
    cluster: str | None = None,
    workers: int | None = None,
    domain: Domain | int | None = None,
    actions: int | None = None,
    sample: int | None = None,
    reward_bits: int | None = None,
    reward_grid: float | None = None,
    memory: int = MEMORY,
    skip_broken: bool = False,
    progress: bool = False,
    checkpoint: str | Path | None = None,
    **config: Any,
) -> FleetRun:
    """Learn from more interactions than one machine holds.

    The tree is the one that :func:`rlvc.learn_from` would make of them all, bit for bit, however they
    are spread over files and workers. Of real numbers a planner learns from a sample, which does not
    depend on that either.

    Parameters
    ----------
    source : str, Path, minari.MinariDataset or sequence of these
        Files, folders, or addresses such as ``s3://bucket/folder``: Parquet files
        (:mod:`rlvc.fleet.layout`, or RLlib's columns), NPZ, CSV, or the logs of controllers; the folder
        or address of a LeRobot data set; a Minari data set, its name or its folder.
    method : str
        ``"classes"``: of bits, by counts of all interactions. ``"planner"``: of real numbers, by one
        pass that draws a sample, in which a model is fitted and a tree searched.
    cluster : str or None
        None: this process. ``"ray"`` or ``"dask"``: a cluster on this machine. ``"ray://..."`` or
        Dask's ``"tcp://..."``: one that runs.
    workers : int or None
        Tasks at a time of a cluster on this machine.
    domain : Domain, int or None
        The percepts; None: as the log says. Bits only.
    actions : int or None
        Number of actions; None: as the log says.
    sample : int or None
        Of classes: interactions that a guess is made from of the features that the tree will test, if
        there are eight times as many. A good guess saves passes and changes nothing else. 0: no guess.
        None: 2**20. Of a planner: interactions of the sample, at most: whole episodes
        (:mod:`rlvc.fleet.episodes`). None: 4000.
    reward_bits : int or None
        Tell rewards apart by so many bits of their fraction, [0, 22]. Their sums stay exact.
    reward_grid : float or None
        Tell rewards apart on a grid of this width. With the width of ``tolerance`` the values are
        within half of it over (1 - discount).
    memory : int
        Bytes that a table of counts may grow to.
    skip_broken : bool
        Whether to leave out row groups that cannot be read or hold what is out of range; the report
        lists them. False: they are an error.
    progress : bool
        Whether to show a progress bar.
    checkpoint : str, Path or None
        File to save tree and counts to after each pass, and to go on from if it is there.
    **config
        Fields of :class:`rlvc.Config`. Defaults that differ: those of :func:`rlvc.learn_from`, but
        ``capacity`` is 2000, for a controller that loads the result. Of a planner those of
        :class:`rlvc.PlannerConfig`, but ``capacity`` is twice the sample.

    Returns
    -------
    FleetRun

    Raises
    ------
    LogError
        A file is broken. The message names it, the row group and the column.
    ConfigError
        A field is out of range, a source is no path, address or data set, or what is asked for does
        not follow from counts.
    CountError
        There are too many distinct rows, or the tree tests too many features.
    """
    one_of("method", method, get_args(Method))
    asked = {
        "domain": domain,
        "reward_bits": reward_bits,
        "reward_grid": reward_grid,
        "checkpoint": checkpoint,
    }
    if method == "planner":
        planned.refuse(asked)
    rounding = _rounding(reward_bits, reward_grid)
    seed = whole("seed", config.pop("seed", 1), 0, 2**32 - 1)
    skip = flag("skip_broken", skip_broken)
    if not isinstance(checkpoint, str | Path | None):
        raise ConfigError(f"checkpoint: {shown(checkpoint)} is not the name of a file")
    found = opened(source, real=method == "planner")
    count = whole("actions", actions if actions is not None else found.actions, 1, 255)
    job: Callable[[Engine, Bar], FleetRun]
    if method == "planner":
        drawing = planned.drawing_of(found, count, sample, skip)
        planner = planned.planner_of(drawing, seed, config)
        job = functools.partial(planned.learn, planner, found, drawing)
    else:
        agent = _agent_of(found, domain, count, seed, config)
        question = rounds.question_of(agent, (), bool(rounding))
        most = min(agent.config.capacity, _SAMPLE_MOST)
        memory = whole("memory", memory, 1, 2**63 - 1)
        counting = Counting(question, rounding, memory, skip, most)
        guessed = whole("sample", SAMPLE if sample is None else sample, 0, 2**48)
        job = functools.partial(counted.learn, agent, found, counting, guessed, checkpoint)
    if workers is not None:
        workers = whole("workers", workers, 1, 10**6)
    engine = engine_of(cluster, workers)
    bar = Bar(flag("progress", progress), found.rows)
    try:
        return job(engine, bar)
    finally:
        bar.close()
        engine.close()
