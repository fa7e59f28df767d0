# SPDX-License-Identifier: MIT
"""Several logs as one: no interaction of one goes on in the next."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..errors import LogError
from ..learning.actions import Actions
from ..learning.encode import Columns, Flags, Numbers
from .actions import understood
from .log import Log
from .table import Table

Array = npt.NDArray[Any]


def joined(logs: Sequence[Log]) -> Log:
    """Join logs, one after the other; where one stops in the middle of an episode, that is truncated.

    Parameters
    ----------
    logs : sequence of Log
        At least one. The same columns, or arrays of the same shape, are observed in each.

    Returns
    -------
    Log
        Its actions are those of all logs: an action that occurs in one of them only counts, too.

    Raises
    ------
    LogError
        Observations or actions differ in kind. The message names the log that differs.
    """
    if len(logs) == 1:
        return logs[0]
    first = logs[0]
    for log in logs[1:]:
        _need_alike(first, log)
    where = f"{first.where} and {len(logs) - 1} more"
    ends = [log.ends.copy() for log in logs]
    for each in ends:
        each[-1] = each[-1] or _native.TRUNCATED
    told = [log.exploited for log in logs if log.exploited is not None]
    exploited = np.concatenate(told) if len(told) == len(logs) else None
    notes = [f"{log.where}: {len(log)} interactions" for log in logs] + first.notes
    for log in logs[1:]:
        notes += [f"{log.where}: {note}" for note in log.notes if note not in first.notes]
    actions, known = _actions(logs, where)
    return Log(
        _in_a_row([log.before for log in logs]),
        _in_a_row([log.after for log in logs]),
        actions,
        np.concatenate([log.rewards for log in logs]),
        np.concatenate(ends),
        exploited,
        where,
        known,
        _space(logs),
        notes,
        first.record_bytes,
    )


def _need_alike(first: Log, log: Log) -> None:
    """Raise LogError unless both observe the same things."""
    one, other = _shape(first), _shape(log)
    if one != other:
        raise LogError(
            f"{log.where}: observes {other}, and {first.where} {one}: learn from them apart, or name "
            "the columns of both by columns="
        )
    if _kind(first.known) != _kind(log.known):
        raise LogError(
            f"{log.where}: its actions are {_kind(log.known)}, those of {first.where} "
            f"{_kind(first.known)}: write both alike"
        )


def _shape(log: Log) -> str:
    """What is observed, in words."""
    if log.record_bytes:
        return f"percepts of {log.record_bytes} bytes"
    if isinstance(log.before, dict):
        spelled = getattr(log.space, "columns", {})
        words = [f"{n} (words)" if spelled.get(n) is not None else str(n) for n in log.before]
        return f"the columns {', '.join(words)}"
    if isinstance(log.before, list):
        return str(log.space)
    return f"arrays {list(log.before.shape[1:])}"


def _kind(known: Actions) -> str:
    if known.words:
        return "words"
    width = 1 if known.table is None else int(np.prod(known.table.shape[1:], dtype=int))
    return "numbers" if width == 1 else f"rows of {width} numbers"


def _actions(logs: Sequence[Log], where: str) -> tuple[npt.NDArray[np.int64], Actions]:
    """The actions of all, understood as those of one log are."""
    if all(log.known.to_dict() == logs[0].known.to_dict() for log in logs):
        return np.concatenate([log.actions for log in logs]), logs[0].known
    values = np.concatenate([log.known.of_many(log.actions) for log in logs])
    if values.dtype.kind == "U":
        values = values.astype(object)
    table = Table({"action": values}, lambda i: f"interaction {i}", where, [])
    return understood(table, ["action"], np.arange(len(values)), None, None)


def _in_a_row(sides: Sequence[Any]) -> Any:
    first = sides[0]
    if isinstance(first, dict):
        return {name: np.concatenate([side[name] for side in sides]) for name in first}
    if isinstance(first, list):
        return [observation for side in sides for observation in side]
    return np.concatenate(sides)


def _space(logs: Sequence[Log]) -> Any:
    """The space of all: the words of a column are those of any log."""
    spaces = [log.space for log in logs]
    if isinstance(spaces[0], Columns):
        words: dict[str, Sequence[str] | None] = {}
        for name, listed in spaces[0].columns.items():
            every = {word for space in spaces for word in space.columns[name] or ()}
            words[name] = None if listed is None else sorted(every)
        return Columns(words)
    if isinstance(spaces[0], Flags) and not all(isinstance(space, Flags) for space in spaces):
        return Numbers(spaces[0].shape)
    return spaces[0]
