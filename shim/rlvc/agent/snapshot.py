# SPDX-License-Identifier: MIT
"""Snapshots in memory and in files.

The file of an agent is a line ``rlvc agent 2``, a line of JSON, the library's snapshot, and the
CRC-32 of all these in 4 bytes, lowest first. The JSON has ``bits``, ``descriptors``, ``spatial`` and
``thresholds``, one of which holds the parameters of the domain (all are null for a user-defined
domain), ``names``, ``config``, and ``bytes``, the size of the snapshot. Version 1, which has no
CRC-32, can be read too.
"""

from __future__ import annotations

import ctypes
import dataclasses
import json
import re
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _native
from ..domains.bits import Bits
from ..domains.descriptors import Descriptors
from ..domains.domain import Domain
from ..domains.spatial import Spatial
from ..domains.thresholds import Thresholds
from ..errors import ConfigError, SnapshotError, StoreError
from ..files import read, replace, tidy
from .config import Config

if TYPE_CHECKING:
    from .agent import Agent

_MAGIC = re.compile(rb"rlvc agent (\d{1,9})\n")
_VERSION = 2


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
        if status not in (_native.OK, _native.E_VERSION):  # a planner's have a version of their own
            raise SnapshotError(_native.status_text(status))
        return self._slots[info.slot, : info.bytes].tobytes()


def write_file(file: str | Path, agent: Agent, names: Sequence[str]) -> None:
    """Write an agent's file. A failure leaves the old file.

    Parameters
    ----------
    file : str or Path
    agent : Agent
    names : sequence of str
        Names of the bits or components.

    Raises
    ------
    StoreError
        The file cannot be written, or is a link, a folder, a FIFO or a device.
    """
    if isinstance(names, str) or not all(isinstance(name, str) for name in _listed(names)):
        raise ConfigError(f"names: {names!r:.80} is not a list of str")
    snapshot = agent.snapshot()
    head = {
        **described(agent.domain),
        "names": list(names),
        "config": dataclasses.asdict(agent.config),
        "bytes": len(snapshot),
    }
    text = json.dumps(head, default=lambda number: number.item())  # numpy's numbers
    content = b"rlvc agent %d\n%b\n%b" % (_VERSION, text.encode(), snapshot)
    replace(file, content + zlib.crc32(content).to_bytes(4, "little"))


def _listed(names: Sequence[str]) -> list[Any]:
    try:
        return list(names)
    except TypeError:
        return [None]


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
        tidy(file)
        content = read(file)
    except OSError as error:
        raise StoreError(f"{file}: cannot be read: {error.strerror}") from error
    try:
        line, _, snapshot = _unwrapped(content).partition(b"\n")
        head: dict[str, Any] = json.loads(line)
        domain, config = domain_of(head), Config(**head["config"])
        names, count = [str(name) for name in head["names"]], head["bytes"]
    except SnapshotError as error:
        raise SnapshotError(f"{file}: {error}") from None
    except Exception as error:  # JSON of any depth, and members of any kind
        raise SnapshotError(f"{file}: damaged: the header is not valid ({error})") from error
    if len(snapshot) != count:
        raise SnapshotError(f"{file}: damaged: {len(snapshot)} bytes of {count}")
    return domain, config, names, snapshot


def _unwrapped(content: bytes) -> bytes:
    """Return what stands between the first line and the CRC-32, if that is right."""
    magic = _MAGIC.match(content)
    if magic is None:
        raise SnapshotError("not the file of an agent")
    version = int(magic[1])
    if not 1 <= version <= _VERSION:
        raise SnapshotError(f"version {version}; this package reads versions 1 to {_VERSION}")
    if version == 1:
        return content[magic.end() :]
    if zlib.crc32(content[:-4]) != int.from_bytes(content[-4:], "little"):
        raise SnapshotError("damaged: the checksum is wrong")
    return content[magic.end() : -4]


def described(domain: Domain) -> dict[str, Any]:
    """Return the members of a header that say of which domain percepts are."""
    return {
        "bits": domain.bits if isinstance(domain, Bits) else None,
        "descriptors": domain.parameters if type(domain) is Descriptors else None,
        "spatial": domain.parameters if isinstance(domain, Spatial) else None,
        "thresholds": domain.parameters if isinstance(domain, Thresholds) else None,
    }


def domain_of(head: dict[str, Any]) -> Domain | None:
    """Make the domain whose parameters are in a header; None: it is user-defined."""
    if head["bits"] is not None:
        return Bits(head["bits"])
    if head.get("descriptors") is not None:
        return Descriptors(*head["descriptors"])
    if head.get("spatial") is not None:
        return Spatial(*head["spatial"])
    if head.get("thresholds") is not None:
        return Thresholds(*head["thresholds"])
    return None
