# SPDX-License-Identifier: MIT
"""Logs of lists, dicts and arrays, in memory or in JSON, JSON Lines, pickles, NPY and NPZ."""

from __future__ import annotations

import collections
import dataclasses
import json
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..checks import shown
from ..errors import LogError
from .array_log import from_arrays, from_episodes
from .content import as_file, text_of, why_no_arrays
from .log import Log, warn
from .pickled import array_of, unpickled

_LISTS = ("episodes", "trajectories", "transitions", "steps", "data")
_ROWS = (list, tuple, collections.deque)


def from_objects(
    found: Any, where: str = "log", header: Sequence[str] | None = None, **arguments: Any
) -> Log:
    """Make a log of a list of interactions or of episodes, or of a dict of arrays.

    Parameters
    ----------
    found : list or dict
        A list of interactions: dicts, named tuples, dataclasses, or rows by ``header``; a list of
        episodes, each a dict of arrays or a list of interactions; or a dict of arrays.
    where : str
        Name of the log in errors.
    header : sequence of str or None
        The names of the elements of rows that have none.
    **arguments
        Of :func:`rlvc.logs.from_arrays`.
    """
    found, header = _unwrapped(found, header)
    if isinstance(found, Mapping):
        return from_arrays(found, where, **arguments)
    if isinstance(found, np.ndarray):
        return from_arrays(_columns_of(found, header, where), where, **arguments)
    if not isinstance(found, _ROWS):
        raise LogError(
            f"{where}: is no list of interactions: give each as an object of its columns"
        )
    rows = [_plain(row) for row in found]
    if not rows:
        raise LogError(f"{where}: there is no interaction")
    rows = _flat(rows, header)
    if header is None and isinstance(rows[0], _ROWS):
        raise LogError(
            f"{where}: rows without names: pass header=[...], the {len(rows[0])} names, such as "
            "state, action, reward, next_state, done"
        )
    if isinstance(rows[0], _ROWS):
        assert header is not None
        bad = next((i for i, row in enumerate(rows) if len(row) != len(header)), None)
        if bad is not None:
            raise LogError(f"{where}: index {bad}: {len(rows[bad])} fields, not {len(header)}")
        rows = [dict(zip(header, row, strict=True)) for row in rows]
    bad = next((i for i, row in enumerate(rows) if not isinstance(row, Mapping)), None)
    if bad is not None:
        raise LogError(f"{where}: index {bad}: {shown(rows[bad])} is no object of columns")
    if _is_episode(rows[0]):
        return from_episodes(rows, where, **arguments)
    rows = [_in_one(row) for row in rows]
    names = list(dict.fromkeys(str(name) for row in rows for name in row))
    columns = {name: _column([row.get(name) for row in rows]) for name in names}
    return from_arrays(columns, where, **arguments)


def _unwrapped(found: Any, header: Sequence[str] | None) -> tuple[Any, Sequence[str] | None]:
    """The list in a dict; a dict of columns of which each is a dict by rows as one of lists."""
    if not isinstance(found, Mapping):
        return found, header
    if isinstance(found.get("columns"), list) and isinstance(found.get("data"), list):
        return found["data"], header or [str(name) for name in found["columns"]]
    inner = next((found[name] for name in _LISTS if isinstance(found.get(name), list)), None)
    if inner is not None:
        return inner, header
    values = list(found.values())
    if len(values) > 1 and all(isinstance(value, Mapping) for value in values):
        keys = list(values[0])
        if keys and all(str(key).isdigit() for key in keys):
            return {k: [v.get(key) for key in keys] for k, v in found.items()}, header
        if all(str(key).isdigit() for key in found):
            return values, header  # episodes by their numbers
    return found, header


def _columns_of(array: Any, header: Sequence[str] | None, where: str) -> dict[str, Any]:
    """The columns of an array of records, or of rows."""
    if array.dtype.names:
        return {name: array[name] for name in array.dtype.names}
    if array.ndim != 2:
        raise LogError(f"{where}: one array {list(array.shape)}: save a dict of them as NPZ")
    if header is None:
        raise LogError(
            f"{where}: rows without names: pass header=[...], the {array.shape[1]} names"
        )
    if len(header) != array.shape[1]:
        raise LogError(f"{where}: {array.shape[1]} columns, not {len(header)}")
    return {str(name): array[:, i] for i, name in enumerate(header)}


def _plain(row: Any) -> Any:
    """A named tuple, a dataclass or an object with fields as a dict."""
    if hasattr(row, "_asdict"):
        return row._asdict()
    if dataclasses.is_dataclass(row) and not isinstance(row, type):
        return {field.name: getattr(row, field.name) for field in dataclasses.fields(row)}
    steps = next((row[name] for name in _LISTS if isinstance(row.get(name), list)), None) if (
        isinstance(row, Mapping)
    ) else None  # fmt: skip
    return row if steps is None else list(steps)


