# SPDX-License-Identifier: MIT
"""From a table, with a row for each interaction, to a log."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..errors import LogError
from ..learning.actions import Actions
from ..learning.encode import Columns, Flags, Numbers
from ..learning.interact import ends_of
from .actions import understood
from .log import Log, checked, counted, warn, warn_of_collapse
from .roles import Roles, roles_of

Array = npt.NDArray[Any]
_WORDS_MAX = 64  # different words of a column
_CLOCK_ROWS = 20  # so many that grow are hardly chance
_LEAK_CHANGES, _LEAK_SHARE = 10, 0.8  # where no column tells episodes apart, their ends differ
_LEAK_ROWS, _LEAK_COLUMNS = 4096, 64  # that are looked at


@dataclasses.dataclass
class Table:
    """A table: columns of n values.

    Attributes
    ----------
    columns : dict of str to ndarray [n, ...]
        Numbers, NaN where there is none, or words.
    place : callable
        Says where row i is: ``line 7``.
    where : str
        The file, for errors.
    notes : list of str
    head : str
        Where the names of the columns are, for errors.
    parts : ndarray [n] or None
        Of files joined into one: which one each row is of.
    lost : list of str
        What was left out already: it is warned of.
    """

    columns: dict[str, Array]
    place: Callable[[int], str]
    where: str
    notes: list[str]
    head: str = ""
    parts: Array | None = None
    lost: list[str] = dataclasses.field(default_factory=list)

    def wrong(self, i: int, name: str, fault: str) -> LogError:
        """An error that names the row and the column."""
        return LogError(f"{self.where}: {self.place(i)}: {name}: {fault}")


@dataclasses.dataclass
class _Rows:
    """What is known of each row, in the order of the episodes."""

    acted: npt.NDArray[np.bool_]
    terminated: npt.NDArray[np.bool_]
    truncated: npt.NDArray[np.bool_]
    same: npt.NDArray[np.bool_]  # the next row goes on


def from_table(
    table: Table,
    columns: Sequence[str] | None = None,
    bins: Any = None,
    known: Actions | None = None,
    given: Mapping[str, Any] | None = None,
) -> Log:
    """Make a log of a table.

    Parameters
    ----------
    table : Table
    columns : sequence of str or None
        Columns of the observation.
    bins : int or None
        Of actions that are real numbers: into how many they are divided.
    known : Actions or None
        The actions; None: those of the log.
    given : mapping or None
        Columns for roles, by the caller.

    Returns
    -------
    Log
    """
    head = f"{table.where}: {table.head}" if table.head else table.where
    clocks = _clocks(table)
    roles = roles_of(table.columns, head, columns, given, clocks)
    left_out = [name for name in clocks if name in roles.ignored]
    if left_out and not roles.named:
        table.notes.append(
            f"{', '.join(left_out)}: grows from row to row, so it is a clock: columns= would take it"
        )
    table = _in_order(table, roles)
    if not len(_any(table)):
        raise LogError(f"{table.where}: there is no interaction: names of columns, and no row")
    _see_ends(table, roles)
    rows = _rows(table, roles)
    if columns is None and "observation" not in (given or {}):
        _refuse_leaks(table, roles, rows)
    usable, rewarded = _usable(table, roles.seen), ~_missing(table.columns[roles.one["reward"]])
    following = bool(roles.after)
    if following:
        reached = rows.terminated | _usable(table, roles.after)
        last_seen = np.zeros_like(rows.acted)
        kept = rows.acted & usable & reached
    else:
        next_usable = np.append(usable[1:], False)
        last_seen = np.append(~rows.acted[1:], False) & rows.same
        led = rows.same & next_usable & (last_seen | ~rows.truncated)
        kept = rows.acted & usable & (rows.terminated | led)
    unrewarded = np.flatnonzero(kept & ~rewarded)
    kept &= rewarded
    chosen = np.flatnonzero(kept)
    if len(chosen) == 0:
        raise _nothing_left(table, usable, unrewarded)
    _see_infinite(table, [*roles.seen, *roles.after])
    space, before, after = _observations(table, roles, chosen, following)
    actions, meaning = understood(table, roles.actions, chosen, bins, known)
    rewards = _numbers(table, roles.one["reward"], chosen)
    rewards = rewards.astype(np.float32)
    exploited = None
    if "exploited" in roles.one:
        exploited = _flags(table, roles.one["exploited"])[chosen]
    ends = ends_of(rows.terminated, rows.truncated | last_seen)[chosen]
    notes = [*table.notes, *roles.notes()]
    log = Log(before, after, actions, rewards, ends, exploited, table.where, meaning, space, notes)
    _tell_of_rows(log, table, ~usable, "for want of an observation")
    _tell_of_rows(log, table, unrewarded, "for want of a reward")
    _tell(log, table, roles, rows, rows.acted & usable & rewarded & ~kept)
    if roles.alone:
        text = f"{', '.join(roles.alone)}: left out, as no column has the next value of it"
        warn(log, f"{text}: columns= would take it, and what is next from the next row")
    for name in roles.seen:
        warn_of_collapse(log, name, table.columns[name][chosen])
    return checked(log)


def _clocks(table: Table) -> list[str]:
    """The columns of numbers that grow from row to row: a time, or the number of a row."""
    return [
        name
        for name, values in table.columns.items()
        if values.ndim == 1
        and values.dtype.kind in "fiu"
        and len(values) >= _CLOCK_ROWS
        and (values[1:] > values[:-1]).all()
    ]


def _refuse_leaks(table: Table, roles: Roles, rows: _Rows) -> None:
    """Refuse a column that is, row by row, what another one is in the next row: the future."""
    numbers = {
        name: table.columns[name][:_LEAK_ROWS]
        for name in roles.seen
        if table.columns[name].ndim == 1 and table.columns[name].dtype.kind in "fiu"
    }
    if not 2 <= len(numbers) <= _LEAK_COLUMNS:
        return
    for name, values in numbers.items():
        changed = np.flatnonzero(rows.same[: len(values) - 1] & (values[1:] != values[:-1]))
        if len(changed) < _LEAK_CHANGES:
            continue
        for other, ahead in numbers.items():
            if other == name:
                continue
            if (ahead[changed] == values[changed + 1]).mean() > _LEAK_SHARE:
                raise LogError(
                    f"{table.where}: {other} is what {name} is in the next row: rename it to "
                    f"next_{name}, or say what is observed by columns="
                )


def _nothing_left(table: Table, usable: Array, unrewarded: Array) -> LogError:
    """An error that says why no row is an interaction."""
    fault = "there is no interaction with an observation before and after it"
    blank = np.flatnonzero(~usable)
    if len(unrewarded):
        fault = f"there is no interaction with a reward: none in {table.place(unrewarded[0])}"
    elif len(blank):
        fault += f", and none in {table.place(blank[0])}"
    return LogError(f"{table.where}: {fault}")


def _tell_of_rows(log: Log, table: Table, rows: Array, why: str) -> None:
    """Say which rows were dropped; rows is a mask, or their numbers."""
    rows = np.flatnonzero(rows) if rows.dtype == np.bool_ else rows
    if len(rows):
        first = table.place(rows[0])
        warn(log, f"{counted(len(rows), 'row')} left out, {why}, first {first}")


def _tell(log: Log, table: Table, roles: Roles, rows: _Rows, lost: Array) -> None:
    """Say which interactions were dropped, and how episodes end."""
    for text in table.lost:
        warn(log, text)
    lost, count = np.flatnonzero(lost), len(rows.acted)
    if len(lost):
        text = (
            f"{counted(len(lost), 'interaction')} left out, as what was observed next is not in the "
            f"log, first {table.place(lost[0])}: a row without an action after each episode, or columns "
            "next_..., would give it"
        )
        if len(lost) == 1 and lost[0] >= count - 2:
            log.notes.append(text)  # the last one of a log that goes on
        else:
            warn(log, text)
    if not rows.terminated.any() and not rows.truncated.any() and rows.same[:-1].all():
        _tell_of_ends(log, bool({"terminated", "done", "truncated"} & set(roles.one)))


def _tell_of_ends(log: Log, told: bool) -> None:
    """Say that no episode ends, or that episodes end and nothing says how."""
    breaks = 0
    if isinstance(log.before, dict):
        differ = [
            a[:-1] != b[1:] for a, b in zip(log.after.values(), log.before.values(), strict=True)
        ]
        breaks = int(np.any(differ, axis=0).sum())
    elif isinstance(log.before, np.ndarray):
        differ = log.after[:-1] != log.before[1:]
        breaks = int(differ.any(axis=tuple(range(1, differ.ndim))).sum())
    if breaks and told:
        log.notes.append(f"no episode ends; after {breaks} rows the next one is of another time")
    elif breaks:
        warn(
            log,
            f"{counted(breaks, 'episode')} broken off, and no column says whether they terminated: "
            "taken as truncated; a column terminated would tell",
        )
    else:
        log.notes.append("no episode ends: taken as one that goes on")


# ------------------------------------------------------------------ rows and episodes


def _in_order(table: Table, roles: Roles) -> Table:
    """Bring the rows of each episode together, in the order of their steps."""
    name = roles.one.get("episode")
    if name is None:
        return table
    values = table.columns[name]
    if values.ndim != 1:
        raise LogError(f"{table.where}: {name}: {list(values.shape)}, expected one for each row")
    texts = values if values.dtype.kind in "fiu" else values.astype(str)
    _, codes = np.unique(texts, return_inverse=True)
    if table.parts is not None:
        codes = codes + table.parts * (codes.max() + 1)
    _, first, codes = np.unique(codes, return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first))[codes]  # by first appearance
    step = table.columns.get(roles.one.get("step", ""), np.zeros(len(codes)))
    if step.ndim != 1 or step.dtype.kind not in "fiu":
        step = np.zeros(len(codes))
    order = np.lexsort((np.arange(len(codes)), step, rank))
    if (order == np.arange(len(order))).all():
        return table
    if (np.diff(rank) < 0).any():
        table.notes.append(f"rows of several episodes alternate: put in order by {name}")
    else:
        table.notes.append(f"rows are put in order by {roles.one['step']}")
    moved = {key: column[order] for key, column in table.columns.items()}
    place, parts = table.place, None if table.parts is None else table.parts[order]
    return dataclasses.replace(
        table, columns=moved, place=lambda i: place(int(order[i])), parts=parts
    )


def _see_ends(table: Table, roles: Roles) -> None:
    """Where nothing tells of ends, a column t of 0 and 1 is terminated, and not a step."""
    name = roles.one.get("step", "")
    if set(roles.one) & {"terminated", "done", "truncated", "first", "last", "episode"}:
        return
    if name.lower() == "t" and np.isin(table.columns[name], (0, 1)).all():
        roles.one["terminated"] = roles.one.pop("step")
        table.notes.append(f"{name}: 0 and 1, so it tells of ends")


def _rows(table: Table, roles: Roles) -> _Rows:
    one = roles.one
    count = len(_any(table))
    none = np.zeros(count, np.bool_)
    acted = np.ones(count, np.bool_)
    for name in roles.actions:
        acted &= ~_missing(table.columns[name])
    truncated = _flags(table, one["truncated"]) if "truncated" in one else none
    terminated = _flags(table, one["terminated"]) if "terminated" in one else none
    if "done" in one:
        terminated = terminated | (_flags(table, one["done"]) & ~truncated)
        if "terminated" in one:  # done says that an episode ended, terminated why
            over = _flags(table, one["done"])
            terminated = _flags(table, one["terminated"])
            truncated = truncated | (over & ~terminated)
    elif not {"terminated", "truncated", "first", "last", "episode"} & set(one) and not roles.after:
        raise LogError(
            f"{table.where}: {table.head + ': ' if table.head else ''}no column terminated (present: "
            f"{', '.join(table.columns)}): name it so, or done or episode, or say which it is by "
            "roles={'terminated': ...}; 0 everywhere if nothing ends"
        )
    if roles.after and not {"terminated", "done", "truncated", "last"} & set(one):
        terminated = _without_next(table, roles, acted)
    same = np.ones(count, np.bool_)
    if "episode" in one:
        episode = table.columns[one["episode"]]
        same = np.append(episode[1:] == episode[:-1], False)
    elif "step" in one and table.columns[one["step"]].dtype.kind in "fiu":
        step = table.columns[one["step"]].reshape(count, -1)[:, 0]
        same = np.append(np.diff(step) > 0, False)
    if "first" in one:
        same &= ~np.append(_flags(table, one["first"])[1:], True)
    if "last" in one:
        acted, terminated, truncated = _last(table, one, acted, terminated, truncated)
    if table.parts is not None:
        same &= ~np.append(np.diff(table.parts) != 0, False)
    same[-1] = False
    bad = np.flatnonzero(terminated & ~acted)
    if len(bad):
        raise LogError(f"{table.where}: {table.place(bad[0])}: terminated without an action")
    # After an end the next row is of another episode; a row without an action is its last observation.
    same &= ~terminated & ~(truncated & np.append(acted[1:], True))
    return _Rows(acted, terminated, truncated, same)


def _without_next(table: Table, roles: Roles, acted: Array) -> npt.NDArray[np.bool_]:
    """Where nothing says how an episode ends, None or a blank as the next observation does."""
    over = acted & _usable(table, roles.seen) & ~_usable(table, roles.after)
    if over.any():
        table.notes.append(
            f"{counted(int(over.sum()), 'interaction')} without a next observation: taken as terminated"
        )
    return over


def _last(
    table: Table, one: dict[str, str], acted: Array, terminated: Array, truncated: Array
) -> tuple[Array, Array, Array]:
    """RLDS: an episode's last step has its last observation, and says how the step before ended."""
    last = _flags(table, one["last"])
    ended = np.append(last[1:], False)
    terminal = np.append((last & terminated)[1:], False)
    table.notes.append(f"{one['last']}: such a step has an observation, and no action that counts")
    return acted & ~last, terminal, (truncated & ~last) | (ended & ~terminal)


