# SPDX-License-Identifier: MIT
"""Logs in text files with a row for each interaction: CSV, TSV and their dialects."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import LogError
from .content import text_of
from .log import Log
from .roles import NAMES, are_numbered
from .table import Array, Table, from_table
from .values import column_of, is_value

_DELIMITERS = ",;\t|"
_COMMA = re.compile(r"[-+]?\d+,\d+(e[-+]?\d+)?", re.IGNORECASE | re.ASCII)
_NEEDED = {*NAMES["action"].split(), *NAMES["reward"].split()}


def from_csv(
    path: str | Path,
    columns: Sequence[str] | None = None,
    header: Sequence[str] | None = None,
    bins: int | None = None,
    roles: Mapping[str, Any] | None = None,
) -> Log:
    """Read a log from a CSV file.

    Parameters
    ----------
    path : str or Path
        The delimiter is a comma, semicolon, tab or bar, or blanks; with the latter a number may have
        a decimal comma. Lines that begin with # or % are comments. :mod:`rlvc.logs.roles` lists the
        names of columns. Without columns for the next observation, it is in the next line; a line
        without an action holds the last one of an episode. An interaction that did not terminate and has
        no observation after it is left out.
    columns : sequence of str or None
        Columns of the observation. None: those that are named so, else all without another meaning.
    header : sequence of str or None
        The names of the columns, if the file has none.
    bins : int or None
        Of actions that are real numbers: into how many they are divided.
    roles : mapping or None
        Columns for roles, as for :func:`rlvc.learn_from`.
    """
    return from_table(table_of(path, header), columns, bins, given=roles)


def table_of(path: str | Path, header: Sequence[str] | None = None) -> Table:
    """Read the table of a text file."""
    notes: list[str] = []
    lost: list[str] = []
    text = text_of(path, notes, lost)
    lines, comment = _lines(text, path)
    if not lines:
        raise LogError(f"{path}: is empty: there is no interaction")
    delimiter = _delimiter(lines)
    rows = _fields(lines, delimiter, path, lost if _is_cut(text) else None)
    names, rows, head = _named(rows, header, comment, delimiter, path)
    again = [line for line, row in rows if row == names]
    parts = np.array([sum(line > other for other in again) for line, row in rows if row != names])
    rows = [row for row in rows if row[1] != names]
    if again:
        notes.append(f"the names of the columns stand again in line {again[0]}: another log begins")
    names, rows = _without_blanks(names, rows)
    if _is_cut(text) and len(rows) > 1 and _stops_short(names, rows):
        lost.append(f"line {rows.pop()[0]} is cut off, and left out")
        parts = parts[: len(rows)]
    names = _apart(names, f"{path}: {head}", notes)
    for line, row in rows:
        if len(row) != len(names):
            raise LogError(f"{path}: line {line}: {len(row)} fields, not {len(names)}")
    names = [name or f"column {i + 1}" for i, name in enumerate(names)]
    if delimiter != ",":
        name = {" ": "blanks", "\t": "tab"}.get(delimiter, delimiter)
        notes.append(f"delimiter: {name}")
    numbers = [line for line, _ in rows]

    def place(i: int) -> str:
        return f"line {numbers[i]}"

    parsed: dict[str, Array] = {}
    for i, name in enumerate(names):
        texts = _with_points([row[i] for _, row in rows], name, delimiter, place, notes, path)
        parsed[name] = column_of(name, texts, place, str(path), notes)
    kept = parts if again else None
    return Table(parsed, place, str(path), notes, head, kept, lost)


def _is_cut(text: str) -> bool:
    """Whether a text may have been cut off: its last line has no end."""
    return not text.endswith(("\n", "\r"))


def _stops_short(names: list[str], rows: list[tuple[int, list[str]]]) -> bool:
    """Whether the last row lacks fields, or its last word is the beginning of one above it."""
    last = rows[-1][1]
    if len(last) != len(names):
        return len(last) < len(names)
    words = {row[-1] for _, row in rows[:-1] if len(row) == len(names)}
    begun = any(word.startswith(last[-1]) for word in words - {last[-1]})
    return last[-1] not in words and last[-1].isalpha() and begun


def _apart(names: list[str], where: str, notes: list[str]) -> list[str]:
    """Columns of the observation that have one name as x_0, x_1; those of other roles are refused."""
    places: dict[str, list[int]] = {}
    for i, name in enumerate(names):
        places.setdefault(name, []).append(i)
    twice = {name: found for name, found in places.items() if name and len(found) > 1}
    numbered = {name: [f"{name}_{k}" for k in range(len(found))] for name, found in twice.items()}
    alike = are_numbered(numbered, names) if twice else set()
    made = list(names)
    for name, found in twice.items():
        if name not in alike or not places.keys().isdisjoint(numbered[name]):
            columns = " and ".join(str(i + 1) for i in found)
            raise LogError(
                f"{where}: columns {columns} have the same name {name}: rename them, or leave one out"
            )
        for i, unique in zip(found, numbered[name], strict=True):
            made[i] = unique
        notes.append(f"{len(found)} columns are named {name}: taken as {', '.join(numbered[name])}")
    return made


def _without_blanks(
    names: list[str], rows: list[tuple[int, list[str]]]
) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """Leave out a last field that is blank in each row, after a delimiter at the end of the line."""
    if rows and all(
        len(row) == len(names) + (names[-1] != "") and row[-1] == "" for _, row in rows
    ):
        named = names if names[-1] else names[:-1]
        return named, [(line, row[:-1]) for line, row in rows]
    return names, rows


def _with_points(
    texts: list[str],
    name: str,
    delimiter: str,
    place: Any,
    notes: list[str],
    path: str | Path,
) -> list[str]:
    """Numbers with a decimal comma as such with a point."""
    found = [i for i, text in enumerate(texts) if _COMMA.fullmatch(text)]
    if not found:
        return texts
    others = [t for i, t in enumerate(texts) if not _COMMA.fullmatch(t) and not is_value(t)]
    if others:
        return texts
    grouped = all(re.fullmatch(r"[-+]?[1-9]\d{0,2},\d{3}", texts[i]) for i in found)
    if delimiter == "," and grouped:
        raise LogError(
            f"{path}: {place(found[0])}: {name}: {texts[found[0]]} may be a thousand or a fraction: "
            "write numbers without commas"
        )
    if "decimal comma" not in notes:
        notes.append("decimal comma")
    return [text.replace(",", ".") if _COMMA.fullmatch(text) else text for text in texts]


def _lines(text: str, path: str | Path) -> tuple[list[tuple[int, str]], str]:
    """The lines that are neither blank nor comments, with their numbers; and the last comment before."""
    lines: list[tuple[int, str]] = []
    comment = ""
    text = text.translate({ord("\f"): " ", ord("\v"): " "})
    for number, line in enumerate(io.StringIO(text, newline=None).read().split("\n"), 1):
        bad = next((c for c in line if ord(c) < 32 and c != "\t"), None)
        if bad is not None:
            raise LogError(f"{path}: line {number}: a control character {bad!r}: not a text file")
        if line.lstrip().startswith(("#", "%")):
            comment = comment if lines else line.lstrip().lstrip("#%").strip()
        elif re.fullmatch(r"sep=.", line.strip(), re.IGNORECASE) and not lines:
            continue  # Excel's; the delimiter shows itself
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
    lines: list[tuple[int, str]], delimiter: str, path: str | Path, cut: list[str] | None
) -> list[tuple[int, list[str]]]:
    """The fields of each row; one cut off within quotes at the end is left out, and `cut` says so."""
    rows: list[tuple[int, list[str]]] = []
    beside = re.compile(f'"[ \\t]+(?={re.escape(delimiter)})')  # blanks after a quoted field
    try:
        reader = csv.reader(
            (beside.sub('"', line.strip(" ")) for _, line in lines),
            delimiter=delimiter,
            strict=True,
            skipinitialspace=True,
        )
        before = 0  # lines of the rows so far
        for row in reader:
            number = lines[reader.line_num - 1][0]
            rows.append((number, _joined([field.strip() for field in row], delimiter)))
            before = reader.line_num
    except csv.Error as error:
        number = lines[min(before, len(lines) - 1)][0]
        if cut is None or not rows or before < len(lines) - 1:
            raise LogError(f"{path}: line {number}: cannot be read as CSV: {error}") from error
        cut.append(f"line {number} is cut off, and left out")
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
        beside = comment.split() if delimiter == " " else comment.split(delimiter)
        beside = [name.strip() for name in beside]
        told = len(beside) == len(names) and len(_NEEDED & {name.lower() for name in beside}) > 1
        if names and (told or all(is_value(name) for name in names)):
            if len(beside) != len(names):
                raise LogError(
                    f"{path}: line {line}: numbers where the names of the columns should be: pass "
                    f"header=[...], the {len(names)} names"
                )
            rows, names, head = [(line, names), *rows], beside, "the comment"
    return names, rows, head
