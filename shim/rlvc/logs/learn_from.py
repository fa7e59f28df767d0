# SPDX-License-Identifier: MIT
"""Learning from a log of any kind."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..agent.agent import Agent
from ..agent.results import CHOICE
from ..checks import whole
from ..counts import rounds
from ..counts.part import Part
from ..counts.table import Columns, Table
from ..domains.bits import Bits
from ..domains.domain import Domain
from ..errors import ConfigError, LogError, LogWarning, PerceptError
from ..learning.actions import Actions
from ..learning.encode import Encoder, Numbers
from ..learning.learn import default_config, domain_of
from ..learning.run import Record, Run
from .log import Log
from .past import with_history
from .read import read


def _domain_of_records(log: Log, domain: Domain | int | None) -> Domain:
    """Return the domain of a log of percepts."""
    if domain is None:
        domain = 8 * log.record_bytes
        if domain > _native.BITS_MAX:
            raise ConfigError(
                f"domain: {log.where} has percepts of {log.record_bytes} bytes, too many to be bits: "
                "pass their domain"
            )
    if isinstance(domain, int):
        domain = Bits(domain)
    if domain.percept_bytes != log.record_bytes:
        raise ConfigError(
            f"domain: its percepts have {domain.percept_bytes} bytes, and those of {log.where} "
            f"have {log.record_bytes}"
        )
    return domain


def _of_records(
    log: Log, domain: Domain | int | None
) -> tuple[Domain, npt.NDArray[Any], npt.NDArray[Any]]:
    """The domain and percepts of a controller's log, in the type of the domain."""
    made = _domain_of_records(log, domain)
    sides = [
        np.ascontiguousarray(side).view(made.percept_dtype).reshape(-1, *made.percept_shape)
        for side in (log.before, log.after)
    ]
    return made, sides[0], sides[1]


def encoded(
    log: Log, encoder: Any, space: Any, thresholds: int, names: Sequence[str] | None = None
) -> tuple[Domain, Any, npt.NDArray[Any], npt.NDArray[Any]]:
    """Return the domain, the encoder, and the percepts before and after each interaction.

    Parameters
    ----------
    log : Log
        Of observations.
    encoder, space, thresholds, names
        As for :func:`learn_from`.
    """
    if encoder is None:
        space = log.space if space is None else space
        space = Numbers(np.shape(log.before)[1:]) if space is None else space
        encoder = Encoder(space, thresholds, names)
    domain = domain_of(encoder)
    sides = []
    for side, name in ((log.before, "observations"), (log.after, "next observations")):
        quick = type(encoder) is Encoder and not isinstance(side, list)
        try:
            sides.append(
                encoder.encode_many(side) if quick else _one_by_one(log, encoder, side, name)
            )
        except PerceptError as error:
            sides.append(_one_by_one(log, encoder, side, name))
            raise LogError(f"{log.where}: {name}: {error}") from error
    return domain, encoder, sides[0], sides[1]


def _one_by_one(log: Log, encoder: Any, side: Any, name: str) -> npt.NDArray[Any]:
    """Encode each observation, and say which is wrong."""
    domain, records = domain_of(encoder), []
    columns = list(side.values()) if isinstance(side, dict) else None
    for i in range(len(log)):
        row = side[i] if columns is None else [column[i] for column in columns]
        row = row[0] if columns is not None and len(columns) == 1 else row
        try:
            records.append(encoder.encode(row))
        except PerceptError as error:
            raise LogError(f"{log.where}: {name}: index {i}: {error}") from error
    flat = np.frombuffer(b"".join(records), domain.percept_dtype)
    return flat.reshape(len(log), *domain.percept_shape)


def _counted(log: Log, actions: int | None) -> Actions:
    """The actions of a log, or as many as the caller says."""
    if actions is None:
        return log.known
    count = whole("actions", actions, 1, 255)
    known = log.known
    if known.table is not None or known.words:
        raise ConfigError(f"actions: the log has {known.count} of its own: leave actions out")
    lowest, indices = int(known.start), log.actions  # their sum may be beyond int64
    bad = np.flatnonzero((indices < -lowest) | (indices >= count - lowest))
    if len(bad):
        number = int(indices[bad[0]]) + lowest
        raise LogError(f"{log.where}: actions: index {bad[0]}: {number} is not in [0, {count})")
    log.actions = indices + lowest
    return Actions(count)


