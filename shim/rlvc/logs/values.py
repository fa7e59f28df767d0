# SPDX-License-Identifier: MIT
"""Texts of a column as numbers, arrays or words."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from ..errors import LogError

Array = npt.NDArray[Any]
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE | re.ASCII)
_MEASURE = re.compile(
    r"([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))\s*([^\W\d_x][^\s\d]*|[%°€$£¥]\S*)"
)  # 21.5 C
_BITS = re.compile(r"[01]{2,}", re.ASCII)
_FLAGS = {"true": 1.0, "false": 0.0, "yes": 1.0, "no": 0.0, "t": 1.0, "f": 0.0, "y": 1.0, "n": 0.0}
MISSING = {"", "nan", "na", "n/a", "null", "none", "-", "?"}
"""Texts that stand for a value that is missing."""
_INFINITE = {
    f"{sign}{word}": -np.inf if sign == "-" else np.inf
    for sign in ("", "+", "-")
    for word in ("inf", "infinity", "1.#inf", "1.#inf00")
}
_UNSEEN = dict.fromkeys(map(ord, "\u200b\u200c\u200d\u200e\u200f\u2060\ufeff"))
_SIGNS = {ord("\u2212"): "-", ord("\u066b"): "."}  # of mathematics and of Arabic
_EXPONENT = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+))d([-+]?\d+)", re.IGNORECASE | re.ASCII)
_BASED = re.compile(  # not of any length, as Python refuses to spell very long ones
    r"[-+]?0(?:x[0-9a-f]{1,200}|o[0-7]{1,200}|b[01]{1,200})", re.IGNORECASE | re.ASCII
)
_GROUPED = re.compile(r"[-+]?\d{1,3}(?:['\u2019 \u00a0\u202f]\d{3})+(?:\.\d+)?", re.ASCII)
_UNDERSCORES = re.compile(r"[-+]?\d+(?:_\d+)+", re.ASCII)
_UNDEFINED = re.compile(r"[-+]?(?:1\.#(?:ind|qnan|snan)\w*|nan\(\w*\))", re.IGNORECASE)


def _in_ascii(text: str) -> str:
    """A text with the digits 0 to 9 and the sign - in place of those of other scripts."""
    if text.isascii():
        return text
    text = text.translate(_UNSEEN).translate(_SIGNS)
    return "".join(str(unicodedata.decimal(c, c)) for c in text)


_SPELLINGS: tuple[tuple[str, re.Pattern[str], Callable[[str], str]], ...] = (
    ("numbers of base 16, 8 or 2", _BASED, lambda text: str(int(text, 0))),
    ("numbers with the exponent D", _EXPONENT, lambda text: _EXPONENT.sub(r"\1e\2", text)),
    ("digits in groups", _GROUPED, lambda text: re.sub(r"['\u2019 \u00a0\u202f]", "", text)),
    ("digits in groups", _UNDERSCORES, lambda text: text.replace("_", "")),
    ("nan is missing", _UNDEFINED, lambda text: "nan"),
)
"""Spellings of numbers: what a note calls them, how they look, and the same as plain numbers."""


def is_value(text: str) -> bool:
    """Whether a text is a number, or stands for a missing one."""
    return bool(_NUMBER.fullmatch(text)) or text.lower() in MISSING


def column_of(name: str, texts: list[str], place: Any, where: str, notes: list[str]) -> Array:
    """Turn the texts of a column into numbers, arrays or words.

    Parameters
    ----------
    name : str
    texts : list of str
    place : callable
        Says where a row is.
    where : str
        The file, for errors.
    notes : list of str
        Takes a line about what had to be guessed.

    Returns
    -------
    ndarray, [n] or [n, k] of float64, or [n] of words
    """
    texts = _plainer(name, texts, notes)
    bits = len(set(map(len, texts))) == 1 and all(map(_BITS.fullmatch, texts))
    if bits and any(text[0] == "0" for text in texts):
        notes.append(f"{name}: {len(texts[0])} bits")
        return np.array([[float(bit) for bit in text] for text in texts])
    values = np.full(len(texts), np.nan)
    words: list[int] = []
    for i, text in enumerate(texts):
        lowered = text.lower()
        if _NUMBER.fullmatch(text):
            values[i] = float(text)
            if np.isinf(values[i]):
                raise LogError(f"{where}: {place(i)}: {name}: {text:.40} is beyond 1e15: scale it")
        elif lowered in _FLAGS:
            values[i] = _FLAGS[lowered]
            words.append(i) if len(text) == 1 else None
        elif lowered in _INFINITE:
            values[i] = _INFINITE[lowered]
        elif lowered not in MISSING:
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
    blank = {i for i, text in enumerate(texts) if text.lower() in MISSING}
    return np.array([None if i in blank else text for i, text in enumerate(texts)], object)


def _plainer(name: str, texts: list[str], notes: list[str]) -> list[str]:
    """Numbers with a unit, or in one of the spellings, as plain ones."""
    there = sum(text.lower() not in MISSING for text in texts)
    some = [text for text in texts if not _is_plain(text)]
    if not some or not there:
        return texts
    measures = [_MEASURE.fullmatch(text) for text in some]
    units = {match[2] for match in measures if match}
    if len(some) == there and all(measures) and len(units) == 1:
        notes.append(f"{name}: numbers of the unit {units.pop()}")
        return [m[1] if (m := _MEASURE.fullmatch(text)) else text for text in texts]
    plain: dict[str, str] = {}
    used: dict[str, str] = {}
    for text in dict.fromkeys(some):
        ascii_text = _in_ascii(text)
        label, made = _spelled(ascii_text)
        if not _is_plain(made):
            return texts
        plain[text] = made
        used.setdefault(label or "digits or signs beyond ASCII", text)
    if list(used) == ["digits in groups"] and len(some) == there and _are_places(some):
        return texts
    notes.append(f"{name}: {', '.join(f'{label} ({text!r})' for label, text in used.items())}")
    return [plain.get(text, text) for text in texts]


def _is_plain(text: str) -> bool:
    return is_value(text) or text.lower() in _INFINITE


def _spelled(text: str) -> tuple[str, str]:
    """The spelling of a number, and the plain number; the text itself if it has none."""
    for label, pattern, made in _SPELLINGS:
        if pattern.fullmatch(text):
            return label, made(text)
    return "", text


def _are_places(texts: list[str]) -> bool:
    """Whether texts such as 1_0 are rows and columns, and not thousands: then they are words."""
    return not all(re.fullmatch(r"[-+]?\d{1,3}([^\d]\d{3})+(\.\d+)?", text) for text in texts)


def _arrays(name: str, texts: list[str], place: Any, where: str) -> Array:
    """Arrays written in brackets: (0, 1) or [1.0 0.5]."""
    rows: list[list[float]] = []
    for i, text in enumerate(texts):
        inner = [part for part in re.split(r"[\s,;()\[\]]+", text) if part]
        if not all(_NUMBER.fullmatch(part) for part in inner):
            if text.lower() in MISSING:
                rows.append([])
                continue
            raise LogError(f"{where}: {place(i)}: {name}: {text!r:.40} is no array of numbers")
        rows.append([float(part) for part in inner])
    width = max(map(len, rows))
    for i, row in enumerate(rows):
        if len(row) not in (0, width):
            raise LogError(f"{where}: {place(i)}: {name}: {len(row)} numbers, expected {width}")
    return np.array([row or [np.nan] * width for row in rows])
