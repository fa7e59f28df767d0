# SPDX-License-Identifier: MIT
"""Texts of a column as numbers, arrays or words."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import numpy.typing as npt

from ..errors import LogError

Array = npt.NDArray[Any]
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE | re.ASCII)
_MEASURE = re.compile(
    r"([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))\s*([^\W\d_x][^\s\d]*|[%°]\S*)"
)  # 21.5 C
_HEX = re.compile(r"0x[0-9a-f]+", re.IGNORECASE | re.ASCII)
_BITS = re.compile(r"[01]{2,}", re.ASCII)
_FLAGS = {"true": 1.0, "false": 0.0, "yes": 1.0, "no": 0.0, "t": 1.0, "f": 0.0, "y": 1.0, "n": 0.0}
MISSING = {"", "nan", "na", "n/a", "null", "none", "-", "?"}
"""Texts that stand for a value that is missing."""
_INFINITE = {
    "inf": np.inf,
    "+inf": np.inf,
    "-inf": -np.inf,
    "infinity": np.inf,
    "-infinity": -np.inf,
}


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
    """Numbers with one unit, or of base 16, as plain ones."""
    some = [text for text in texts if not is_value(text)]
    if len(some) < sum(text.lower() not in MISSING for text in texts):
        return texts
    measures = [_MEASURE.fullmatch(text) for text in some]
    units = {match[2] for match in measures if match}
    if some and all(measures) and len(units) == 1:
        notes.append(f"{name}: numbers of the unit {units.pop()}")
        return [m[1] if (m := _MEASURE.fullmatch(text)) else text for text in texts]
    if some and all(map(_HEX.fullmatch, some)):
        notes.append(f"{name}: numbers of base 16")
        return [str(int(text, 16)) if text in some else text for text in texts]
    return texts


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
