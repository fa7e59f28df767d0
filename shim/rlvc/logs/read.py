# SPDX-License-Identifier: MIT
"""The front end of all logs: it looks at what it is given, and takes the reader for it."""

from __future__ import annotations

import collections
import os
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..checks import named
from ..errors import ConfigError, LogError
from ..files import open_file
from .array_log import from_episodes, from_hdf5
from .buffer_log import from_buffer, is_buffer
from .content import content_of, is_packed, is_wide
from .controller_log import from_records, is_records
from .csv_log import from_csv
from .frame_log import FEATHER, from_frame, from_parquet
from .joined import joined
from .log import Log
from .minari_log import from_minari
from .object_log import from_json, from_npz, from_objects, from_pickle

_TEXTS = (".csv", ".tsv", ".tab", ".txt", ".dat")
_MARKS = (
    (b"PK\x03\x04", "npz"),
    (b"\x93NUMPY", "npz"),
    (b"\x89HDF\r\n\x1a\n", "hdf5"),
    (b"PAR1", "parquet"),
    (FEATHER, "parquet"),
    (b"\x80\x02", "pickle"),
    (b"\x80\x03", "pickle"),
    (b"\x80\x04", "pickle"),
    (b"\x80\x05", "pickle"),
    (b"SQLite format 3", "a data base: pass what pandas.read_sql returns"),
    (b"MATLAB 5.0", "of MATLAB: pass what scipy.io.loadmat returns"),
    (b"\xd0\xcf\x11\xe0", "of Excel: pass what pandas.read_excel returns"),
    (b"#ROSBAG", "a bag of ROS: write its topics as CSV"),
    (b"\x89MCAP", "a bag of ROS: write its topics as CSV"),
)
_TABLES: dict[str, Any] = {
    "npz": from_npz,
    "json": from_json,
    "pickle": from_pickle,
    "csv": from_csv,
}
_OTHERS: dict[str, Any] = {"hdf5": from_hdf5, "parquet": from_parquet}


def read(
    log: Any,
    columns: Sequence[str] | None = None,
    header: Sequence[str] | None = None,
    bins: int | None = None,
    roles: Mapping[str, Any] | None = None,
) -> Log:
    """Read a log of any kind.

    Parameters
    ----------
    log : dict of arrays, list, data frame, path, Minari data set or its name, replay buffer, or Log
        A file is CSV in any dialect, JSON, JSON Lines, NPZ, NPY, HDF5, Parquet, Feather, a pickle, or
        the log of a controller; text may be compressed. A list is of interactions, of episodes, or of
        paths: several files are one log, and no episode goes on from one to the next.
    columns : sequence of str or None
        Columns of the observation. None: those that are named so, else all without another meaning.
    header : sequence of str or None
        The names of the columns of a file that has none.
    bins : int or None
        Of actions that are real numbers: into how many each element is divided.
    roles : mapping or None
        Columns for roles, as for :func:`rlvc.learn_from`.

    Returns
    -------
    Log
        Its ``describe()`` says how the log was understood.

    Raises
    ------
    LogError
        It cannot be read. The message names the file, the line, index or column, and the fault.

    Warns
    -----
    LogWarning
        Something is left out or lost.
    """
    if isinstance(log, Log):
        return log
    options: dict[str, Any] = {"columns": columns, "bins": bins, "roles": roles}
    if isinstance(log, str | Path):
        return _from_file(log, header, options)
    if isinstance(log, list | tuple) and log and all(isinstance(f, str | Path) for f in log):
        if bins is not None and len(log) > 1:
            raise ConfigError(
                "bins: each file would have a grid of its own: join the files into one first"
            )
        return joined([_from_file(file, header, options) for file in log])
    if hasattr(log, "to_pandas"):  # of polars, Arrow, and Hugging Face's data sets
        log = log.to_pandas()
    if hasattr(log, "columns") and hasattr(log, "itertuples"):
        return from_frame(log, **options)
    if isinstance(log, Mapping | np.ndarray | list | tuple | collections.deque):
        return from_objects(log, header=header, **options)
    if is_buffer(log):
        return from_buffer(log, **options)
    if hasattr(log, "iterate_episodes"):
        return from_minari(log, bins)
    if hasattr(log, "episodes") and hasattr(next(iter(log.episodes), None), "rewards"):
        return from_episodes([_episode(each) for each in log.episodes], "data set", **options)
    raise LogError(
        "a log is a dict of arrays, a list of interactions, a data frame, the path of a file, a Minari "
        f"data set or its name, or a replay buffer, and not {type(log).__name__}"
    )


def _episode(episode: Any) -> dict[str, Any]:
    """The arrays of an episode of d3rlpy."""
    ends = getattr(episode, "terminated", getattr(episode, "terminal", False))
    arrays = {name: getattr(episode, name) for name in ("observations", "actions", "rewards")}
    return {**arrays, "terminated": np.asarray(ends)}


def _has_parquet(folder: str | Path) -> bool:
    """Whether there is a Parquet file in a folder, or in one of those within, whatever else is."""
    inner = os.walk(folder)  # it passes by what cannot be listed
    return any(name.endswith(".parquet") for _, _, names in inner for name in names)


def _from_file(path: str | Path, header: Sequence[str] | None, options: dict[str, Any]) -> Log:
    if isinstance(path, str) and not Path(path).suffix and not os.path.exists(path):
        return from_minari(path, options["bins"])
    if os.path.isdir(path):
        if not _has_parquet(path):
            raise LogError(f"{path}: a folder without Parquet files: pass a file")
        return from_parquet(path, **options)
    if is_records(path):
        return from_records(path)
    kind = _kind(path)
    if kind in _TABLES:
        made: Log = _TABLES[kind](path, header=header, **options)
    elif kind not in _OTHERS:
        raise LogError(f"{path}: is {kind}")
    elif header is not None:
        raise LogError(f"{path}: header= names columns, and those of {kind.upper()} have names")
    else:
        made = _OTHERS[kind](path, **options)
    return made


def _kind(path: str | Path) -> str:
    """What a file is, by how it begins, else by its name."""
    try:
        with open_file(path) as file:
            start = file.read(512)
    except OSError as error:
        raise LogError(f"{named(path)}: cannot be read: {error.strerror}") from error
    packed = is_packed(start)
    if packed:
        start = content_of(path)[:512]
    kind = next((kind for mark, kind in _MARKS if start.startswith(mark)), "")
    if packed and kind in _OTHERS:
        raise LogError(f"{path}: {kind.upper()} in a compressed file: unpack it")
    if not kind and start.lstrip(b"\xef\xbb\xbf \t\r\n")[:1] in (b"{", b"["):
        kind = "json"
    wide = start.startswith((b"\xff\xfe", b"\xfe\xff")) or is_wide(start)
    is_text = wide or b"\0" not in start
    if not kind and (is_text or Path(path).suffix.lower() in _TEXTS):
        kind = "csv"
    if not kind:
        raise LogError(
            f"{path}: neither text, JSON, NPZ, HDF5, Parquet nor a pickle, nor a controller's log: pass "
            "what is in it as arrays or as a data frame"
        )
    return kind


def described(log: Any, **options: Any) -> str:
    """Say how a log is understood, with what is lost, without learning.

    Parameters
    ----------
    log : object
        As for :func:`read`.
    **options
        Of :func:`read`.

    Returns
    -------
    str
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what is lost is among the notes
        return read(log, **options).describe()