# ------------------------------------------------------------------ values


def _missing(values: Array) -> npt.NDArray[np.bool_]:
    if values.dtype.kind == "f":
        return np.asarray(np.isnan(values.reshape(len(values), -1)).all(axis=1))
    if values.dtype.kind in "OU":
        return np.array([value is None or value == "" for value in values.ravel()[: len(values)]])
    return np.zeros(len(values), np.bool_)


def _flags(table: Table, name: str) -> npt.NDArray[np.bool_]:
    values = table.columns[name]
    if values.ndim == 2 and values.shape[1] == 1:
        values = values[:, 0]
    if values.ndim == 1 and values.dtype.kind in "OU":
        return _word_flags(table, name, values)
    if values.ndim != 1 or values.dtype.kind not in "bfiu":
        raise LogError(
            f"{table.where}: {name}: {values.dtype}{list(values.shape)} are no flags 0 or 1"
        )
    bad = np.flatnonzero(~np.isin(values, (0, 1)) & ~_missing(values))
    if len(bad):
        raise table.wrong(bad[0], name, f"{values[bad[0]]} is neither 0 nor 1")
    return np.asarray(values == 1)


def _word_flags(table: Table, name: str, values: Array) -> npt.NDArray[np.bool_]:
    """A word where it holds, and a blank where it does not."""
    blank = _missing(values)
    words = sorted({str(value) for value in values[~blank]})
    if len(words) != 1 or not blank.any():
        raise LogError(
            f"{table.where}: {name}: words ({', '.join(words[:4])}) are no flags: write 1 where it "
            "holds, else 0"
        )
    return ~blank


