# SPDX-License-Identifier: MIT
"""The kinds of values that options take. A wrong one is told in the same words everywhere."""

from __future__ import annotations

from argparse import ArgumentTypeError
from collections.abc import Callable


def whole(least: int | None = None) -> Callable[[str], int]:
    """Return the type of whole numbers, of at least `least` if one is given."""
    bound = "" if least is None else f" of at least {least}"

    def taken(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = None
        if value is None or (least is not None and value < least):
            raise ArgumentTypeError(f"{text!r:.80} is not a whole number{bound}")
        return value

    return taken


positive, natural = whole(1), whole(0)


def number(text: str) -> float:
    """Take a number."""
    try:
        return float(text)
    except ValueError:
        raise ArgumentTypeError(f"{text!r:.80} is not a number") from None


def truth(text: str) -> bool:
    """Take yes or no."""
    if text.lower() in ("true", "yes", "1"):
        return True
    if text.lower() in ("false", "no", "0"):
        return False
    raise ArgumentTypeError(f"{text!r:.80} is not one of yes, no")


def listed(text: str) -> list[str]:
    """Take names with commas between them."""
    names = text.split(",")
    if not all(name.strip() for name in names):
        raise ArgumentTypeError(f"{text!r:.80} has an empty name")
    return names


def bins(text: str) -> int | list[int]:
    """Take a whole number, or several with commas between them."""
    try:
        numbers = [int(part) for part in text.split(",")]
    except ValueError:
        raise ArgumentTypeError(f"{text!r:.80} is not a whole number, or a list A,B,...") from None
    return numbers[0] if len(numbers) == 1 else numbers


def roles(text: str) -> dict[str, list[str]]:
    """Take the columns for roles; a role that is named again has one more."""
    found: dict[str, list[str]] = {}
    for part in text.split(","):
        role, sign, name = part.partition("=")
        if not sign or not name:
            raise ArgumentTypeError(f"{part!r:.80} is not ROLE=COLUMN")
        found.setdefault(role.strip(), []).append(name.strip())
    return found
