# SPDX-License-Identifier: MIT
"""The C callbacks of a domain written in Python."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import shown, whole
from ..errors import DomainError

if TYPE_CHECKING:
    from .domain import Domain

_METHODS = ("exhibits", "candidates", "name", "feature")
_OPTIONAL = ("detect", "oracle", "check_percept", "check_feature")


class Guard:
    """What C knows of a domain's methods: whether one is running, and the exception that one raised.

    Attributes
    ----------
    methods : rlvc_shim_python
    """

    def __init__(self) -> None:
        self.methods = _native.ShimPython()

    @property
    def inside(self) -> bool:
        """Whether a method is running."""
        return int(self.methods.depth) > 0

    def forget(self) -> None:
        """Drop what a method raised, if the call that it was raised in went on without it."""
        _native.call.rlvc_shim_python_forget(ctypes.byref(self.methods))

    def reraise(self) -> None:
        """Raise what a method raised, if one did since the last time."""
        _native.call.rlvc_shim_python_raise(ctypes.byref(self.methods))


class Callbacks:
    """The methods of a domain in Python, as ``native/python.c`` calls them.

    They get addresses and return a number. What they raise comes out of the agent's call, and so
    does Ctrl-C at any moment.
    """

    def __init__(self, domain: Domain, guard: Guard) -> None:
        if "feature_bytes" not in domain.__dict__:
            raise DomainError(f"{type(domain).__name__}: its __init__() must call that of rlvc.Domain")
        for name in _METHODS:
            if not callable(getattr(domain, name)):
                raise DomainError(f"{name}: {shown(getattr(domain, name))} is not a method")
        self.domain = domain
        self.guard = guard
        self.percept_dtype, self.percept_shape = domain.percept_dtype, domain.percept_shape
        self.percept_bytes, self.feature_bytes = domain.percept_bytes, domain.feature_bytes
        self.feature_dtype = domain.feature_dtype
        self.listed: tuple[bytes, bytes] | None = None  # samples, and the candidates for them

    def native(self) -> _native.Domain:
        """Make the C struct, which keeps its callbacks alive."""
        domain, methods = self.domain, self.guard.methods
        native = _native.Domain()
        native.percept_bytes = self.percept_bytes
        native.feature_bytes = self.feature_bytes
        native.features_max = whole("features_max", domain.features_max, 0, 2**32 - 1)
        called = [self.exhibits, self.candidates, self.name]
        methods.exhibits, methods.candidates, methods.name = map(id, called)
        for name in _OPTIONAL:
            method = getattr(domain, name)
            if method is not None and not callable(method):
                raise DomainError(f"{name}: {shown(method)} is not a method")
            if method is not None:
                called.append(getattr(self, name))
                setattr(methods, name, id(called[-1]))
        _native.call.rlvc_shim_python_domain(ctypes.byref(methods), ctypes.byref(native))
        native._keeps = (methods, called)
        return native

    def percepts(self, records: bytes, count: int) -> npt.NDArray[Any]:
        """Return records as an array of percepts."""
        flat = np.frombuffer(records, self.percept_dtype)
        return flat.reshape(count, *self.percept_shape)

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

    def feature(self, address: int) -> Any:
        """Return the feature at an address."""
        return self.domain.feature(ctypes.string_at(address, self.feature_bytes))

    def exhibits(self, percept: int, feature: int) -> int:
        """``rlvc_domain.exhibits``."""
        one = self.percepts(ctypes.string_at(percept, self.percept_bytes), 1)[0]
        answer = self.domain.exhibits(one, self.feature(feature))
        if not isinstance(answer, bool | np.bool_):
            raise DomainError(f"exhibits() returned {shown(answer)}, expected a bool")
        return int(answer)

    def check_percept(self, percept: int) -> int:
        """``rlvc_domain.check_percept``: 1 if it is sound."""
        one = self.percepts(ctypes.string_at(percept, self.percept_bytes), 1)[0]
        return self.sound("check_percept", one)

    def check_feature(self, feature: int) -> int:
        """``rlvc_domain.check_feature``: 1 if it is sound."""
        return self.sound("check_feature", self.feature(feature))

    def sound(self, method: str, record: Any) -> int:
        """Ask a check of the domain."""
        answer = getattr(self.domain, method)(record)
        if not isinstance(answer, bool | np.bool_):
            raise DomainError(f"{method}() returned {shown(answer)}, expected a bool")
        return int(answer)

    def name(self, feature: int, text: int, room: int) -> int:
        """``rlvc_domain.name``."""
        encoded = checked_name(self.domain.name(self.feature(feature)), room)
        ctypes.memmove(text, encoded + b"\0", len(encoded) + 1)
        return 0

    def candidates(self, address: int, first: int, room: int, features: int) -> int:
        """``rlvc_domain.candidates``: lists the features once, and copies a part of them."""
        samples = _native.Samples.from_address(address)
        key = ctypes.string_at(samples.sample, samples.count * ctypes.sizeof(_native.Sample))
        if first == 0 or self.listed is None or self.listed[0] != key:
            found = self.domain.candidates(self.gather(samples, 0, samples.count))
            self.listed = (key, self.records(found))
        size = self.feature_bytes
        part = self.listed[1][first * size : (first + room) * size]
        ctypes.memmove(features, part, len(part))
        return len(part) // size

    def records(self, features: Any) -> bytes:
        """Give the records of an array of features."""
        wanted = self.feature_dtype
        if not isinstance(features, np.ndarray) or features.ndim != 1 or features.dtype != wanted:
            array = isinstance(features, np.ndarray)
            kind = f"{features.dtype}{list(features.shape)}" if array else shown(features)
            raise DomainError(f"candidates() returned {kind}, expected {wanted}[n]")
        return features.tobytes()

    def detect(self, address: int, first: int, n: int, features: int, m: int, columns: int) -> int:
        """``rlvc_domain.detect``."""
        domain = self.domain
        assert domain.detect is not None
        offered = np.frombuffer(
            ctypes.string_at(features, m * self.feature_bytes), self.feature_dtype
        )
        samples = _native.Samples.from_address(address)
        answer = domain.detect(self.gather(samples, first, n), offered)
        if not isinstance(answer, np.ndarray) or answer.dtype != np.bool_ or answer.shape != (n, m):
            raise DomainError(f"detect() returned {shown(answer)}, expected bool[{n}, {m}]")
        words = np.zeros((m, _native.DETECT_SAMPLES // 8), np.uint8)
        packed = np.packbits(answer.T, axis=1, bitorder="little")
        words[:, : packed.shape[1]] = packed
        native = words.view("<u8").astype(np.uint64)
        ctypes.memmove(columns, native.ctypes.data, native.nbytes)
        return 0

    def oracle(self, address: int, below: int, feature: int) -> int:
        """``rlvc_domain.oracle``."""
        domain = self.domain
        assert domain.oracle is not None
        samples = _native.Samples.from_address(address)
        answer = domain.oracle(self.gather(samples, 0, samples.count), below)
        if answer is None:
            return 0
        try:
            proposed, among = answer
            count = int(among.__index__())
            record = np.array([proposed]).astype(self.feature_dtype, casting="same_kind").tobytes()
        except Exception as error:  # also of a class of the caller
            raise DomainError(
                f"oracle() returned {shown(answer)}, expected (feature, considered) or None"
            ) from error
        if len(record) != self.feature_bytes or not 1 <= count < 2**32:
            raise DomainError(f"oracle() returned {shown(answer)}: considered must be in [1, 2**32)")
        ctypes.memmove(feature, record, len(record))
        return count


def checked_name(name: object, room: int = _native.NAME_BYTES) -> bytes:
    """Encode the name of a feature.

    Raises
    ------
    DomainError
        It is not a str, is too long, or has a character that JSON or DOT would have to escape.
    """
    if not isinstance(name, str):
        raise DomainError(f"name() returned {shown(name)}, expected a str")
    encoded = name.encode(errors="replace")
    if len(encoded) >= room or any(ord(sign) < 32 or sign in '"\\\x7f' for sign in name):
        raise DomainError(
            f"name() returned {shown(name)}: at most {room - 1} bytes are allowed, and no quote, "
            "backslash or control character"
        )
    return encoded
