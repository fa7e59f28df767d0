# SPDX-License-Identifier: MIT
"""Logs in CSV files."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..errors import LogError
from ..files import open_file
from ..learning.interact import ends_of
from .log import Log, checked


def from_csv(path: str | Path, columns: Sequence[str] | None = None) -> Log:
    """Read a log from a CSV file whose first line names the columns.

    Parameters
    ----------
    path : str or Path
        Columns: ``action``, ``reward``, ``terminated``; optional ``truncated``, ``exploited`` and
        ``episode``; all others are the observation before the action. The next line has the
        observation after it. A line without an action holds the last observation of an episode. An
        interaction that did not terminate and has no observation after it is left out.
    columns : sequence of str or None
        Columns of the observation. None: all others, in the order of the file.
    """
    try:
        with io.TextIOWrapper(open_file(path), encoding="utf-8", newline="") as file:
            reader = csv.reader(file, strict=True)
            head = next(reader, [])
            rows = [(reader.line_num, row) for row in reader if row]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise LogError(f"{path}: cannot be read as CSV: {error}") from error
    special = ("action", "reward", "terminated", "truncated", "exploited", "episode")
    for name in (*special[:3], *(columns or ())):
        if name not in head:
            raise LogError(
                f"{path}: line 1: no column {name} (present: {', '.join(head) or 'none'})"
            )
    if len(set(head)) != len(head):
        raise LogError(f"{path}: line 1: two columns have the same name")
    seen = list(columns) if columns else [name for name in head if name not in special]
    if not seen:
        raise LogError(f"{path}: line 1: no column for the observation")
    table = {name: np.empty(len(rows)) for name in head}
    for i, (line, row) in enumerate(rows):
        if len(row) != len(head):
            raise LogError(f"{path}: line {line}: {len(row)} fields, not {len(head)}")
        for name, text in zip(head, row, strict=True):
            table[name][i] = _number(text, name, f"{path}: line {line}")
    return _from_table(table, seen, [line for line, _ in rows], str(path))


_WORDS = {"true": 1.0, "false": 0.0, "": float("nan")}


def _number(text: str, name: str, where: str) -> float:
    word = text.strip().lower()
    if word in _WORDS:
        return _WORDS[word]
    try:
        return float(word)
    except ValueError:
        raise LogError(f"{where}: {name}: {text!r:.40} is not a number") from None


def _flags(table: dict[str, npt.NDArray[Any]], name: str, lines: list[int], where: str) -> Any:
    values = table.get(name, np.zeros(len(lines)))
    for i in np.flatnonzero(~np.isin(values, (0.0, 1.0)) & ~np.isnan(values)):
        raise LogError(f"{where}: line {lines[i]}: {name}: {values[i]} is neither 0 nor 1")
    return values == 1


def _need(
    wanted: npt.NDArray[np.bool_],
    table: dict[str, npt.NDArray[Any]],
    name: str,
    kind: str,
    lines: list[int],
    where: str,
) -> None:
    """Raise LogError unless the column has a number of that kind in each wanted row."""
    values = table[name]
    good = np.isfinite(values) & ((values % 1 == 0) if kind == "whole" else True)
    for i in np.flatnonzero(wanted & ~good):
        raise LogError(f"{where}: line {lines[i]}: {name}: {values[i]} is not a {kind} number")


def _from_table(
    table: dict[str, npt.NDArray[Any]], seen: list[str], lines: list[int], where: str
) -> Log:
    count = len(lines)
    everywhere = np.ones(count, np.bool_)
    for name in seen:
        _need(everywhere, table, name, "finite", lines, where)
    terminated = _flags(table, "terminated", lines, where)
    truncated = _flags(table, "truncated", lines, where)
    exploited = _flags(table, "exploited", lines, where)
    acted = ~np.isnan(table["action"])
    for i in np.flatnonzero(terminated & ~acted):
        raise LogError(f"{where}: line {lines[i]}: terminated without an action")
    episode = table.get("episode", np.zeros(count))
    # s' is in the next line, if that belongs to the same episode.
    same = np.append(episode[1:] == episode[:-1], False)
    last_seen = np.append(~acted[1:], False) & same
    kept = acted & (terminated | last_seen | (same & ~truncated))
    _need(kept, table, "action", "whole", lines, where)
    _need(kept, table, "reward", "finite", lines, where)
    rows = np.flatnonzero(kept)
    if len(rows) == 0:
        raise LogError(f"{where}: there is no interaction")
    ends = ends_of(terminated, truncated | last_seen)
    observations = np.stack([table[name] for name in seen], axis=1)
    following = np.minimum(rows + 1, count - 1)  # ignored where terminated
    with np.errstate(over="ignore", invalid="ignore"):  # what is out of range, checked() refuses
        actions = table["action"][rows].astype(np.int64)
        rewards = table["reward"][rows].astype(np.float32)
    return checked(
        Log(
            observations[rows],
            observations[following],
            actions,
            rewards,
            ends[rows],
            exploited[rows] if "exploited" in table else None,
            where,
            seen,
        )
    )
