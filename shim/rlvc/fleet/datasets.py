# SPDX-License-Identifier: MIT
"""Data sets of others that a fleet learns from as they are: LeRobot's folders, and Minari's.

LeRobot, versions 2 and 3: ``meta/info.json``, and whole episodes in the Parquet files below ``data``,
with ``observation.state``, ``action``, ``episode_index``, ``next.reward`` and ``next.done``. Minari: the
name of a local data set, or its folder. What they say is understood as by :func:`rlvc.learn_from`, a
file or some episodes at a time.
"""

from __future__ import annotations

import json
import os
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import LogError, LogWarning
from ..logs import from_arrays, from_minari
from ..logs.log import Log
from . import layout
from .places import files_below, filesystem_of, parquet, reading

EPISODES_ROWS = 1 << 16  # interactions of the Minari episodes that are read at once


def is_lerobot(path: str) -> bool:
    """Whether a folder or address is a LeRobot data set.

    Parameters
    ----------
    path : str
    """
    filesystem, within = filesystem_of(path)
    name = f"{within.rstrip('/')}/meta/info.json"
    if filesystem.get_file_info(name).type != layout.arrow().fs.FileType.File:
        return False
    with filesystem.open_input_stream(name) as file:
        try:
            info = json.loads(file.read())
        except (ValueError, RecursionError) as error:
            raise LogError(f"{path}/meta/info.json: no JSON: {error}") from error
    return isinstance(info, dict) and "codebase_version" in info


def files_of_lerobot(path: str) -> list[str]:
    """Return the files of a LeRobot data set that hold interactions, in order.

    Parameters
    ----------
    path : str
    """
    return files_below(f"{path.rstrip('/')}/data", (".parquet",))


def from_table(path: str) -> Log:
    """Read a Parquet file at once: its columns of numbers and of equally long lists of them.

    Parameters
    ----------
    path : str
    """
    with parquet(path) as file, reading(path):
        table = file.read(use_threads=False)
        columns = {name: _values(table.column(name)) for name in table.column_names}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LogWarning)  # the report counts what is lost
        return from_arrays({k: values for k, values in columns.items() if values is not None}, path)


def _values(column: Any) -> Any:
    """An array of a column; None if it holds neither numbers nor lists of so many."""
    pa = layout.arrow()
    size, kind = 0, column.type
    if pa.types.is_list(kind) or pa.types.is_large_list(kind) or pa.types.is_fixed_size_list(kind):
        sizes = pa.compute.unique(pa.compute.list_value_length(column)).to_pylist()
        if len(sizes) != 1 or not sizes[0]:
            return None
        size, kind = sizes[0], kind.value_type
        column = pa.chunked_array([chunk.flatten() for chunk in column.chunks], kind)
    if not (pa.types.is_boolean(kind) or pa.types.is_integer(kind) or pa.types.is_floating(kind)):
        return None
    values = column.to_numpy()
    return values.reshape(-1, size) if size else values


# ------------------------------------------------------------------ Minari


def minari_of(path: str) -> Any:
    """Return the Minari data set of a name or folder; None if there is none.

    Parameters
    ----------
    path : str
    """
    if "://" in path:
        return None
    folder = Path(path)
    inner = folder / "data" if os.path.isfile(folder / "data/metadata.json") else folder
    named = not os.path.exists(folder) and not folder.suffix
    if not named and not os.path.isfile(inner / "metadata.json"):
        return None
    try:
        import minari
    except ImportError:
        raise ImportError(
            f"{path}: a Minari data set needs Minari: pip install 'rlvc[logs]'"
        ) from None
    try:
        return minari.load_dataset(path) if named else minari.MinariDataset(inner)
    except (OSError, ValueError, KeyError) as error:
        if named:  # then it was to be a path
            return None
        raise LogError(f"{path}: no Minari data set: {error}") from error


def episodes_of(dataset: Any) -> list[tuple[tuple[int, ...], int]]:
    """Cut a Minari data set: some episodes, and how many interactions they may have.

    Parameters
    ----------
    dataset : minari.MinariDataset
    """
    episodes, steps = np.asarray(dataset.episode_indices), int(dataset.total_steps)
    mean = max(1.0, steps / max(1, len(episodes)))
    count = max(1, int(EPISODES_ROWS / mean))
    cuts = [episodes[i : i + count] for i in range(0, len(episodes), count)]
    return [(tuple(int(i) for i in some), round(mean * len(some))) for some in cuts]


def read_episodes(path: str, episodes: tuple[int, ...]) -> Log:
    """Read some episodes of a Minari data set.

    Parameters
    ----------
    path : str
    episodes : tuple of int
    """
    dataset = minari_of(path)
    if dataset is None:
        raise LogError(f"{path}: no such file, and no Minari data set")
    return from_minari(dataset, episodes=episodes)
