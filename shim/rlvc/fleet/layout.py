# SPDX-License-Identifier: MIT
"""The Parquet layout of a fleet's logs, version 1.

Columns, none of which has nulls:

=================  =========================  ====================================================
``percept``        fixed_size_binary[b]       s; b = ceil(bits / 8), bit i is bit i % 8 of byte i // 8
``action``         uint8
``reward``         float32                    finite, within 1e12
``next_percept``   fixed_size_binary[b]       s'; any bytes where ``end`` is 1
``end``            uint8                      0 the episode goes on, 1 terminated, 2 truncated
``exploited``      bool, optional             whether the action was greedy
=================  =========================  ====================================================

The file's metadata has ``rlvc.version`` ("1"), ``rlvc.bits`` and ``rlvc.actions``. Rows are in order of
time, and a file holds whole episodes. Row groups have 2**18 rows, compressed by zstd.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..counts.table import Columns
from ..errors import LogError

VERSION = "1"
GROUP_ROWS = 1 << 18
_META = {name: f"rlvc.{name}".encode() for name in ("version", "bits", "actions")}
NAMES = ("percept", "action", "reward", "next_percept", "end")


def arrow() -> Any:
    """Import pyarrow with its Parquet module, or raise ImportError with what to install."""
    try:
        import pyarrow
        import pyarrow.compute
        import pyarrow.fs
        import pyarrow.parquet
    except ImportError:
        raise ImportError("Parquet files need pyarrow: pip install 'rlvc[fleet]'") from None
    return pyarrow


def schema(bits: int, actions: int, exploited: bool) -> Any:
    """Return the Arrow schema of a file.

    Parameters
    ----------
    bits, actions : int
    exploited : bool
        Whether there is a column ``exploited``.
    """
    pa = arrow()
    record = pa.binary(-(-bits // 8))
    kinds = [("percept", record), ("action", pa.uint8()), ("reward", pa.float32())]
    kinds += [("next_percept", record), ("end", pa.uint8())]
    fields = [pa.field(name, kind, nullable=False) for name, kind in kinds]
    if exploited:
        fields.append(pa.field("exploited", pa.bool_(), nullable=False))
    values = {"version": VERSION, "bits": str(bits), "actions": str(actions)}
    return pa.schema(fields, {_META[name]: value.encode() for name, value in values.items()})


class Writer:
    """Writes a file of the layout, a part of a log after another.

    Parameters
    ----------
    file : str
        The path, or what Arrow's file system takes.
    bits, actions : int
    exploited : bool
    filesystem : pyarrow.fs.FileSystem or None
    """

    def __init__(
        self, file: Any, bits: int, actions: int, exploited: bool = False, filesystem: Any = None
    ) -> None:
        pa = arrow()
        self._schema = schema(bits, actions, exploited)
        self._writer = pa.parquet.ParquetWriter(
            file,
            self._schema,
            filesystem=filesystem,
            compression="zstd",
            use_dictionary=["action", "reward", "end"],
        )

    def write(self, columns: Columns, exploited: npt.NDArray[np.bool_] | None = None) -> None:
        """Append interactions.

        Parameters
        ----------
        columns : Columns
        exploited : ndarray of bool or None
        """
        pa = arrow()

        def records(values: npt.NDArray[np.uint8]) -> Any:
            buffer = pa.py_buffer(np.ascontiguousarray(values))
            kind = pa.binary(values.shape[1])
            return pa.FixedSizeBinaryArray.from_buffers(kind, len(values), [None, buffer])

        arrays = [
            records(columns.percepts),
            pa.array(columns.actions),
            pa.array(columns.rewards),
            records(columns.next_percepts),
            pa.array(columns.ends),
        ]
        if exploited is not None:
            arrays.append(pa.array(exploited))
        table = pa.Table.from_arrays(arrays, schema=self._schema)
        self._writer.write_table(table, row_group_size=GROUP_ROWS)

    def close(self) -> None:
        """Complete the file."""
        self._writer.close()


def facts(kind: Any, where: str) -> tuple[int, int]:
    """Return bits and actions of a schema.

    Parameters
    ----------
    kind : pyarrow.Schema
    where : str
        The file, in errors.

    Raises
    ------
    LogError
        It is not the layout, or of another version.
    """
    pa, meta = arrow(), kind.metadata or {}
    version = meta.get(_META["version"], b"").decode("ascii", "replace")
    if version != VERSION:
        raise LogError(
            f"{where}: rlvc.version is {version or 'missing'}; this package reads version {VERSION}"
        )
    try:
        bits, actions = int(meta[_META["bits"]]), int(meta[_META["actions"]])
    except (KeyError, ValueError):
        raise LogError(f"{where}: metadata: rlvc.bits and rlvc.actions are not numbers") from None
    if bits < 1 or actions < 1:
        raise LogError(f"{where}: metadata: {bits} bits and {actions} actions")
    for field in schema(bits, actions, False):
        index = kind.get_field_index(field.name)
        found = kind.field(index).type if index >= 0 else None
        if found != field.type:
            raise LogError(f"{where}: column {field.name}: {found or 'missing'}, not {field.type}")
    assert pa is not None
    return bits, actions


def columns_of(group: Any, where: str) -> Columns:
    """Return a row group as arrays, without copying what needs none.

    Parameters
    ----------
    group : pyarrow.Table
    where : str
        File and row group, in errors.
    """

    def chunk(name: str) -> Any:
        column = group.column(name).combine_chunks()
        if hasattr(column, "num_chunks"):
            column = column.chunk(0) if column.num_chunks else arrow().array([], column.type)
        if column.null_count:
            raise LogError(f"{where}: column {name}: has nulls")
        return column

    def records(name: str) -> npt.NDArray[np.uint8]:
        column = chunk(name)
        size = column.type.byte_width
        flat = np.frombuffer(
            column.buffers()[1], np.uint8, len(column) * size, column.offset * size
        )
        return flat.reshape(len(column), size)

    rewards = chunk("reward").to_numpy()
    return Columns(
        records("percept"),
        records("next_percept"),
        chunk("action").to_numpy(),
        rewards,
        chunk("end").to_numpy(),
        rewards,
    )
