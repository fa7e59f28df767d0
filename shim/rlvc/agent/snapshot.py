# SPDX-License-Identifier: MIT
"""Snapshots in memory, and the files of agents and planners.

The JSON of a file (:mod:`rlvc.agent.kept`) has ``bags``, ``bits``, ``descriptors``, ``spatial``
and ``thresholds``, one of which holds the parameters of the domain (all are null for a user-defined
domain), ``names``, ``config``, and ``bytes``, the size of the library's snapshot, which follows.
"""

from __future__ import annotations

import ctypes
import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _native
from ..domains.bags import Bags
from ..domains.bits import Bits
from ..domains.descriptors import Descriptors
from ..domains.domain import Domain
from ..domains.spatial import Spatial
from ..domains.thresholds import Thresholds
from ..errors import SnapshotError
from .config import Config
from .kept import read_content, unpack, write_named

if TYPE_CHECKING:
    from .learner import Learner


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


def write_file(file: str | Path, learner: Learner[Any, Any], names: Sequence[str]) -> None:
    """Write the file of an agent or a planner. A failure leaves the old file.

    Parameters
    ----------
    file : str or Path
    learner : Learner
    names : sequence of str
        Names of the bits or components.

    Raises
    ------
    StoreError
        The file cannot be written, or is a link, a folder, a FIFO or a device.
    """
    snapshot = learner.snapshot()
    head = {
        **described(learner.domain),
        "config": dataclasses.asdict(learner.config),
        "bytes": len(snapshot),
    }
    write_named(file, learner._noun, names, head, snapshot)


def read_file(
    file: str | Path, kind: str = "agent", make: Any = Config
) -> tuple[Domain | None, Any, list[str], bytes]:
    """Read the file of an agent or a planner.

    Parameters
    ----------
    file : str or Path
    kind : {"agent", "planner"}
    make : type
        Of the config.

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
    content = read_content(file)
    try:
        head, snapshot = unpack(kind, content)
        domain, config = domain_of(head), make(**head["config"])
        names, count = [str(name) for name in head["names"]], head["bytes"]
    except SnapshotError as error:
        raise SnapshotError(f"{file}: {error}") from None
    except Exception as error:  # members of any kind
        raise SnapshotError(f"{file}: damaged: the header is not valid ({error})") from error
    if len(snapshot) != count:
        raise SnapshotError(f"{file}: damaged: {len(snapshot)} bytes of {count}")
    return domain, config, names, snapshot


def described(domain: Domain) -> dict[str, Any]:
    """Return the members of a header that say of which domain percepts are."""
    return {
        "bags": domain.parameters if isinstance(domain, Bags) else None,
        "bits": domain.bits if isinstance(domain, Bits) else None,
        "descriptors": domain.parameters if type(domain) is Descriptors else None,
        "spatial": domain.parameters if isinstance(domain, Spatial) else None,
        "thresholds": domain.parameters if isinstance(domain, Thresholds) else None,
    }


def domain_of(head: dict[str, Any]) -> Domain | None:
    """Make the domain whose parameters are in a header; None: it is user-defined."""
    if head.get("bags") is not None:
        return Bags(*head["bags"])
    if head.get("bits") is not None:
        return Bits(head["bits"])
    if head.get("descriptors") is not None:
        return Descriptors(*head["descriptors"])
    if head.get("spatial") is not None:
        return Spatial(*head["spatial"])
    if head.get("thresholds") is not None:
        return Thresholds(*head["thresholds"])
    return None
