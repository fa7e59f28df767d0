# SPDX-License-Identifier: MIT
"""Snapshots in memory and in files.

An agent's file is a line ``rlvc agent 1``, a line of JSON (``bits``, ``descriptors``, ``thresholds``,
``names``, ``config``, ``bytes``), and the library's snapshot as it is. One of the first three has the
parameters of the domain; all are null for one's own.
"""

from __future__ import annotations

import ctypes
import dataclasses
import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

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
    """An ``rlvc_store`` in memory.

    Parameters
    ----------
    slot_bytes : int
    snapshot : bytes
        What the first slot begins with.
    """

    def __init__(self, slot_bytes: int, snapshot: bytes = b"") -> None:
        # A longer one than any of this agent's cannot be whole.
        self.data = bytearray(2 * slot_bytes)
        self.data[: min(len(snapshot), slot_bytes)] = snapshot[:slot_bytes]
        self.native = _native.Store()
        self.native.slot_bytes = slot_bytes
        self.native.read = _native.STORE_READ(self._read)
        self.native.write = _native.STORE_WRITE(self._write)

    def _read(self, _ctx: int | None, offset: int, buffer: int, count: int) -> int:
        part = bytes(self.data[offset : offset + count])
        ctypes.memmove(buffer, part, len(part))
        return int(len(part) != count)

    def _write(self, _ctx: int | None, offset: int, buffer: int, count: int) -> int:
        if offset + count > len(self.data):
            return 1
        self.data[offset : offset + count] = ctypes.string_at(buffer, count)
        return 0

    def peek(self) -> tuple[int, _native.SnapshotInfo]:
        """Look at the newest snapshot: the library's status, and what it is."""
        info = _native.SnapshotInfo()
        status = _native.call.rlvc_snapshot_peek(ctypes.byref(self.native), ctypes.byref(info))
        return int(status), info

    def newest(self) -> bytes:
        """Give the newest snapshot."""
        status, info = self.peek()
        if status != _native.OK:
            raise SnapshotError(_native.status_text(status))
        start = info.slot * self.native.slot_bytes
        return bytes(self.data[start : start + info.bytes])


def write_file(file: str | Path, agent: Agent, names: Sequence[str]) -> None:
    """Write an agent's file beside its place, and then move it there.

    Parameters
    ----------
    file : str or Path
    agent : Agent
    names : sequence of str
        What each bit says.

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
        The domain (None: one's own), the config, what each bit says, the snapshot.

    Raises
    ------
    StoreError
        The file cannot be read.
    SnapshotError
        It is no such file, or is damaged.
    """
    try:
        content = Path(file).read_bytes()
    except OSError as error:
        raise StoreError(f"{file}: cannot be read: {error.strerror}") from error
    if not content.startswith(_MAGIC):
        raise SnapshotError(f"{file}: is no agent's file")
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
        raise SnapshotError(f"{file}: is damaged: its head cannot be read ({error})") from error
    if len(snapshot) != count:
        raise SnapshotError(f"{file}: is damaged: {len(snapshot)} bytes of {count} are there")
    return domain, config, names, snapshot
