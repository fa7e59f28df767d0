# SPDX-License-Identifier: MIT
"""Logs of arrays: in memory, of episodes, or in HDF5."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..checks import shown
from ..errors import LogError
from ..files import open_file
from ..learning.actions import Actions
from .log import Log
from .roles import roles_of
from .table import Array, Table, from_table
from .values import MISSING, is_value


def from_arrays(
    arrays: Mapping[str, Any],
    where: str = "log",
    columns: Sequence[str] | None = None,
    bins: int | None = None,
    known: Actions | None = None,
    roles: Mapping[str, Any] | None = None,
) -> Log:
    """Make a log of arrays with an element for each interaction.

    Parameters
    ----------
    arrays : dict
        ``observations`` [n, ...], ``actions``, ``rewards`` and ``terminated`` [n], and others:
        :mod:`rlvc.logs.roles` lists their names. The next observation is in ``next_observations``, or
        in the next element; or else observations are [n + episodes, ...], with one after the last
        interaction of each episode.
    where : str
        Name of the log in errors.
    columns : sequence of str or None
        Names of the arrays that are the observation.
    bins : int or None
        Of actions that are real numbers: into how many they are divided.
    known : Actions or None
        The actions; None: those of the log.
    roles : mapping or None
        Columns for roles, as for :func:`rlvc.learn_from`.
    """
    notes: list[str] = []
    values, faults = _arrays(_in_a_row(arrays, where, notes), where)
    found = roles_of([*values, *faults], where, columns, roles)
    for name in (*found.one.values(), *found.actions, *found.seen, *found.after):
        if name in faults:
            raise faults[name]
    count = len(values[found.actions[0]])
    if count == 0:
        raise LogError(f"{where}: actions: there is no interaction")
    if not found.after and all(len(values[name]) > count for name in found.seen):
        roles_after = _next_of_episodes(values, found, count, where)
        values |= roles_after
        notes.append("an observation after the last interaction of each episode")
    used = {*found.one.values(), *found.actions, *found.seen, *found.after}
    used |= {f"next_{name}" for name in found.seen if f"next_{name}" in values}
    for name in used:
        if len(values[name]) != count:
            raise LogError(f"{where}: {name}: {list(values[name].shape)} for {count} actions")
    kept = {name: column for name, column in values.items() if name in used or len(column) == count}
    other = [f"{name} {list(values[name].shape)}" for name in values if name not in kept]
    if other:
        notes.append(f"not one for each interaction, so ignored: {', '.join(other)}")
    return from_table(
        Table(kept, lambda i: f"index {i}", where, notes), columns, bins, known, roles
    )


def _in_a_row(arrays: Mapping[Any, Any], where: str, notes: list[str]) -> dict[str, Any]:
    """The arrays, those of several episodes each joined into one, with the episodes' numbers."""
    flat = dict(_flat(arrays))
    parts = {name: found for name, value in flat.items() if (found := _episodes_of(value))}
    counts = {
        len(value) for name, value in flat.items() if name not in parts and _has_length(value)
    }
    if not parts or {len(found) for found in parts.values()} & counts:
        return flat
    sizes = {name: np.array([len(part) for part in found]) for name, found in parts.items()}
    lengths = min(sizes.values(), key=lambda each: int(each.sum()))
    if lengths.sum() - len(lengths) in counts:
        lengths = lengths - 1  # observations alone, with the last one of each episode
    for name, found in parts.items():
        try:
            flat[name] = np.concatenate(found)
        except ValueError as error:
            raise LogError(f"{where}: {name}: {error}") from None
    notes.append(f"{len(lengths)} episodes, each in an array of its own")
    return {"episode": np.repeat(np.arange(len(lengths)), lengths), **flat}


def _has_length(value: Any) -> bool:
    return isinstance(value, list) or (isinstance(value, np.ndarray) and value.ndim > 0)


def _episodes_of(value: Any) -> list[Array] | None:
    """The arrays of several lengths in a list or an array of objects; None: it is something else."""
    listed = value.dtype == object if isinstance(value, np.ndarray) else isinstance(value, list)
    if not listed or not all(isinstance(part, list | tuple | np.ndarray) for part in value):
        return None
    try:
        found = [np.asarray(part) for part in value]
    except ValueError:
        return None
    lengths = {len(part) if part.ndim else -1 for part in found}
    return found if len(lengths) > 1 and -1 not in lengths else None


