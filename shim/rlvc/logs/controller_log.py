# SPDX-License-Identifier: MIT
"""Logs that a controller wrote (``core/include/rlvc/log.h``), read by the library."""

from __future__ import annotations

import ctypes
from pathlib import Path
from typing import Any

import numpy as np

from .. import _native
from ..agent.results import CHOICE
from ..checks import named
from ..errors import LogError
from ..files import open_file, read
from ..learning.actions import Actions
from .log import Log

_MAGIC = b"\xa5\x01"  # start of a record, and its kind: header


def is_records(path: str | Path) -> bool:
    """Whether a file begins like the log of a controller.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    bool
    """
    try:
        with open_file(path) as file:
            return file.read(len(_MAGIC)) == _MAGIC
    except OSError:
        return False


def _read(content: bytes, records: _native.ShimRecords, path: str | Path) -> None:
    buffer = ctypes.create_string_buffer(_native.SHIM_RECORDS_ROOM)
    current = ctypes.create_string_buffer(_native.SHIM_RECORDS_PERCEPT)
    status = _native.long_call.rlvc_shim_records_read(
        content, len(content), buffer, current, ctypes.byref(records)
    )
    if status != _native.OK:
        raise LogError(f"{path}: from byte {records.fault_at} on: {_WRONG[status]}")


_WRONG = {
    _native.E_DAMAGED: "bytes or records are missing or damaged before the end of the log",
    _native.E_VERSION: "a header has another version",
    _native.E_MISMATCH: "a header has other percepts or actions than the first one",
}


def from_records(path: str | Path) -> Log:
    """Read the log of a controller: the output of ``rlvc_log_open`` and the calls after it.

    Parameters
    ----------
    path : str or Path
        A record that a power failure cut short is skipped: the episode is truncated there.

    Returns
    -------
    Log
        Of percepts' records, not of observations.

    Raises
    ------
    LogError
        It cannot be read, or is damaged elsewhere; the text says from which byte on.
    """
    try:
        content = read(path)
    except OSError as error:
        raise LogError(f"{named(path)}: cannot be read: {error.strerror}") from error
    records = _native.ShimRecords()
    _read(content, records, path)
    count, size = records.interactions, records.percept_bytes
    if count == 0:
        raise LogError(f"{path}: there is no interaction")
    shapes: dict[str, tuple[Any, Any]] = {
        "percepts": ((count, size), np.uint8),
        "next": ((count, size), np.uint8),
        "choices": ((count,), CHOICE),
        "rewards": ((count,), np.float32),
        "ends": ((count,), np.uint8),
    }
    arrays = {name: np.empty(shape, dtype) for name, (shape, dtype) in shapes.items()}
    for name, array in arrays.items():
        setattr(records, name, array.ctypes.data)
    _read(content, records, path)
    return Log(
        arrays["percepts"],
        arrays["next"],
        arrays["choices"]["action"].astype(np.int64),
        arrays["rewards"],
        arrays["ends"],
        arrays["choices"]["exploited"] == 1,
        str(path),
        Actions(records.actions),
        notes=[f"log of a controller: percepts of {size} bytes"],
        record_bytes=size,
    )
