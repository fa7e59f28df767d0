# SPDX-License-Identifier: MIT
"""Where a fleet's logs are: files, folders and addresses, in pieces that workers read by themselves."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from ..checks import shown
from ..counts.table import Columns
from ..errors import ConfigError, LogError
from ..learning.actions import Actions
from ..logs import read
from ..logs.controller_log import is_records
from ..logs.log import Log
from . import columns as foreign
from . import datasets, layout
from .logs import columns_of_log, numbered, reals_of_log
from .places import files_below, parquet, reading

_GROUPS = 4  # row groups in a piece, about a million interactions
_WHOLE = (".npz", ".csv")  # read at once, with the readers of rlvc.logs


@dataclasses.dataclass(frozen=True)
class Piece:
    """Part of a log, for one task.

    Attributes
    ----------
    path : str
        A path, an address such as ``s3://bucket/file``, or the name of a Minari data set.
    groups : tuple of int
        Row groups of a Parquet file, or episodes of a Minari data set; () : a file that is read at once.
    rows, bytes : int
        Interactions and bytes on disk; 0: unknown.
    kind : str
        How it is read: ``"groups"`` one by one, or at once: a ``"table"`` in Parquet, a ``"log"``, or
        the episodes of ``"minari"``.
    """

    path: str
    groups: tuple[int, ...] = ()
    rows: int = 0
    bytes: int = 0
    kind: str = "groups"


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
    encoder : Encoder or None
        Of the observations; None: they are percepts.
    known : Actions or None
        What the numbers of the actions mean; None: themselves.
    """

    pieces: tuple[Piece, ...]
    bits: int
    actions: int
    encoder: Any = None
    known: Actions | None = None

    @property
    def rows(self) -> int:
        """Interactions, as far as files tell before they are read."""
        return sum(piece.rows for piece in self.pieces)


def _is_whole(path: str) -> bool:
    return Path(path).suffix.lower() in _WHOLE or ("://" not in path and is_records(path))


def _facts(kind: Any, path: str) -> tuple[int, int]:
    """Return bits and actions of a Parquet file; actions 0: unknown."""
    if "percept" in kind.names:
        return layout.facts(kind, path)
    return foreign.bits_of(kind, path), 0


def _made(pieces: Sequence[Piece], log: Log, real: bool, actions: int) -> Source:
    """Return a source, from what its first log tells."""
    if real:
        encoder = reals_of_log(log)[2]
        bits = 0
    else:
        _, bits, encoder = columns_of_log(log)
    return Source(tuple(pieces), bits, actions, encoder)


def _of_log(path: str, real: bool) -> Source:
    log = numbered(read(path))
    piece = Piece(path, rows=len(log), bytes=Path(path).stat().st_size, kind="log")
    return _made((piece,), log, real, log.known.start + log.known.count)


def _of_tables(files: Sequence[str], real: bool) -> Source:
    """Return what Parquet files that are read at once hold; the actions are known of a single one."""
    pieces = []
    for name in files:
        with parquet(name) as file:
            if "percept" in file.schema_arrow.names:
                raise LogError(f"{name}: percepts of bits: a planner needs real numbers")
            meta = file.metadata
            size = sum(meta.row_group(i).total_byte_size for i in range(meta.num_row_groups))
        if meta.num_rows:
            pieces.append(Piece(name, (), meta.num_rows, size, "table"))
    if not pieces:
        raise LogError(f"{files[0]}: there is no interaction")
    log = numbered(datasets.from_table(pieces[0].path))
    actions = log.known.start + log.known.count if len(pieces) == 1 else 0
    return _made(pieces, log, real, actions)


def _of_file(path: str) -> Source:
    """Return what a file of row groups holds."""
    with parquet(path) as file:
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
    return Source(tuple(pieces), bits, actions)


def _of_minari(path: str, dataset: Any, real: bool) -> Source:
    """Return what a Minari data set holds."""
    cuts = datasets.episodes_of(dataset)
    pieces = [Piece(path, groups, rows, 0, "minari") for groups, rows in cuts]
    if not pieces:
        raise LogError(f"{path}: there is no interaction")
    log = datasets.read_episodes(path, pieces[0].groups)
    return dataclasses.replace(_made(pieces, log, real, log.known.count), known=log.known)


def _all_of(given: Any, real: bool) -> Iterator[tuple[str, Source]]:
    """Yield names, and what each holds."""
    if isinstance(given, str | Path):
        path = str(given)
        dataset = datasets.minari_of(path)
    else:
        dataset = given
        try:
            path = str(given.storage.data_path)  # of Minari
        except Exception:
            raise ConfigError(
                f"source: {shown(given)} is no path, address or Minari data set"
            ) from None
    if dataset is not None:
        yield path, _of_minari(path, dataset, real)
        return
    if datasets.is_lerobot(path):
        yield path, _of_tables(datasets.files_of_lerobot(path), real)
        return
    files = files_below(path, (".parquet",), _WHOLE)
    if real and not _is_whole(files[0]):
        yield path, _of_tables(files, real)
        return
    for file in files:
        yield file, _of_log(file, real) if _is_whole(file) else _of_file(file)


def opened(source: Any, real: bool = False) -> Source:
    """Find the pieces of a log, and check that their files fit together.

    Parameters
    ----------
    source : str, Path, minari.MinariDataset or sequence of these
        Files, folders, addresses or data sets.
    real : bool
        Whether observations are real numbers, and not bits.

    Raises
    ------
    LogError
        A file cannot be read, or has other percepts or actions than the first.
    """
    given = list(source) if isinstance(source, list | tuple) else [source]
    pieces: list[Piece] = []
    first: Source | None = None
    named = ""
    for each in given:
        for name, some in _all_of(each, real):
            first, named = first or some, named or name
            if some.bits != first.bits:
                raise LogError(f"{name}: {some.bits} bits, but {named} has {first.bits}")
            fixed = some.pieces and some.pieces[0].kind in ("groups", "minari")
            if some.actions and first.actions and fixed and some.actions != first.actions:
                raise LogError(f"{name}: {some.actions} actions, but {named} has {first.actions}")
            first = dataclasses.replace(first, actions=max(some.actions, first.actions))
            pieces += some.pieces
    if first is None or not pieces:
        raise LogError("the source holds no interaction")
    return dataclasses.replace(first, pieces=tuple(pieces))


# ------------------------------------------------------------------ reading a piece


def _group(file: Any, group: int, where: str, names: list[str]) -> Any:
    """Read a row group; an error names the column."""
    try:
        with reading(where):
            return file.read_row_group(group, columns=names, use_threads=False)
    except LogError:
        for name in names:
            with reading(f"{where}: column {name}"):
                file.read_row_group(group, columns=[name], use_threads=False)
        raise


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
    if piece.kind != "groups":
        try:
            yield piece.path, _fitting(log_of(piece), bits)
        except LogError as error:
            yield piece.path, error
        return
    try:
        file = parquet(piece.path)
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


def log_of(piece: Piece) -> Log:
    """Read a piece at once.

    Parameters
    ----------
    piece : Piece
        Not of row groups.
    """
    if piece.kind == "minari":
        return datasets.read_episodes(piece.path, piece.groups)
    return numbered(datasets.from_table(piece.path) if piece.kind == "table" else read(piece.path))


def _fitting(log: Log, bits: int) -> Columns:
    columns, found, _ = columns_of_log(log)
    if found != bits:
        raise LogError(f"{log.where}: percepts of {found} bits, not of {bits}")
    return columns
