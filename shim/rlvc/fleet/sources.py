# SPDX-License-Identifier: MIT
"""Where a fleet's logs are: files, folders and addresses, in pieces that workers read by themselves."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..counts.table import Columns
from ..errors import LogError
from ..logs import read
from ..logs.controller_log import is_records
from ..logs.log import Log
from . import columns as foreign
from . import layout

_GROUPS = 4  # row groups in a piece, about a million interactions
_WHOLE = (".npz", ".csv")  # read at once, with the readers of rlvc.logs


@dataclasses.dataclass(frozen=True)
class Piece:
    """Part of a log, for one task.

    Attributes
    ----------
    path : str
        A path, or an address such as ``s3://bucket/file``.
    groups : tuple of int
        Row groups of a Parquet file; () : a file that is read at once.
    rows, bytes : int
        Interactions and bytes on disk; 0: unknown.
    """

    path: str
    groups: tuple[int, ...] = ()
    rows: int = 0
    bytes: int = 0


@dataclasses.dataclass(frozen=True)
class Source:
    """A whole log.

    Attributes
    ----------
    pieces : tuple of Piece
    bits : int
        Bits of a percept.
    actions : int
        Number of actions; 0: unknown.
    """

    pieces: tuple[Piece, ...]
    bits: int
    actions: int

    @property
    def rows(self) -> int:
        """Interactions, as far as files tell before they are read."""
        return sum(piece.rows for piece in self.pieces)


def filesystem_of(path: str) -> tuple[Any, str]:
    """Return Arrow's file system for a path or address, and the path within it.

    Parameters
    ----------
    path : str
    """
    pa = layout.arrow()
    if "://" not in path:
        return pa.fs.LocalFileSystem(), path
    try:
        filesystem, within = pa.fs.FileSystem.from_uri(path)
        return filesystem, within
    except pa.ArrowInvalid:
        pass
    try:
        import fsspec
    except ImportError:
        raise ImportError(
            f"{path}: this kind of address needs fsspec: pip install fsspec"
        ) from None
    found, within = fsspec.core.url_to_fs(path)
    return pa.fs.PyFileSystem(pa.fs.FSSpecHandler(found)), within


def _files(path: str) -> list[str]:
    """Return a file, or the files below a folder, in order of their names."""
    pa = layout.arrow()
    filesystem, within = filesystem_of(path)
    try:
        info = filesystem.get_file_info(within)
        if info.type == pa.fs.FileType.File:
            return [path]
        if info.type != pa.fs.FileType.Directory:
            raise LogError(f"{path}: no such file or folder")
        below = filesystem.get_file_info(pa.fs.FileSelector(within, recursive=True))
    except OSError as error:
        raise LogError(f"{path}: cannot be listed: {error}") from error
    names = [entry.path for entry in below if entry.type == pa.fs.FileType.File]
    scheme = path.partition("://")[0] + "://" if "://" in path else ""
    kept = [name for name in sorted(names) if Path(name).suffix == ".parquet"]
    kept = kept or [name for name in sorted(names) if Path(name).suffix in _WHOLE]
    if not kept:
        raise LogError(f"{path}: holds no file that ends in .parquet, .npz or .csv")
    return [scheme + name for name in kept]


def _is_whole(path: str) -> bool:
    return Path(path).suffix.lower() in _WHOLE or ("://" not in path and is_records(path))


def _parquet(path: str) -> Any:
    pa = layout.arrow()
    filesystem, within = filesystem_of(path)
    try:
        return pa.parquet.ParquetFile(within, filesystem=filesystem, memory_map=False)
    except (OSError, pa.ArrowException) as error:
        raise LogError(f"{path}: cannot be read as Parquet: {error}") from error


def _facts(kind: Any, path: str) -> tuple[int, int]:
    """Return bits and actions of a Parquet file; actions 0: unknown."""
    if "percept" in kind.names:
        return layout.facts(kind, path)
    return foreign.bits_of(kind, path), 0


def _pieces_of(path: str) -> tuple[list[Piece], int, int]:
    """Return the pieces of a file, and its bits and actions."""
    if _is_whole(path):
        log = read(path)
        bits = 8 * log.record_bytes or foreign.bits_of_log(log)
        actions = log.known.count
        return [Piece(path, rows=len(log), bytes=Path(path).stat().st_size)], bits, actions
    with _parquet(path) as file:
        bits, actions = _facts(file.schema_arrow, path)
        meta = file.metadata
        pieces = []
        for first in range(0, meta.num_row_groups, _GROUPS):
            groups = tuple(range(first, min(first + _GROUPS, meta.num_row_groups)))
            about = [meta.row_group(group) for group in groups]
            size = sum(
                g.column(i).total_compressed_size for g in about for i in range(g.num_columns)
            )
            pieces.append(Piece(path, groups, sum(g.num_rows for g in about), size))
    return pieces, bits, actions


def opened(source: str | Path | Sequence[str | Path]) -> Source:
    """Find the pieces of a log, and check that their files fit together.

    Parameters
    ----------
    source : str, Path or sequence of these
        Files, folders or addresses.

    Raises
    ------
    LogError
        A file cannot be read, or has other percepts or actions than the first.
    """
    given = [source] if isinstance(source, str | Path) else list(source)
    files = [file for path in given for file in _files(str(path))]
    pieces: list[Piece] = []
    first: tuple[int, int] | None = None
    for file in files:
        some, bits, actions = _pieces_of(file)
        first = first or (bits, actions)
        if bits != first[0]:
            raise LogError(f"{file}: {bits} bits, but {files[0]} has {first[0]}")
        if actions and first[1] and not _is_whole(file) and actions != first[1]:
            raise LogError(f"{file}: {actions} actions, but {files[0]} has {first[1]}")
        first = (bits, max(actions, first[1]))
        pieces += some
    if first is None or not pieces:
        raise LogError("the source holds no interaction")
    return Source(tuple(pieces), *first)


# ------------------------------------------------------------------ reading a piece


def _group(file: Any, group: int, where: str, names: list[str]) -> Any:
    """Read a row group; an error names the column."""
    pa = layout.arrow()
    try:
        return file.read_row_group(group, columns=names, use_threads=False)
    except (OSError, pa.ArrowException) as error:
        for name in names:
            try:
                file.read_row_group(group, columns=[name], use_threads=False)
            except (OSError, pa.ArrowException) as inner:
                raise LogError(f"{where}: column {name}: cannot be read: {inner}") from inner
        raise LogError(f"{where}: cannot be read: {error}") from error


def blocks(piece: Piece, bits: int) -> Iterator[tuple[str, Columns | LogError]]:
    """Read a piece, a row group at a time.

    Parameters
    ----------
    piece : Piece
    bits : int

    Yields
    ------
    tuple
        Where it is, and the interactions; or what is wrong with them.
    """
    if not piece.groups:
        try:
            yield piece.path, columns_of_log(read(piece.path), bits)
        except LogError as error:
            yield piece.path, error
        return
    try:
        file = _parquet(piece.path)
    except LogError as error:
        yield piece.path, error
        return
    with file:
        own = "percept" in file.schema_arrow.names
        names = list(layout.NAMES) if own else foreign.names_of(file.schema_arrow)
        for group in piece.groups:
            where = f"{piece.path}: row group {group}"
            try:
                table = _group(file, group, where, names)
                yield where, (layout if own else foreign).columns_of(table, where)
            except LogError as error:
                yield where, error


def columns_of_log(log: Log, bits: int) -> Columns:
    """Return a log that the readers of ``rlvc.logs`` have read as columns.

    Parameters
    ----------
    log : Log
        Of percepts, or of bool observations.
    bits : int
    """
    if log.record_bytes:
        before, after = np.asarray(log.before), np.asarray(log.after)
    else:
        foreign.bits_of_log(log)
        before, after = (
            np.packbits(np.asarray(side, np.bool_), axis=1, bitorder="little")
            for side in (log.before, log.after)
        )
    if before.shape[1] != -(-bits // 8):
        raise LogError(f"{log.where}: percepts of {before.shape[1]} bytes, not of {bits} bits")
    rewards = np.ascontiguousarray(log.rewards, np.float32)
    return Columns(
        np.ascontiguousarray(before),
        np.ascontiguousarray(after),
        log.actions.astype(np.uint8),
        rewards,
        np.ascontiguousarray(log.ends),
        rewards,
    )
