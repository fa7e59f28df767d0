# SPDX-License-Identifier: MIT
"""Logs of arrays, in memory or in an NPZ file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..errors import LogError
from ..files import open_file
from ..learning.interact import ends_of
from .log import Log, checked

_FIELDS = ("observations", "actions", "rewards", "terminated")
_OPTIONAL = ("truncated", "exploited")


def _array(values: Any, name: str, where: str) -> npt.NDArray[Any]:
    try:
        array = np.asarray(values)
    except (TypeError, ValueError) as error:
        raise LogError(f"{where}: {name}: not an array: {error}") from None
    if array.ndim == 0:
        raise LogError(f"{where}: {name}: not an array but {values!r:.80}")
    return array


def _column(
    arrays: dict[str, Any], name: str, count: int, where: str, kind: str
) -> npt.NDArray[Any]:
    values = np.asarray(arrays[name])
    if values.ndim == 2 and values.shape[1] == 1:
        values = values[:, 0]
    if values.shape != (count,):
        raise LogError(f"{where}: {name}: {list(values.shape)}, not [{count}]")
    if values.dtype.kind not in kind:
        raise LogError(f"{where}: {name}: {values.dtype}: wrong kind of numbers")
    return values


def from_arrays(arrays: dict[str, Any], where: str = "log") -> Log:
    """Make a log from arrays.

    Parameters
    ----------
    arrays : dict
        ``observations`` [sum(T + 1), ...]; ``actions``, ``rewards`` and ``terminated`` [sum(T)];
        optional ``truncated`` and ``exploited`` [sum(T)]. With ``next_observations`` [sum(T), ...],
        the observations are [sum(T), ...] as well.
    where : str
        Name of the log in errors.
    """
    for name in _FIELDS:
        if name not in arrays:
            raise LogError(
                f"{where}: {name}: missing (present: {', '.join(sorted(map(str, arrays))) or 'none'})"
            )
    known = {*_FIELDS, *_OPTIONAL, "next_observations"}
    unknown = sorted(map(str, set(arrays) - known))
    if unknown:
        raise LogError(f"{where}: {unknown[0]}: not known; allowed are {', '.join(sorted(known))}")
    arrays = {name: _array(arrays[name], name, where) for name in arrays}
    count = np.size(arrays["actions"])
    if count == 0:
        raise LogError(f"{where}: actions: there is no interaction")
    actions = _column(arrays, "actions", count, where, "iu").astype(np.int64)
    with np.errstate(over="ignore"):  # checked() refuses what is out of range
        rewards = _column(arrays, "rewards", count, where, "fiu").astype(np.float32)
    terminated = _column(arrays, "terminated", count, where, "biu").astype(np.bool_)
    truncated = np.zeros(count, np.bool_)
    if "truncated" in arrays:
        truncated = _column(arrays, "truncated", count, where, "biu").astype(np.bool_)
    exploited = None
    if "exploited" in arrays:
        exploited = _column(arrays, "exploited", count, where, "biu").astype(np.bool_)
    ends = ends_of(terminated, truncated)
    observations = np.asarray(arrays["observations"])
    if "next_observations" in arrays:
        before, after = observations, np.asarray(arrays["next_observations"])
        for name, values in (("observations", before), ("next_observations", after)):
            if len(values) != count:
                raise LogError(f"{where}: {name}: {len(values)} for {count} actions")
        if _kind(before) != _kind(after):
            raise LogError(
                f"{where}: next_observations: {after.dtype}{list(after.shape)}, expected what "
                f"observations are: {before.dtype}{list(before.shape)}"
            )
    else:
        before, after = _split_episodes(observations, ends, where)
    return checked(Log(before, after, actions, rewards, ends, exploited, where))


def _kind(observations: npt.NDArray[Any]) -> tuple[Any, ...]:
    """What the observations of a log have in common: their shape, and whether they are numbers."""
    kind = observations.dtype.kind
    return observations.shape[1:], "number" if kind in "fiu" else observations.dtype


def _split_episodes(
    observations: npt.NDArray[Any], ends: npt.NDArray[np.uint8], where: str
) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Return s and s' of each interaction, if each episode has T + 1 observations."""
    if ends[-1] == 0:
        ends[-1] = 2
    starts = np.concatenate(([0], ends[:-1] != 0))
    index = np.arange(len(ends)) + np.cumsum(starts)
    wanted = int(index[-1]) + 2
    if len(observations) != wanted:
        raise LogError(
            f"{where}: observations: {len(observations)}; {len(ends)} actions in "
            f"{int(starts.sum()) + 1} episodes need {wanted}"
        )
    return observations[index], observations[index + 1]


def from_npz(path: str | Path) -> Log:
    """Read a log from an NPZ file with the arrays of :func:`from_arrays`.

    Parameters
    ----------
    path : str or Path
    """
    try:
        with open_file(path) as file, np.load(file, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except Exception as error:  # of zipfile, of what it unpacks with, of numpy's parser
        raise LogError(f"{path}: cannot be read as NPZ: {error}") from error
    return from_arrays(arrays, str(path))
