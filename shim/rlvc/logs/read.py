# SPDX-License-Identifier: MIT
"""The front end of all logs: it looks at what it is given, and takes the reader for it."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..errors import LogError
from ..files import open_file
from .array_log import from_arrays, from_hdf5, from_npz
from .buffer_log import from_buffer, is_buffer
from .controller_log import from_records, is_records
from .csv_log import from_csv
from .frame_log import from_frame, from_json, from_parquet
from .log import Log
from .minari_log import from_minari

_SUFFIXES = {
    ".npz": "npz",
    ".h5": "hdf5",
    ".hdf5": "hdf5",
    ".hdf": "hdf5",
    ".parquet": "parquet",
    ".json": "json",
    ".jsonl": "json",
    ".ndjson": "json",
    ".csv": "csv",
    ".tsv": "csv",
    ".tab": "csv",
    ".dat": "csv",
    ".txt": "csv",
}
_MARKS = ((b"PK\x03\x04", "npz"), (b"\x89HDF\r\n\x1a\n", "hdf5"), (b"PAR1", "parquet"))
_READERS = {"npz": from_npz, "hdf5": from_hdf5, "parquet": from_parquet, "json": from_json}


def read(
    log: Any,
    columns: Sequence[str] | None = None,
    header: Sequence[str] | None = None,
    bins: int | None = None,
) -> Log:
    """Read a log of any kind.

    Parameters
    ----------
    log : dict of arrays, pandas.DataFrame, path, Minari data set or its name, replay buffer, or Log
        A file is CSV in any dialect, JSON, JSON Lines, NPZ, HDF5, Parquet, or the log of a controller.
    columns : sequence of str or None
        Columns of the observation. None: those that are named so, else all without another meaning.
    header : sequence of str or None
        The names of the columns of a CSV that has none.
    bins : int or None
        Of actions that are real numbers: into how many each element is divided.

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
    options: dict[str, Any] = {"columns": columns, "bins": bins}
    if isinstance(log, Log):
        return log
    if isinstance(log, Mapping):
        return from_arrays(log, **options)
    if hasattr(log, "columns") and hasattr(log, "itertuples"):
        return from_frame(log, **options)
    if is_buffer(log):
        return from_buffer(log, **options)
    if hasattr(log, "iterate_episodes"):
        return from_minari(log, bins)
    if not isinstance(log, str | Path):
        raise LogError(
            "a log is a dict of arrays, a data frame, the path of a file, a Minari data set or its "
            f"name, or a replay buffer, and not {type(log).__name__}"
        )
    if isinstance(log, str) and not Path(log).suffix and not _exists(log):
        return from_minari(log, bins)
    if is_records(log):
        return from_records(log)
    kind = _kind(log)
    if kind == "csv":
        return from_csv(log, columns, header, bins)
    if header is not None:
        raise LogError(f"{log}: header= names the columns of a CSV, and this is {kind.upper()}")
    made: Log = _READERS[kind](log, **options)
    return made


def _exists(name: str) -> bool:
    try:
        return Path(name).exists()
    except (OSError, ValueError):
        return False


def _kind(path: str | Path) -> str:
    """What a file is, by how it begins, else by its name."""
    try:
        with open_file(path) as file:
            start = file.read(512)
    except OSError as error:
        raise LogError(f"{path}: cannot be read: {error.strerror}") from error
    for mark, kind in _MARKS:
        if start.startswith(mark):
            return kind
    if start.lstrip(b"\xef\xbb\xbf \t\r\n")[:1] in (b"{", b"["):
        return "json"
    kind = _SUFFIXES.get(Path(path).suffix.lower(), "")
    if not kind:
        raise LogError(
            f"{path}: neither CSV, JSON, NPZ, HDF5 nor Parquet by its name, nor a controller's log: "
            "rename it to .csv if it is a table"
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
