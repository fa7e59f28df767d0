# SPDX-License-Identifier: MIT
"""Logs in data frames, Parquet, JSON and JSON Lines."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import LogError
from ..files import open_file, read
from .array_log import from_arrays, from_episodes
from .log import Log


def from_frame(frame: Any, where: str = "log", **arguments: Any) -> Log:
    """Make a log of a data frame of pandas, with a row for each interaction.

    Parameters
    ----------
    frame : pandas.DataFrame
    where : str
        Name of the log in errors.
    **arguments
        Of :func:`rlvc.logs.from_arrays`.
    """
    names = [str(name) for name in frame.columns]
    if len(set(names)) != len(names):
        raise LogError(f"{where}: two columns have the same name")
    columns = {str(name): _values(frame[name]) for name in frame.columns}
    return from_arrays(columns, where, **arguments)


def _values(series: Any) -> Any:
    """A column as an array: of numbers if it can be, else of objects."""
    kind = str(series.dtype)
    if kind.startswith(("datetime", "timedelta")):
        return series.astype("int64").to_numpy()
    if kind == "category":
        return series.astype(object).to_numpy()
    return series.to_numpy()


def from_parquet(path: str | Path, **arguments: Any) -> Log:
    """Read a log from a Parquet file, as those of LeRobot and RLlib.

    Parameters
    ----------
    path : str or Path
    **arguments
        Of :func:`rlvc.logs.from_arrays`.
    """
    try:
        import pandas
    except ImportError:
        raise ImportError(
            "Parquet files need pandas and pyarrow: pip install 'rlvc[logs]'"
        ) from None
    try:
        open_file(path).close()  # a regular file
        frame = pandas.read_parquet(path)
    except ImportError:
        raise ImportError("Parquet files need pyarrow: pip install 'rlvc[logs]'") from None
    except Exception as error:  # of pyarrow
        raise LogError(f"{path}: cannot be read as Parquet: {error}") from error
    return from_frame(frame, str(path), **arguments)


def from_json(path: str | Path, **arguments: Any) -> Log:
    """Read a log from a JSON or JSON Lines file.

    Parameters
    ----------
    path : str or Path
        A list of interactions, or a line for each; a dict of lists; or a list of episodes, each a dict
        of lists, or a line for each.
    **arguments
        Of :func:`rlvc.logs.from_arrays`.
    """
    try:
        text = read(path).decode("utf-8-sig")
    except (OSError, UnicodeError) as error:
        raise LogError(f"{path}: cannot be read as JSON: {error}") from error
    try:
        found = json.loads(text)
    except RecursionError:
        raise LogError(f"{path}: cannot be read as JSON: too deep") from None
    except ValueError:
        found = _lines(text, path)
    where = str(path)
    if isinstance(found, dict):
        inner = next((found[k] for k in ("episodes", "data", "transitions") if k in found), None)
        if not isinstance(inner, list):
            return from_arrays(found, where, **arguments)
        found = inner
    if not isinstance(found, list) or not found or not all(isinstance(row, dict) for row in found):
        raise LogError(f"{path}: is no list of interactions: give each as an object of its columns")
    if _is_episode(found[0]):
        return from_episodes(found, where, **arguments)
    found = [_flattened(row) for row in found]
    names = list(dict.fromkeys(str(name) for row in found for name in row))
    columns = {name: _column([row.get(name) for row in found]) for name in names}
    return from_arrays(columns, where, **arguments)


def _lines(text: str, path: str | Path) -> list[Any]:
    rows = []
    for number, line in enumerate(text.splitlines(), 1):
        if line.strip():
            try:
                rows.append(json.loads(line))
            except (RecursionError, ValueError) as error:
                raise LogError(f"{path}: line {number}: is not JSON: {error}") from None
    return rows


def _is_episode(row: dict[str, Any]) -> bool:
    """Whether an object is an episode: its rewards are a list."""
    return any(isinstance(row.get(name), list) for name in ("rewards", "reward", "rew"))


def _flattened(row: dict[str, Any]) -> dict[str, Any]:
    """Objects in an object as columns: state.x."""
    flat: dict[str, Any] = {}
    for name, value in row.items():
        if isinstance(value, dict):
            flat |= {f"{name}.{inner}": v for inner, v in value.items()}
        else:
            flat[name] = value
    return flat


def _column(values: list[Any]) -> Any:
    """Objects in an array, without joining lists of several lengths."""
    column = np.empty(len(values), object)
    column[:] = values
    return column