def _arrays(arrays: Mapping[Any, Any], where: str) -> tuple[dict[str, Array], dict[str, LogError]]:
    """What is an array, and why others are none: no matter, if nobody needs them."""
    values, faults = {}, {}
    for name, value in _flat(arrays):
        try:
            values[name] = _array(value, name, where)
        except LogError as error:
            faults[name] = error
    return values, faults


_DEEPEST = 30


def _flat(arrays: Mapping[Any, Any], start: str = "") -> Iterator[tuple[str, Any]]:
    """The arrays of dicts in dicts, by names such as observations.x."""
    if start.count(".") > _DEEPEST:
        raise LogError(f"log: {start[:60]}: dicts in dicts without an end")
    for key, value in arrays.items():
        name = f"{start}{key}"
        if name.startswith("__"):
            continue  # of MATLAB
        if isinstance(value, np.ndarray) and value.dtype.names:
            value = {field: value[field] for field in value.dtype.names}
        if isinstance(value, Mapping):
            yield from _flat(value, f"{name}.")
        else:
            yield name, value


def _array(values: Any, name: str, where: str) -> Array:
    try:
        if hasattr(values, "to_numpy"):
            values = values.to_numpy()
        if np.ma.is_masked(values):  # what is masked is missing
            values = np.ma.filled(np.ma.asarray(values, np.float64), np.nan)
        array = np.asarray(values)
        if array.dtype == object:
            array = _plainer(array)
        elif array.dtype.kind == "U":
            array = _spelled(array)
    except Exception as error:  # also what an object of the caller's raises
        raise LogError(f"{where}: {name}: not an array: {error}") from error
    if array.ndim == 0:
        packed = ": write it unpacked" if isinstance(values, str | bytes) else ""
        raise LogError(f"{where}: {name}: not an array but {shown(values)}{packed}")
    if array.dtype.kind not in "bfiuUO" or (array.ndim > 1 and array.shape[1:].count(0)):
        raise LogError(
            f"{where}: {name}: {array.dtype}{list(array.shape)}: no numbers and no words"
        )
    return array


def _plainer(array: Array) -> Array:
    """Objects as numbers or words: None and pandas' NA are missing."""
    listed = [None if _is_missing(value) else value for value in array.ravel()]
    words = [isinstance(value, str) for value in listed if value is not None]
    if words and all(words):
        return _spelled(np.array(listed, object).reshape(array.shape))
    numbers = [np.nan if value is None else value for value in listed]
    first = next((value for value in listed if value is not None), None)
    if isinstance(first, list | tuple | np.ndarray):
        shape = np.shape(first)
        rows = [np.full(shape, np.nan) if v is None else np.asarray(v, float) for v in listed]
        if any(row.shape != shape for row in rows):
            raise ValueError("arrays of several shapes: give each episode's observations one shape")
        return np.stack(rows)
    return np.array(numbers, np.float64).reshape(array.shape)


def _spelled(array: Array) -> Array:
    """Texts that are numbers, all of them, as such; blanks are missing."""
    texts = ["" if value is None else value.strip() for value in array.ravel().tolist()]
    if not any(texts) or not all(is_value(text) for text in texts):
        return array
    numbers = [np.nan if text.lower() in MISSING else float(text) for text in texts]
    return np.array(numbers).reshape(array.shape)


def _is_missing(value: Any) -> bool:
    return value is None or type(value).__name__ in ("NAType", "NaTType")


def _next_of_episodes(
    values: dict[str, Array], roles: Any, count: int, where: str
) -> dict[str, Array]:
    """Take observations [n + episodes] apart: those before and after each interaction."""
    ends = np.zeros(count, np.bool_)
    for role in ("terminated", "done", "truncated"):
        if role in roles.one and len(values[roles.one[role]]) == count:
            flags = values[roles.one[role]].reshape(count, -1)[:, 0]
            if flags.dtype.kind not in "bfiu":
                raise LogError(f"{where}: {roles.one[role]}: {flags.dtype}: no flags 0 or 1")
            ends |= flags == 1
    episode = values.get(roles.one.get("episode", ""))
    if episode is not None and len(episode) == count:
        ends[:-1] |= episode[1:] != episode[:-1]
    ends[-1] = True
    index = np.arange(count) + np.concatenate(([0], np.cumsum(ends[:-1])))
    wanted = int(index[-1]) + 2
    found: dict[str, Array] = {}
    for name in roles.seen:
        if len(values[name]) != wanted:
            raise LogError(
                f"{where}: {name}: {len(values[name])}; {count} actions in {int(ends.sum())} episodes "
                f"need {wanted}, or {count} with next observations in the next element"
            )
        found |= {name: values[name][index], f"next_{name}": values[name][index + 1]}
    return found


