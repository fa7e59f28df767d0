# SPDX-License-Identifier: MIT
"""The C callbacks of a domain that is written in Python."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..errors import DomainError

if TYPE_CHECKING:
    from .domain import Domain


class Guard:
    """What the callbacks of one agent's domain tell the agent.

    Attributes
    ----------
    error : BaseException or None
        What a callback raised, until the call that caused it raises it again.
    depth : int
        How many callbacks are running.
    """

    def __init__(self) -> None:
        self.error: BaseException | None = None
        self.depth = 0


class Callbacks:
    """The C callbacks of a domain in Python. Each returns 0, or 1 after it has kept an exception."""

    def __init__(self, domain: Domain, guard: Guard) -> None:
        self.domain = domain
        self.guard = guard
        self.listed: tuple[bytes, bytes] | None = None  # samples, and the candidates for them

    def native(self) -> _native.Domain:
        """Make the C struct, which keeps its callbacks alive."""
        domain = self.domain
        native = _native.Domain()
        native.percept_bytes = domain.percept_bytes
        native.feature_bytes = domain.feature_bytes
        native.features_max = domain.features_max
        native.exhibits = _native.DOMAIN_EXHIBITS(self.guarded(self.exhibits))
        native.name = _native.DOMAIN_NAME(self.guarded(self.name))
        native.candidates = _native.DOMAIN_CANDIDATES(self.guarded(self.candidates))
        if domain.detect is not None:
            native.detect = _native.DOMAIN_DETECT(self.guarded(self.detect))
        if domain.oracle is not None:
            native.oracle = _native.DOMAIN_ORACLE(self.guarded(self.oracle))
        return native

    def guarded(self, callback: Callable[..., None]) -> Callable[..., int]:
        """Wrap a callback: what it raises is kept, and C gets 1."""
        guard = self.guard

        def call(_ctx: int | None, *arguments: Any) -> int:
            guard.depth += 1
            try:
                callback(*arguments)
            except (
                BaseException
            ) as error:  # KeyboardInterrupt too: it comes out of the agent's call
                guard.error = error
                return 1
            finally:
                guard.depth -= 1
            return 0

        return call

    def percepts(self, records: bytes, count: int) -> npt.NDArray[Any]:
        """Give records as an array of percepts."""
        flat = np.frombuffer(records, self.domain.percept_dtype)
        return flat.reshape(count, *self.domain.percept_shape)

    def gather(self, samples: _native.Samples, first: int, count: int) -> npt.NDArray[Any]:
        """Copy the percepts of some samples: [count, *percept_shape]."""
        size = ctypes.sizeof(_native.Sample)
        pairs = np.frombuffer(
            ctypes.string_at(samples.sample + first * size, count * size), np.uint32
        )
        slots = pairs[1::2].astype(np.intp)
        record = samples.percept_bytes
        top = int(slots.max()) + 1
        ring = (ctypes.c_uint8 * (top * record)).from_address(samples.percepts)
        return self.percepts(
            np.frombuffer(ring, np.uint8).reshape(top, record)[slots].tobytes(), count
        )

    def exhibits(self, percept: int, feature: int, present: Any) -> None:
        """``rlvc_domain.exhibits``."""
        domain = self.domain
        one = self.percepts(ctypes.string_at(percept, domain.percept_bytes), 1)[0]
        answer = domain.exhibits(
            one, domain.feature(ctypes.string_at(feature, domain.feature_bytes))
        )
        if not isinstance(answer, bool | np.bool_):
            raise DomainError(f"exhibits() returned {answer!r}, not a bool")
        present[0] = bool(answer)

    def name(self, feature: int, text: int, room: int) -> None:
        """``rlvc_domain.name``."""
        record = ctypes.string_at(feature, self.domain.feature_bytes)
        encoded = checked_name(self.domain.name(self.domain.feature(record)), room)
        ctypes.memmove(text, encoded + b"\0", len(encoded) + 1)

    def candidates(
        self, reference: Any, first: int, room: int, features: int, written: Any
    ) -> None:
        """``rlvc_domain.candidates``: lists the features once, and copies a part of them."""
        samples = reference[0]
        key = ctypes.string_at(samples.sample, samples.count * ctypes.sizeof(_native.Sample))
        if first == 0 or self.listed is None or self.listed[0] != key:
            found = self.domain.candidates(self.gather(samples, 0, samples.count))
            self.listed = (key, self.records(found))
        size = self.domain.feature_bytes
        part = self.listed[1][first * size : (first + room) * size]
        ctypes.memmove(features, part, len(part))
        written[0] = len(part) // size

    def records(self, features: Any) -> bytes:
        """Give the records of an array of features."""
        wanted = self.domain.feature_dtype
        if not isinstance(features, np.ndarray) or features.ndim != 1 or features.dtype != wanted:
            kind = getattr(features, "dtype", type(features).__name__)
            raise DomainError(
                f"candidates() returned {kind}{list(getattr(features, 'shape', []))}, not an array "
                f"{wanted}['features']"
            )
        return features.tobytes()

    def detect(
        self, reference: Any, first: int, n: int, features: int, m: int, columns: Any
    ) -> None:
        """``rlvc_domain.detect``."""
        domain = self.domain
        assert domain.detect is not None
        offered = np.frombuffer(
            ctypes.string_at(features, m * domain.feature_bytes), domain.feature_dtype
        )
        answer = domain.detect(self.gather(reference[0], first, n), offered)
        if not isinstance(answer, np.ndarray) or answer.dtype != np.bool_ or answer.shape != (n, m):
            raise DomainError(f"detect() returned {answer!r:.80}, not an array bool[{n}, {m}]")
        words = np.zeros((m, _native.DETECT_SAMPLES // 8), np.uint8)
        packed = np.packbits(answer.T, axis=1, bitorder="little")
        words[:, : packed.shape[1]] = packed
        for j, word in enumerate(words.view("<u8")[:, 0]):
            columns[j] = int(word)

    def oracle(self, reference: Any, below: int, feature: int, considered: Any) -> None:
        """``rlvc_domain.oracle``."""
        domain = self.domain
        assert domain.oracle is not None
        answer = domain.oracle(self.gather(reference[0], 0, reference[0].count), below)
        if answer is None:
            considered[0] = 0
            return
        try:
            proposed, among = answer
            count = int(among.__index__())
            record = (
                np.array([proposed]).astype(domain.feature_dtype, casting="same_kind").tobytes()
            )
        except (AttributeError, TypeError, ValueError) as error:
            raise DomainError(
                f"oracle() returned {answer!r:.80}, not (feature, considered) or None"
            ) from error
        if len(record) != domain.feature_bytes or not 1 <= count < 2**32:
            raise DomainError(f"oracle() returned {answer!r:.80}: considered is at least 1")
        ctypes.memmove(feature, record, len(record))
        considered[0] = count


def checked_name(name: object, room: int = _native.NAME_BYTES) -> bytes:
    """Encode a feature's name.

    Raises
    ------
    DomainError
        It is no text, too long, or has a character that does not fit into JSON and DOT as it is.
    """
    if not isinstance(name, str):
        raise DomainError(f"name() returned {name!r:.80}, not a str")
    encoded = name.encode(errors="replace")
    if len(encoded) >= room or any(ord(sign) < 32 or sign in '"\\\x7f' for sign in name):
        raise DomainError(
            f"name() returned {name!r:.80}: at most {room - 1} bytes, without quote, backslash or "
            "control character"
        )
    return encoded
