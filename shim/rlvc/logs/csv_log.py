# SPDX-License-Identifier: MIT
"""Logs in text files with a row for each interaction: CSV, TSV and their dialects."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import LogError
from ..files import read
from .log import Log
from .table import Array, Table, from_table

_DELIMITERS = ",;\t|"
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE | re.ASCII)
_COMMA = re.compile(r"[-+]?\d+,\d+(e[-+]?\d+)?", re.IGNORECASE | re.ASCII)
_FLAGS = {"true": 1.0, "false": 0.0, "yes": 1.0, "no": 0.0, "t": 1.0, "f": 0.0, "y": 1.0, "n": 0.0}
_MISSING = {"", "nan", "na", "n/a", "null", "none", "-", "?"}
_INFINITE = {
    "inf": np.inf,
    "+inf": np.inf,
    "-inf": -np.inf,
    "infinity": np.inf,
    "-infinity": -np.inf,
}
_ENCODINGS = ((b"\xef\xbb\xbf", "utf-8-sig"), (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"))


def from_csv(
    path: str | Path,
    columns: Sequence[str] | None = None,
    header: Sequence[str] | None = None,
    bins: int | None = None,
) -> Log:
    """Read a log from a CSV file.

    Parameters
    ----------
    path : str or Path
        The delimiter is a comma, semicolon, tab or bar; with the latter three a number may have a
        decimal comma. Lines that begin with # are comments. :mod:`rlvc.logs.roles` lists the names of
        columns. Without columns for the next observation, it is in the next line; a line without an
        action holds the last one of an episode. An interaction that did not terminate and has no
        observation after it is left out.
    columns : sequence of str or None
        Columns of the observation. None: those that are named so, else all without another meaning.
    header : sequence of str or None
        The names of the columns, if the file has none.
    bins : int or None
        Of actions that are real numbers: into how many they are divided.
    """
    return from_table(table_of(path, header), columns, bins)


def table_of(path: str | Path, header: Sequence[str] | None = None) -> Table:
    """Read the table of a text file."""
    try:
        text = _decoded(read(path))
    except (OSError, UnicodeError) as error:
        raise LogError(f"{path}: cannot be read as CSV: {error}") from error
    notes: list[str] = []
    lines, comment = _lines(text, path)
    delimiter = _delimiter(lines)
    rows = _fields(lines, delimiter, path)
    names, rows, head = _named(rows, header, comment, delimiter, path)
    again = [line for line, row in rows if row == names]
    parts = np.array([sum(line > other for other in again) for line, row in rows if row != names])
    rows = [row for row in rows if row[1] != names]
    if again:
        notes.append(f"the names of the columns stand again in line {again[0]}: another log begins")
    for line, row in rows:
        if len(row) != len(names):
            raise LogError(f"{path}: line {line}: {len(row)} fields, not {len(names)}")
    names = [name or f"column {i + 1}" for i, name in enumerate(names)]
    if delimiter != ",":
        name = {" ": "blanks", "\t": "tab"}.get(delimiter, delimiter)
        notes.append(f"delimiter: {name}")
    comma = delimiter != "," and any(_COMMA.fullmatch(text) for _, row in rows for text in row)
    if comma:
        notes.append("decimal comma")
    numbers = [line for line, _ in rows]
    parsed: dict[str, Array] = {}
    for i, name in enumerate(names):
        texts = [row[i] for _, row in rows]
        if comma:
            texts = [text.replace(",", ".") if _COMMA.fullmatch(text) else text for text in texts]
        parsed[name] = column_of(name, texts, lambda i: f"line {numbers[i]}", str(path))
    kept = parts if again else None
    return Table(parsed, lambda i: f"line {numbers[i]}", str(path), notes, head, kept)


def _decoded(content: bytes) -> str:
    encoding = next((name for mark, name in _ENCODINGS if content.startswith(mark)), "utf-8")
    text = content.decode(encoding)
    return text.removesuffix("\x1a")  # an old end of file


def _lines(text: str, path: str | Path) -> tuple[list[tuple[int, str]], str]:
    """The lines that are neither blank nor comments, with their numbers; and the last comment before."""
    lines: list[tuple[int, str]] = []
    comment = ""
    for number, line in enumerate(io.StringIO(text, newline=None).read().split("\n"), 1):
        bad = next((c for c in line if ord(c) < 32 and c != "\t"), None)
        if bad is not None:
            raise LogError(f"{path}: line {number}: a control character {bad!r}: not a text file")
        if line.lstrip().startswith("#"):
            comment = comment if lines else line.lstrip().lstrip("#").strip()
        elif line.strip():
            lines.append((number, line))
    return lines, comment


def _delimiter(lines: list[tuple[int, str]]) -> str:
    """What divides the first lines into the same number of fields, at least two."""
    sample = [_unquoted(line) for _, line in lines[:20]]
    best, most = ",", 0
    if sample and not any(delimiter in sample[0] for delimiter in _DELIMITERS):
        best = " " if len(sample[0].split()) > 1 else ","
    for delimiter in _DELIMITERS:
        counts = [line.count(delimiter) for line in sample[:1]]
        if counts and counts[0] > most:
            best, most = delimiter, counts[0]
    return best


def _unquoted(line: str) -> str:
    return re.sub(r'"[^"]*"', "", line)


def _fields(
    lines: list[tuple[int, str]], delimiter: str, path: str | Path
) -> list[tuple[int, list[str]]]:
    beside = re.compile(f'"[ \\t]+(?={re.escape(delimiter)})')  # blanks after a quoted field
    try:
        reader = csv.reader(
            (beside.sub('"', line.strip(" ")) for _, line in lines),
            delimiter=delimiter,
            strict=True,
            skipinitialspace=True,
        )
        rows = []
        for row in reader:
            number = lines[reader.line_num - 1][0]
            rows.append((number, _joined([field.strip() for field in row], delimiter)))
    except csv.Error as error:
        raise LogError(f"{path}: cannot be read as CSV: {error}") from error
    return rows


def _joined(fields: list[str], delimiter: str) -> list[str]:
    """Put together what a delimiter within brackets divided: (0 and 1) is (0,1)."""
    if not any("(" in field or "[" in field for field in fields):
        return fields
    joined: list[str] = []
    depth = 0
    for field in fields:
        if depth > 0:
            joined[-1] += delimiter + field
        else:
            joined.append(field)
        depth += sum(field.count(c) for c in "([") - sum(field.count(c) for c in ")]")
    return joined


def _named(
    rows: list[tuple[int, list[str]]],
    header: Sequence[str] | None,
    comment: str,
    delimiter: str,
    path: str | Path,
) -> tuple[list[str], list[tuple[int, list[str]]], str]:
    """The names of the columns, the rows below, and where the names are."""
    head = "header"
    if header is not None:
        names = [str(name) for name in header]
    else:
        line, names = rows[0] if rows else (1, [])
        head = f"line {line}"
        rows = rows[1:]
        if names and all(_is_value(name) for name in names):
            beside = [name.strip() for name in comment.split(delimiter)]
            if len(beside) != len(names):
                raise LogError(
                    f"{path}: line {line}: numbers where the names of the columns should be: pass "
                    f"header=[...], the {len(names)} names"
                )
            rows, names, head = [(line, names), *rows], beside, "the comment"
    if len(set(names)) != len(names):
        raise LogError(f"{path}: {head}: two columns have the same name")
    return names, rows, head


def _is_value(text: str) -> bool:
    return bool(_NUMBER.fullmatch(text)) or text.lower() in _MISSING


def column_of(name: str, texts: list[str], place: Any, where: str) -> Array:
    """Turn the texts of a column into numbers, arrays or words.

    Parameters
    ----------
    name : str
    texts : list of str
    place : callable
        Says where a row is.
    where : str
        The file, for errors.

    Returns
    -------
    ndarray, [n] or [n, k] of float64, or [n] of words
    """
    values = np.full(len(texts), np.nan)
    words: list[int] = []
    for i, text in enumerate(texts):
        lowered = text.lower()
        if _NUMBER.fullmatch(text):
            values[i] = float(text)
        elif lowered in _FLAGS:
            values[i] = _FLAGS[lowered]
            words.append(i) if len(text) == 1 else None
        elif lowered in _INFINITE:
            values[i] = _INFINITE[lowered]
        elif lowered not in _MISSING:
            words.append(i)
    if not words:
        return values
    if texts[words[0]][0] in "([":
        return _arrays(name, texts, place, where)
    plain = [i for i, text in enumerate(texts) if _NUMBER.fullmatch(text)]
    if plain:
        i = words[0]
        raise LogError(f"{where}: {place(i)}: {name}: {texts[i]!r:.40} is not a number")
    if all(len(texts[i]) == 1 and texts[i].lower() in _FLAGS for i in words):
        return values
    blank = {i for i, text in enumerate(texts) if text.lower() in _MISSING}
    return np.array([None if i in blank else text for i, text in enumerate(texts)], object)


def _arrays(name: str, texts: list[str], place: Any, where: str) -> Array:
    """Arrays written in brackets: (0, 1) or [1.0 0.5]."""
    rows: list[list[float]] = []
    for i, text in enumerate(texts):
        inner = [part for part in re.split(r"[\s,;()\[\]]+", text) if part]
        if not all(_NUMBER.fullmatch(part) for part in inner):
            if text.lower() in _MISSING:
                rows.append([])
                continue
            raise LogError(f"{where}: {place(i)}: {name}: {text!r:.40} is no array of numbers")
        rows.append([float(part) for part in inner])
    width = max(map(len, rows))
    for i, row in enumerate(rows):
        if len(row) not in (0, width):
            raise LogError(f"{where}: {place(i)}: {name}: {len(row)} numbers, expected {width}")
    return np.array([row or [np.nan] * width for row in rows])
