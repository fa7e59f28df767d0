# SPDX-License-Identifier: MIT
"""The file of a planner.

It is a line ``rlvc planner 1``, a line of JSON, the library's snapshot, and the CRC-32 of all these in
4 bytes, lowest first. The JSON has ``thresholds``, the parameters of the domain, ``names`` (of the
components), ``config``, and ``bytes``, the size of the snapshot.
"""

from __future__ import annotations

import dataclasses
import json
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..domains.thresholds import Thresholds
from ..errors import ConfigError, Error, SnapshotError, StoreError
from ..files import read, replace, tidy
from .planner_config import PlannerConfig

if TYPE_CHECKING:
    from .planner import Planner

_MAGIC = b"rlvc planner 1\n"


def write_file(file: str | Path, planner: Planner, names: Sequence[str]) -> None:
    """Write a planner's file. A failure leaves the old file.

    Parameters
    ----------
    file : str or Path
    planner : Planner
    names : sequence of str
        Names of the components.

    Raises
    ------
    StoreError
        The file cannot be written, or is a link, a folder, a FIFO or a device.
    """
    if isinstance(names, str) or not all(isinstance(name, str) for name in names):
        raise ConfigError(f"names: {names!r:.80} is not a list of str")
    snapshot = planner.snapshot()
    head = {
        "thresholds": planner._thresholds.parameters,
        "names": list(names),
        "config": dataclasses.asdict(planner.config),
        "bytes": len(snapshot),
    }
    text = json.dumps(head, default=lambda number: number.item())  # numpy's numbers
    content = b"%b%b\n%b" % (_MAGIC, text.encode(), snapshot)
    replace(file, content + zlib.crc32(content).to_bytes(4, "little"))


def read_file(file: str | Path) -> tuple[Thresholds, PlannerConfig, list[str], bytes]:
    """Read a planner's file.

    Parameters
    ----------
    file : str or Path

    Returns
    -------
    tuple
        The domain, the config, the names of the components, the snapshot.

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
    if not content.startswith(_MAGIC):
        raise SnapshotError(f"{file}: not the file of a planner")
    if zlib.crc32(content[:-4]) != int.from_bytes(content[-4:], "little"):
        raise SnapshotError(f"{file}: damaged: the checksum is wrong")
    line, _, snapshot = content[len(_MAGIC) : -4].partition(b"\n")
    try:
        head = json.loads(line)
        domain, config = Thresholds(*head["thresholds"]), PlannerConfig(**head["config"])
        names = [str(name) for name in head["names"]]
    except (Error, KeyError, RecursionError, TypeError, ValueError) as error:
        raise SnapshotError(f"{file}: damaged: {error}") from error
    return domain, config, names, snapshot
