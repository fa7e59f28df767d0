# SPDX-License-Identifier: MIT
"""The actions of a log: numbers, words, one-hot rows, or real numbers that are divided into a grid."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..checks import whole
from ..errors import ConfigError, LogError
from ..learning.actions import MOST, Actions, indices_of

if TYPE_CHECKING:
    from .table import Table

Array = npt.NDArray[Any]
_GRID_MAX, _GRID_ROWS = 32, 8  # real numbers are a grid: at most so many, each in so many rows


def understood(
    table: Table, names: list[str], rows: Array, bins: Any, known: Actions | None
) -> tuple[npt.NDArray[np.int64], Actions]:
    """Return the numbers of the actions of some rows, and what they mean.

    Parameters
    ----------
    table : Table
    names : list of str
        The columns of the action.
    rows : ndarray of int
    bins : int or None
        Of real numbers: into how many each element is divided.
    known : Actions or None
        The actions; None: those of the log.
    """
    parts = [table.columns[name][rows] for name in names]
    label = names[0] if len(names) == 1 else ", ".join(names)
    if any(part.dtype.kind in "OU" for part in parts):
        return _of_words(table, label, parts, rows)
    values = _joined(table, label, parts)
    if values.dtype.kind == "f":
        bad = np.flatnonzero(~np.isfinite(values.reshape(len(values), -1)).all(axis=1))
        if len(bad):
            raise table.wrong(rows[bad[0]], label, f"{values[bad[0]]} is not a finite number")
    if known is not None:
        return indices_of(values, known, table.where), known
    if bins is not None:
        return _in_bins(values, bins)
    if values.ndim == 2 and _one_hot(values):
        table.notes.append(f"{label}: rows of one 1 among 0: its place is the action")
        return values.argmax(axis=1).astype(np.int64), Actions(values.shape[1])
    return _of_numbers(table, label, values, rows)


def _joined(table: Table, label: str, parts: list[Array]) -> Array:
    flat = [part.reshape(len(part), -1) for part in parts]
    values = np.concatenate(flat, axis=1)
    if values.dtype.kind not in "bfiu" or values.shape[1] == 0:
        raise LogError(f"{table.where}: {label}: {values.dtype}{list(values.shape)} are no numbers")
    return values[:, 0] if values.shape[1] == 1 else values


def _one_hot(values: Array) -> bool:
    return bool(np.isin(values, (0, 1)).all() and (values.sum(axis=1) == 1).all())


def _of_words(
    table: Table, label: str, parts: list[Array], rows: Array
) -> tuple[npt.NDArray[np.int64], Actions]:
    if len(parts) > 1 or parts[0].ndim > 1:
        raise LogError(f"{table.where}: {label}: words in several columns: join them into one")
    texts = [str(value) for value in parts[0]]
    words = sorted(set(texts))
    if len(words) > MOST:
        raise LogError(f"{table.where}: {label}: {len(words)} different words, more than {MOST}")
    index = {word: i for i, word in enumerate(words)}
    return np.array([index[text] for text in texts], np.int64), Actions(len(words), words=words)


def _in_bins(values: Array, bins: Any) -> tuple[npt.NDArray[np.int64], Actions]:
    """The nearest of a grid from the least to the greatest number."""
    rows = values.reshape(len(values), -1).astype(np.float64)
    number = whole("bins", bins, 2, MOST)
    if number ** rows.shape[1] > MOST:
        raise ConfigError(
            f"bins: {number ** rows.shape[1]} actions, more than {MOST}: use fewer bins"
        )
    low, high = rows.min(axis=0), rows.max(axis=0)
    width = np.where(high > low, high - low, 1.0)
    places = np.rint((rows - low) / width * (number - 1)).astype(np.int64)
    index = np.zeros(len(rows), np.int64)
    for column in places.T:
        index = index * number + column
    grids = np.meshgrid(
        *(np.linspace(a, b, number) for a, b in zip(low, high, strict=True)), indexing="ij"
    )
    table = np.stack([grid.ravel() for grid in grids], axis=1).astype(np.float32)
    return index, Actions(len(table), table=table if values.ndim > 1 else table[:, 0])


def _of_numbers(
    table: Table, label: str, values: Array, rows: Array
) -> tuple[npt.NDArray[np.int64], Actions]:
    flat = values.reshape(len(values), -1)
    if values.dtype.kind == "f":
        bad = np.flatnonzero((flat % 1 != 0).any(axis=1))
        if len(bad) and _few(flat):
            return _distinct(table, label, values)
        if len(bad):
            raise table.wrong(
                rows[bad[0]],
                label,
                f"{values[bad[0]]} is not a whole number: pass bins= to divide real numbers into a grid",
            )
    if flat.shape[1] > 1:
        return _distinct(table, label, flat)
    numbers = flat[:, 0]
    low, high, count = int(numbers.min()), int(numbers.max()), len(np.unique(numbers))
    if count == high - low + 1 <= MOST and low != 0:
        table.notes.append(f"{label}: numbers from {low} to {high}")
        return (numbers - low).astype(np.int64), Actions(count, low)
    if low >= 0 and high < MOST:
        return numbers.astype(np.int64), Actions(high + 1)
    return _distinct(table, label, numbers)


def _few(rows: Array) -> bool:
    """Whether real numbers are of a grid, and not measured: few, and each occurs often."""
    count = len(np.unique(rows, axis=0))
    return count <= _GRID_MAX and len(rows) >= _GRID_ROWS * count


def _distinct(table: Table, label: str, values: Array) -> tuple[npt.NDArray[np.int64], Actions]:
    """Each combination of numbers that occurs is an action."""
    found, index = np.unique(values, axis=0, return_inverse=True)
    if len(found) > MOST:
        raise LogError(
            f"{table.where}: {label}: {len(found)} different actions, more than {MOST}: pass bins= to "
            "divide them into a grid"
        )
    table.notes.append(f"{label}: {len(found)} different values are the actions")
    if found.dtype.kind == "u" or (found.dtype.kind == "f" and (found % 1 == 0).all()):
        most = max(int(found.max()), -int(found.min()))
        if most >= 2**63:
            raise LogError(f"{table.where}: {label}: {most:.4g} is beyond a number of 64 bits")
        found = found.astype(np.int64)
    return index.ravel().astype(np.int64), Actions(len(found), table=found)