def learn_from(
    log: Any,
    *,
    columns: Sequence[str] | None = None,
    header: Sequence[str] | None = None,
    roles: Mapping[str, Any] | None = None,
    actions: int | None = None,
    bins: int | None = None,
    space: Any = None,
    encoder: Any = None,
    domain: Domain | int | None = None,
    thresholds: int = 15,
    names: Sequence[str] | None = None,
    history: int = 1,
    steps: int = 1,
    **config: Any,
) -> Run:
    """Learn from a log, without an environment.

    Parameters
    ----------
    log : dict of arrays, pandas.DataFrame, path, list of paths, Minari data set or its name, or buffer
        The formats are in :mod:`rlvc.logs`; ``rlvc.logs.read(log).describe()`` says how one is
        understood. A file is CSV in any dialect, JSON, JSON Lines, NPZ, HDF5, Parquet, or the log of a
        controller. Of several files no episode goes on from one to the next.
    columns : sequence of str or None
        Columns that form the observation. None: those that are named so, else all without another
        meaning.
    header : sequence of str or None
        The names of the columns of a file that has none.
    roles : mapping or None
        What columns are, where their names do not say it: for ``action``, ``reward``, ``terminated``,
        ``done``, ``truncated``, ``episode``, ``step``, ``observation`` or ``next_observation`` the name
        of a column, or a list of names.
    actions : int or None
        Number of actions, from 0 on. None: as the log says.
    bins : int or None
        Of actions that are real numbers: into how many each element is divided, from the least to
        the greatest; the nearest is taken.
    space : gymnasium.Space or None
        Space of the observations. None: that of the data set; else bits if they are bool, words, or
        real numbers.
    encoder : object or None
        As for :func:`rlvc.learn`.
    domain : Domain, int or None
        Domain of the percepts in the log of a controller; an int is the number of bits. None: all
        bits of the percepts.
    thresholds : int
        Maximum number of cutpoints for each element of an observation; 0: no limit.
    names : sequence of str or None
        A name for each number of an observation. None: those of the columns.
    history : int
        How many observations are seen, with the actions between them, if one does not tell the state;
        :class:`rlvc.envs.history.History` does the same in an environment.
    steps : int
        Number of learning steps. The residual criterion needs one. With the criterion of returns,
        step k looks k interactions ahead, and each step uses the whole log.
    **config
        Fields of :class:`~rlvc.Config`. The criterion ``"returns"`` needs a log with ``exploited``.

    Returns
    -------
    Run

    Raises
    ------
    LogError
        The log is damaged. The message names the file, the place and the fault.
    ConfigError
        A field is out of range, or the log lacks what the criterion needs.

    Warns
    -----
    LogWarning
        Something of the log is left out, as by a ``capacity`` that holds a part of it only, or
        numbers become one in binary32.

    Notes
    -----
    Ctrl-C ends learning: the run so far is returned, with ``interrupted`` True.

    Without a ``capacity``, the replay buffer holds all interactions. But more than half a million
    are counted if what is asked for follows from counts (``core/include/rlvc/counts.h``): of bits,
    without ``dependence``, which is off for all logs unless it is asked for. That makes the same
    tree in less time and memory; the replay buffer is then empty. :mod:`rlvc.fleet` learns from what
    does not fit into memory.
    """
    if isinstance(columns, str):
        columns = [columns]
    log = read(log, columns, header, bins, roles)
    if config.get("criterion") == "returns" and log.exploited is None:
        raise ConfigError("criterion: returns needs a log with exploited")
    if space is not None and not hasattr(space, "spaces"):
        log = _alone(log)
    if whole("history", history, 1, 2**16) != 1:
        if encoder is not None:
            raise ConfigError("history: goes with the encoders of this package: leave encoder out")
        log, space = with_history(log, history, space), None
    steps = whole("steps", steps, 1, 2**31)
    seed = whole("seed", config.pop("seed", 1), 0, 2**32 - 1)
    known = _counted(log, actions)
    if log.record_bytes:
        made, before, after = _of_records(log, domain)
        encoder = None
    elif domain is not None:
        raise ConfigError("domain: goes with the log of a controller: pass space or encoder instead")
    else:
        made, encoder, before, after = encoded(log, encoder, space, thresholds, names)
    settings = rounds.without_order(default_config(known.count, len(log), seed, config))
    by_counts = "capacity" not in config and len(log) > settings.capacity // 2
    if by_counts and rounds.why_not(made, settings):
        settings = settings.replace(capacity=2 * len(log))  # all of it, whatever that takes
        by_counts = False
    run = Run(Agent(made, settings), encoder, settings.seed, known)
    _see(run, before, made)
    if by_counts:
        _by_counts(run, log, before, after)
    else:
        _by_ring(run, log, before, after, steps)
    return run


def _alone(log: Log) -> Log:
    """The one column of a table as the observation itself."""
    if not isinstance(log.before, dict) or len(log.before) != 1:
        return log
    name = next(iter(log.before))
    return dataclasses.replace(log, before=log.before[name], after=log.after[name])


def _by_ring(run: Run, log: Log, before: Any, after: Any, steps: int) -> None:
    """Learn from the interactions in the replay buffer."""
    agent = run.agent
    choices = np.zeros(len(log), CHOICE)
    choices["action"] = log.actions
    if log.exploited is not None:
        choices["exploited"] = log.exploited
    for k in range(steps):
        if k == 0 or agent.config.criterion == "returns":
            agent.observe_many(before, choices, log.rewards, after, log.ends)
            stored = agent.statistics.stored
            if stored < len(log):
                warnings.warn(
                    f"{log.where}: capacity {agent.config.capacity} holds the last {stored} of "
                    f"{len(log)} interactions; the others were left out",
                    LogWarning,
                    stacklevel=3,
                )
        try:
            splits = agent.learn().splits
        except KeyboardInterrupt:
            run.interrupted = True
            break
        run.history.append(Record(k + 1, stored, agent.classes, splits, 0, float("nan")))


def _by_counts(run: Run, log: Log, before: Any, after: Any) -> None:
    """Learn from counts of the interactions, which take less memory than these."""
    agent, actions = run.agent, log.actions.astype(np.uint8)
    rewards = np.ascontiguousarray(log.rewards)
    columns = Columns(
        np.ascontiguousarray(before),
        np.ascontiguousarray(after),
        actions,
        rewards,
        log.ends,
        rewards,
    )

    def count(cell: tuple[int, ...]) -> Part:
        table = Table(rounds.question_of(agent, cell, False))
        table.count(columns, log.where)
        return table.part()

    progress = rounds.Progress()
    rounds.learn(agent, count, progress, set())
    record = Record(1, len(log), agent.classes, progress.splits, 0, float("nan"))
    run.history.append(record)


def _see(run: Run, percepts: npt.NDArray[Any], domain: Domain) -> None:
    """Keep some of the percepts, evenly spaced, for the importances."""
    stride = -(-len(percepts) // run.seen.room)
    run.seen.percepts = [domain.pack(np.ascontiguousarray(row)) for row in percepts[::stride]]
    run.seen.count, run.seen.stride = len(percepts), stride