def _numbers(table: Table, name: str, rows: Array) -> Array:
    values = table.columns[name]
    if values.ndim == 2 and values.shape[1] == 1:
        values = values[:, 0]
    if values.ndim == 1 and values.dtype.kind in "OU":
        raise table.wrong(rows[0], name, f"{values[rows[0]]!r:.40} is not a number")
    if values.ndim != 1 or values.dtype.kind not in "bfiu":
        raise LogError(f"{table.where}: {name}: {values.dtype}{list(values.shape)} are no numbers")
    bad = rows[~np.isfinite(values[rows].astype(np.float64))]
    if len(bad):
        raise table.wrong(bad[0], name, f"{values[bad[0]]} is not a finite number")
    large = rows[np.abs(values[rows].astype(np.float64)) > _native.REWARD_MAX]
    if len(large):
        raise table.wrong(
            large[0], name, f"{values[large[0]]} is not in [-1e12, 1e12]: scale the rewards"
        )
    return values[rows]


def _usable(table: Table, names: list[str]) -> npt.NDArray[np.bool_]:
    """Which rows have an observation: no number in it is missing."""
    usable = np.ones(len(table.columns[names[0]]), np.bool_)
    for name in names:
        values = table.columns[name]
        if values.dtype.kind == "f":
            flat = values.reshape(len(values), -1).astype(np.float64)
            large = (np.abs(flat) > _native.THRESHOLDS_NUMBER_MAX) & np.isfinite(flat)
            bad = np.flatnonzero(large.any(axis=1))
            if len(bad):
                raise table.wrong(bad[0], name, f"{values[bad[0]]} is beyond 1e15: scale it")
            usable &= ~np.isnan(flat).any(axis=1)
        elif values.dtype.kind in "OU":
            usable &= ~_missing(values)
    return usable


