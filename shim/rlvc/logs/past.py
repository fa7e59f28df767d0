# SPDX-License-Identifier: MIT
"""Logs of tasks whose state is hidden: what was seen and done lately is observed, too."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt

from ..checks import whole
from ..errors import ConfigError
from ..learning.encode import Named, Number, Numbers, Word
from .log import Log

Array = npt.NDArray[Any]


def with_history(log: Log, n: int, space: Any = None) -> Log:
    """Make a log of the last n observations, and of the n - 1 actions between them.

    Parameters
    ----------
    log : Log
    n : int
        [1, 64]
    space : object
        Of an observation; None: that of the log.

    Returns
    -------
    Log
        Its observations are those of :class:`rlvc.envs.history.History`: dicts of ``now``, ``1 ago``,
        ``action 1 ago``, and so on.

    Raises
    ------
    ConfigError
        ``n`` is out of range, or the log is of percepts.
    """
    n = whole("history", n, 1, 64)
    if log.record_bytes:
        raise ConfigError(f"history: {log.where} has percepts, and not observations: leave it out")
    space = log.space if space is None else space
    space = Numbers(np.shape(log.before)[1:]) if space is None else space
    first = _first(log)
    done, done_space = _done(log)
    spaces: dict[str, Any] = {"now": space}
    before, after = {"now": log.before}, {"now": log.after}
    at = np.arange(len(log))
    for ago in range(1, n):
        spaces |= {f"{ago} ago": space, f"action {ago} ago": done_space}
        for side, then in ((before, at - ago), (after, at - ago + 1)):
            side[f"{ago} ago"] = _rows(log.before, np.maximum(then, first))
            side[f"action {ago} ago"] = done[np.where(then >= first, then + 1, 0)]
    notes = [*log.notes, f"history: the last {n} observations, and the actions between them"]
    sides: list[Any] = [before, after]
    if isinstance(log.before, list):
        sides = [_one_by_one(side, len(log)) for side in sides]
    return dataclasses.replace(
        log, before=sides[0], after=sides[1], space=Named(spaces), notes=notes
    )


def _first(log: Log) -> Array:
    """For each interaction the first one of those that it follows without a gap."""
    goes_on = (log.ends[:-1] == 0) & _same(
        _rows(log.after, slice(-1)), _rows(log.before, slice(1, None))
    )
    starts = np.append(True, ~goes_on)
    first: Array = np.maximum.accumulate(np.where(starts, np.arange(len(log)), 0))
    return first


def _same(one: Any, other: Any) -> Array:
    """Where two columns of observations are the same."""
    same: Array
    if isinstance(one, dict):
        same = np.all([_same(one[name], other[name]) for name in one], axis=0)
    elif isinstance(one, list):
        same = np.array([_equal(a, b) for a, b in zip(one, other, strict=True)], np.bool_)
    else:
        same = (one == other).reshape(len(one), -1).all(axis=1)
    return same


def _equal(one: Any, other: Any) -> bool:
    if isinstance(one, dict):
        return all(_equal(one[name], other[name]) for name in one)
    if isinstance(one, tuple):
        return all(_equal(a, b) for a, b in zip(one, other, strict=True))
    return bool(np.array_equal(one, other))


def _rows(side: Any, rows: Any) -> Any:
    if isinstance(side, dict):
        return {name: column[rows] for name, column in side.items()}
    if isinstance(side, list):
        return side[rows] if isinstance(rows, slice) else [side[int(i)] for i in rows]
    return side[rows]


def _done(log: Log) -> tuple[Array, Any]:
    """What was done, after what stands for nothing; and its space."""
    known = log.known
    if known.table is not None:
        table = np.asarray(known.table)
        none = np.zeros((1, *table.shape[1:]), table.dtype)
        return np.concatenate([none, table[log.actions]]), Numbers(table.shape[1:])
    if known.words:
        return np.array(["", *(known.words[i] for i in log.actions)]), Word(["", *known.words])
    return np.append(0, log.actions + 1), Number(known.count + 1)


def _one_by_one(side: dict[str, Any], count: int) -> list[dict[str, Any]]:
    return [{name: column[i] for name, column in side.items()} for i in range(count)]