def _flat(rows: list[Any], header: Sequence[str] | None) -> list[Any]:
    """Interactions in lists of episodes one after the other, with the number of the episode."""
    first = rows[0]
    if not isinstance(first, _ROWS) or not first or not isinstance(_plain(first[0]), Mapping):
        return rows
    return [
        {"episode": number, **_plain(step)}
        for number, steps in enumerate(rows)
        for step in steps
        if isinstance(_plain(step), Mapping)
    ]


def _is_episode(row: Mapping[str, Any]) -> bool:
    """Whether an object is an episode: its rewards are a list."""
    rewards = next((row[name] for name in ("rewards", "reward", "rews", "rew") if name in row), 0)
    return (np.ndim(rewards) == 1 and np.size(rewards) > 1) or isinstance(rewards, list)


def _in_one(row: Mapping[str, Any]) -> dict[str, Any]:
    """Objects in an object as columns: state.x."""
    flat: dict[str, Any] = {}
    for name, value in row.items():
        if isinstance(value, Mapping):
            flat |= {f"{name}.{inner}": v for inner, v in value.items()}
        else:
            flat[str(name)] = value
    return flat


def _column(values: list[Any]) -> Any:
    """Objects in an array, without joining lists of several lengths."""
    column = np.empty(len(values), object)
    column[:] = values
    return column


def from_json(path: str | Path, header: Sequence[str] | None = None, **arguments: Any) -> Log:
    """Read a log from a JSON or JSON Lines file.

    Parameters
    ----------
    path : str or Path
        What :func:`from_objects` takes, or a line for each interaction or episode.
    header : sequence of str or None
        The names of the elements of rows that have none.
    **arguments
        Of :func:`rlvc.logs.from_arrays`.
    """
    lost: list[str] = []
    text = text_of(path, [], lost)
    try:
        found = json.loads(text)
    except RecursionError:
        raise LogError(f"{path}: cannot be read as JSON: too deep") from None
    except ValueError:
        found = _lines(text, path, lost)
    log = from_objects(found, str(path), header, **arguments)
    for fault in lost:
        warn(log, fault)
    return log


def _lines(text: str, path: str | Path, lost: list[str]) -> list[Any]:
    """What is on each line; a last one that was cut off is left out, and `lost` says so."""
    rows = []
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    for number, line in lines:
        try:
            rows.append(json.loads(line))
        except (RecursionError, ValueError) as error:
            if not rows or number != lines[-1][0] or text.endswith("\n"):
                raise LogError(f"{path}: line {number}: is not JSON: {error}") from None
            lost.append(f"line {number} is cut off, and left out")
    return rows


def from_pickle(path: str | Path, header: Sequence[str] | None = None, **arguments: Any) -> Log:
    """Read a log from a pickle of lists, dicts and arrays; nothing in it is run.

    Parameters
    ----------
    path : str or Path
        What :func:`from_objects` takes.
    header : sequence of str or None
        The names of the elements of rows that have none.
    **arguments
        Of :func:`rlvc.logs.from_arrays`.
    """
    with as_file(path) as file:
        return from_objects(unpickled(file, path), str(path), header, **arguments)


def from_npz(path: str | Path, header: Sequence[str] | None = None, **arguments: Any) -> Log:
    """Read a log from an NPZ file with the arrays of :func:`from_arrays`, or from NPY.

    Parameters
    ----------
    path : str or Path
        NPY: an array of records, a dict of arrays, or rows by ``header``.
    header : sequence of str or None
        The names of the columns of an NPY that has none.
    **arguments
        Of :func:`from_arrays`.
    """
    with as_file(path) as file:
        try:
            if file.read(6) == b"\x93NUMPY":
                file.seek(0)
                return from_objects(array_of(file, path), str(path), header, **arguments)
            arrays: Any = {}
            with zipfile.ZipFile(file) as archive:
                fault = why_no_arrays(archive.namelist())
                if fault:
                    raise LogError(f"{path}: {fault}")
                for name in archive.namelist():
                    with archive.open(name) as member:
                        key = name.removesuffix(".npy")
                        arrays[key] = array_of(member, f"{path}: {key}")
        except LogError:
            raise
        except Exception as error:  # of zipfile, of what it unpacks with, of numpy's parser
            raise LogError(f"{path}: cannot be read as NPZ: {error!s:.300}") from error
    if len(arrays) == 1:  # all in one
        arrays = next(iter(arrays.values()))
    elif header is not None:
        raise LogError(f"{path}: header= names columns, and the arrays here have names")
    return from_objects(arrays, str(path), header, **arguments)
