# SPDX-License-Identifier: MIT
"""How a learner packs percepts: what a user-defined domain returns is checked before C sees it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..checks import flag, shown
from ..errors import DomainError
from .bags import Bags
from .bits import Bits
from .descriptors import Descriptors
from .domain import Domain
from .spatial import Spatial
from .thresholds import Thresholds

_READY_MADE = (Bags, Bits, Descriptors, Spatial, Thresholds)


class Packing(NamedTuple):
    """The methods ``pack``, ``pack_many`` and ``is_one`` of a domain."""

    one: Callable[[Any], bytes]
    many: Callable[[Any], npt.NDArray[Any]]
    is_one: Callable[[Any], bool]


def packing(domain: Domain) -> Packing:
    """Return the methods of a ready-made domain, or those of another one, checked.

    Parameters
    ----------
    domain : Domain
        One whose ``native`` has been called, so that it has its sizes.

    Returns
    -------
    Packing
        Each raises DomainError where the domain returns something else than it should.
    """
    if type(domain) in _READY_MADE:
        return Packing(domain.pack, domain.pack_many, domain.is_one)
    for name in ("pack", "pack_many", "is_one", "check_many"):
        if not callable(getattr(domain, name)):
            raise DomainError(f"{name}: {shown(getattr(domain, name))} is not a method")
    pack, pack_many, is_one = domain.pack, domain.pack_many, domain.is_one
    size = domain.percept_bytes

    def one(percept: Any) -> bytes:
        packed = pack(percept)
        if type(packed) is not bytes or len(packed) != size:
            raise DomainError(f"pack() returned {shown(packed)}, expected {size} bytes")
        return packed

    def many(percepts: Any) -> npt.NDArray[Any]:
        packed = pack_many(percepts)
        if (
            not isinstance(packed, np.ndarray)
            or packed.ndim == 0
            or packed.nbytes != len(packed) * size
            or not packed.flags.c_contiguous
        ):
            raise DomainError(
                f"pack_many() returned {shown(packed)}, expected an array of n times {size} bytes"
            )
        return packed

    return Packing(one, many, lambda percept: flag("is_one()", is_one(percept), DomainError))
