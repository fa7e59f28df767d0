# SPDX-License-Identifier: MIT
"""Tests of a tree in the words of a space: ``x[2] > 0.1`` becomes ``angle > 0.1``."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?"
_TEST = re.compile(rf"\bbit (\d+)\b|\bx\[(\d+)\](?: > ({_NUMBER}))?")


def shortest(number: float) -> str:
    """Spell a float of 32 bits by the fewest digits that tell it from every other.

    Parameters
    ----------
    number : float

    Returns
    -------
    str
    """
    small = np.float32(number)
    if small == 0 or 1e-5 <= abs(small) < 1e9:
        return np.format_float_positional(small, unique=True, trim="-")
    return np.format_float_scientific(small, unique=True, trim="-", exp_digits=1)


def explain(text: str, names: Sequence[str], flags: Sequence[bool] = ()) -> str:
    """Replace ``bit N`` and ``x[N]`` in a text by the name number N.

    Parameters
    ----------
    text : str
    names : sequence of str
    flags : sequence of bool
        Which components are 0 or 1: their name alone is the test, without a cutpoint.

    Returns
    -------
    str
    """

    def name(match: re.Match[str]) -> str:
        index = int(match[1] or match[2])
        if index >= len(names):
            return match[0]
        if match[3] is None:
            return names[index]
        if index < len(flags) and flags[index] and 0 <= float(match[3]) < 1:
            return names[index]
        return f"{names[index]} > {match[3]}"

    return _TEST.sub(name, text)