def _of_all(name: str, episode: dict[str, Any]) -> Any:
    """An episode's array; of one flag for all, whether its last interaction ended it."""
    values = np.asarray(episode[name])
    count = len(episode.get("actions", episode.get("action", ())))
    if (
        values.ndim == 0
        and values.dtype.kind in "biu"
        and name.startswith(("term", "trunc", "timeout"))
    ):
        return np.append(np.zeros(max(count - 1, 0), np.bool_), bool(values))
    return values


def from_hdf5(path: str | Path, **arguments: Any) -> Log:
    """Read a log from an HDF5 file: of D4RL, d3rlpy, robomimic or Minari.

    Parameters
    ----------
    path : str or Path
        With arrays as of :func:`from_arrays`, or a group or numbered arrays for each episode.
    **arguments
        Of :func:`from_arrays`.
    """
    try:
        import h5py
    except ImportError:
        raise ImportError("HDF5 files need h5py: pip install 'rlvc[logs]'") from None
    arrays: dict[str, Any] = {}

    def take(name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset) and item.dtype.kind in "bfiu":
            arrays[name] = item[()]

    try:
        open_file(path).close()  # a regular file
        with h5py.File(path, "r") as file:
            file.visititems(take)
    except (OSError, RuntimeError, ValueError, KeyError) as error:
        raise LogError(f"{path}: cannot be read as HDF5: {error}") from error
    return from_episodes(_by_episode(arrays), str(path), **arguments)


def _by_episode(arrays: dict[str, Any]) -> list[dict[str, Any]]:
    """Sort arrays into episodes: groups (episode_3/actions) or numbers (actions_3); or all in one."""
    episodes: dict[int, dict[str, Any]] = {}
    whole: dict[str, Any] = {}
    arrays = {path: array for path, array in arrays.items() if np.ndim(array) or "_" in path}
    for path, array in arrays.items():
        parts = path.split("/")
        number = next((m for part in parts[:-1] if (m := re.fullmatch(r"\D*?_?(\d+)", part))), None)
        numbered = re.fullmatch(r"(.+)_(\d+)", parts[-1])
        if number is not None:
            at = next(i for i, part in enumerate(parts) if part == number[0])
            episodes.setdefault(int(number[1]), {})["/".join(parts[at + 1 :])] = array
        elif numbered:
            episodes.setdefault(int(numbered[2]), {})[numbered[1]] = array
        else:
            whole[path] = array
    listed = [episodes[i] for i in sorted(episodes)]
    if any("actions" in episode or "action" in episode for episode in listed):
        return [episode for episode in listed if len(episode) > 1]
    return [{path: array for path, array in arrays.items() if np.ndim(array)}]


def from_episodes(episodes: list[dict[str, Any]], where: str, **arguments: Any) -> Log:
    """Make a log of episodes, each a dict of arrays: one after the other, with their numbers.

    Parameters
    ----------
    episodes : list of dict of arrays
    where : str
    **arguments
        Of :func:`from_arrays`.
    """
    if not episodes:
        raise LogError(f"{where}: there is no interaction")
    if len(episodes) == 1:
        return from_arrays(episodes[0], where, **arguments)
    names = set.intersection(*(set(episode) for episode in episodes))
    joined: dict[str, Any] = {}
    lengths = None
    for name in sorted(names):
        try:
            joined[name] = np.concatenate([_of_all(name, episode) for episode in episodes])
        except (TypeError, ValueError):
            continue  # single values, or shapes that differ: no array of the log
        if name in ("actions", "action"):
            lengths = [len(episode[name]) for episode in episodes]
    if lengths is None:
        raise LogError(
            f"{where}: no column action in each episode (present: {', '.join(sorted(names))})"
        )
    joined["episode"] = np.repeat(np.arange(len(episodes)), lengths)
    return from_arrays(joined, where, **arguments)
