# SPDX-License-Identifier: MIT
"""Snapshots in memory and in files.

The file of an agent is a line ``rlvc agent 1``, a line of JSON and the library's snapshot. The JSON
has ``bits``, ``descriptors`` and ``thresholds``, one of which holds the parameters of the domain
(all are null for a user-defined domain), ``names``, ``config``, and ``bytes``, the size of the
snapshot.
"""

from __future__ import annotations

import ctypes
import dataclasses
import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _native
from ..domains.bits import Bits
from ..domains.descriptors import Descriptors
from ..domains.domain import Domain
from ..domains.thresholds import Thresholds
from ..errors import SnapshotError, StoreError
from .config import Config

if TYPE_CHECKING:
    from .agent import Agent

_MAGIC = b"rlvc agent 1\n"


class MemoryStore:
    """An ``rlvc_store`` in memory, whose callbacks are C.

    Parameters
    ----------
    slot_bytes : int
    snapshot : bytes
        Initial content of the first slot.
    """

    def __init__(self, slot_bytes: int, snapshot: bytes = b"") -> None:
        self._slots = np.zeros((2, slot_bytes), np.uint8)
        # A snapshot longer than a slot is not one of this agent: truncated, it fails its checksum.
        first = np.frombuffer(snapshot, np.uint8)[:slot_bytes]
        self._slots[0, : len(first)] = first
        self._memory = _native.ShimMemory(self._slots.ctypes.data, self._slots.nbytes)
        self.native = _native.Store()
        _native.call.rlvc_shim_memory_store(
            ctypes.byref(self._memory), slot_bytes, ctypes.byref(self.native)
        )

    def peek(self) -> tuple[int, _native.SnapshotInfo]:
        """Return the library's status and a description of the newest snapshot."""
        info = _native.SnapshotInfo()
        status = _native.call.rlvc_snapshot_peek(ctypes.byref(self.native), ctypes.byref(info))
        return int(status), info

    def newest(self) -> bytes:
        """Return the newest snapshot."""
        status, info = self.peek()
        if status != _native.OK:
            raise SnapshotError(_native.status_text(status))
        return self._slots[info.slot, : info.bytes].tobytes()


def write_file(file: str | Path, agent: Agent, names: Sequence[str]) -> None:
    """Write an agent's file: to a temporary file first, which then replaces it.

    Parameters
    ----------
    file : str or Path
    agent : Agent
    names : sequence of str
        Names of the bits or components.

    Raises
    ------
    StoreError
        The file cannot be written.
    """
    snapshot = agent.snapshot()
    domain = agent.domain
    head = {
        "bits": domain.bits if isinstance(domain, Bits) else None,
        "descriptors": domain.parameters if isinstance(domain, Descriptors) else None,
        "thresholds": domain.parameters if isinstance(domain, Thresholds) else None,
        "names": list(names),
        "config": dataclasses.asdict(agent.config),
        "bytes": len(snapshot),
    }
    temporary = Path(f"{file}.part")
    try:
        with temporary.open("wb") as out:
            out.write(_MAGIC + json.dumps(head).encode() + b"\n" + snapshot)
            out.flush()
            os.fsync(out.fileno())
        temporary.replace(file)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise StoreError(f"{file}: cannot be written: {error.strerror}") from error


def read_file(file: str | Path) -> tuple[Domain | None, Config, list[str], bytes]:
    """Read an agent's file.

    Parameters
    ----------
    file : str or Path

    Returns
    -------
    tuple
        The domain (None: user-defined), the config, the names of the bits, the snapshot.

    Raises
    ------
    StoreError
        The file cannot be read.
    SnapshotError
        It is not such a file, or is corrupt.
    """
    try:
        content = Path(file).read_bytes()
    except OSError as error:
        raise StoreError(f"{file}: cannot be read: {error.strerror}") from error
    if not content.startswith(_MAGIC):
        raise SnapshotError(f"{file}: not the file of an agent")
    line, _, snapshot = content[len(_MAGIC) :].partition(b"\n")
    try:
        head: dict[str, Any] = json.loads(line)
        config = Config(**head["config"])
        names, count = [str(name) for name in head["names"]], head["bytes"]
        domain: Domain | None = None
        if head["bits"] is not None:
            domain = Bits(head["bits"])
        elif head.get("descriptors") is not None:
            domain = Descriptors(*head["descriptors"])
        elif head.get("thresholds") is not None:
            domain = Thresholds(*head["thresholds"])
    except (ValueError, KeyError, TypeError, ctypes.ArgumentError) as error:
        raise SnapshotError(f"{file}: damaged: the header is not valid ({error})") from error
    if len(snapshot) != count:
        raise SnapshotError(f"{file}: damaged: {len(snapshot)} bytes of {count}")
    return domain, config, names, snapshot