def _see_infinite(table: Table, names: list[str]) -> None:
    """Say where a number is infinite: it is clipped, as one of an environment is."""
    for name in names:
        if table.columns[name].dtype.kind == "f":
            endless = np.isinf(table.columns[name]).reshape(len(_any(table)), -1)
            if endless.any():
                first = table.place(np.flatnonzero(endless.any(axis=1))[0])
                text = f"{name}: {counted(int(endless.sum()), 'infinite number')} taken as 1e15"
                table.notes.append(f"{text} or -1e15, as of an environment, first {first}")


def _observations(
    table: Table, roles: Roles, chosen: Array, following: bool
) -> tuple[Any, Any, Any]:
    """The space, and the observations before and after the chosen rows."""
    after_rows = chosen if following else np.minimum(chosen + 1, len(_any(table)) - 1)
    after_names = roles.after if following else roles.seen
    only = table.columns[roles.seen[0]]
    if len(roles.seen) == 1 and only.ndim > 1 and only.dtype.kind in "bfiu":
        after = table.columns[after_names[0]]
        if after.shape[1:] != only.shape[1:]:
            raise LogError(
                f"{table.where}: {after_names[0]}: {list(after.shape)}, expected what "
                f"{roles.seen[0]} is: {list(only.shape)}"
            )
        kind = Flags if only.dtype.kind == "b" and after.dtype.kind == "b" else Numbers
        return kind(only.shape[1:]), only[chosen], _filled(after[after_rows])
    words: dict[str, Sequence[str] | None] = {}
    before, after_all = {}, {}
    for name, after_name in zip(roles.seen, after_names, strict=True):
        first, second = table.columns[name], table.columns[after_name]
        if first.ndim != second.ndim or first.shape[1:] != second.shape[1:]:
            raise LogError(f"{table.where}: {after_name}: {list(second.shape)}, unlike {name}")
        for label, one, other in _expanded(name, first, second):
            if one.dtype.kind in "OU":
                words[label] = _words(table, label, one[chosen], other[after_rows])
                before[label], after_all[label] = one[chosen], other[after_rows]
            else:
                words[label] = None
                before[label], after_all[label] = one[chosen], _filled(other[after_rows])
    return Columns(words), before, after_all


def _any(table: Table) -> Array:
    return next(iter(table.columns.values()))


def _filled(values: Array) -> Array:
    """0 in place of what is missing after a terminated interaction, which nobody reads."""
    return np.where(np.isnan(values), 0, values) if values.dtype.kind == "f" else values


def _expanded(name: str, first: Array, second: Array) -> Any:
    """The numbers of an array column, each as a column."""
    if first.ndim == 1:
        yield name, first, second
        return
    flat, other = first.reshape(len(first), -1), second.reshape(len(second), -1)
    for i in range(flat.shape[1]):
        yield (f"{name}[{i}]" if flat.shape[1] > 1 else name), flat[:, i], other[:, i]


def _words(table: Table, name: str, before: Array, after: Array) -> list[str]:
    found = sorted({str(word) for word in (*before, *after) if word is not None and word != ""})
    if len(found) > _WORDS_MAX:
        raise LogError(
            f"{table.where}: {name}: {len(found)} different words, more than {_WORDS_MAX}: leave the "
            "column out by columns="
        )
    table.notes.append(f"{name}: words {', '.join(found)}")
    return found
