# SPDX-License-Identifier: MIT
"""The world as the learner sees it (section 5): percepts, features, detector and refining oracle."""

from __future__ import annotations

import abc
import ctypes
import sys
from collections.abc import Callable
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _lib
from .errors import ConfigError, DomainError, PerceptError

Percept: TypeAlias = "bytes | npt.NDArray[Any]"
Bytes = npt.NDArray[np.uint8]

_UINT8 = np.dtype(np.uint8)
_BOOL = np.dtype(np.bool_)


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


class Domain(abc.ABC):
    """A world of one's own: the kind of percepts and features, and three methods.

    Parameters
    ----------
    percept_dtype : dtype
        Of a percept's elements.
    percept_shape : tuple of int
        Of a percept; () for a single element.
    feature_dtype : dtype
        Of a feature: a number, or a structured type.
    features_max : int
        How many candidates there can be for one class, or 0 if that is not known; it only sizes
        memory.

    Notes
    -----
    A domain must not use the agent that calls it, and must give the same answer for the same
    arguments. An exception that one of its methods raises comes out of the agent's call that led to
    it. Besides the three methods, a domain may have

    - ``detect(percepts, features)``, with percepts [n, *percept_shape] and features [m]: a boolean
      array [n, m], to save calls of ``exhibits``;
    - ``oracle(percepts, below)``, with percepts [n, *percept_shape] by ascending target: the feature
      that best explains the partition into percepts[:below] and percepts[below:], and among how many
      it chose; or None. It replaces the search over ``candidates``.

    Source: ``core/include/rlvc/domain.h``.
    """

    detect: Callable[[Any, Any], Any] | None = None
    oracle: Callable[[Any, int], Any] | None = None

    def __init__(
        self,
        percept_dtype: npt.DTypeLike,
        percept_shape: tuple[int, ...] = (),
        feature_dtype: npt.DTypeLike = np.int32,
        features_max: int = 0,
    ) -> None:
        self.percept_dtype = np.dtype(percept_dtype)
        self.percept_shape = tuple(percept_shape)
        self.feature_dtype = np.dtype(feature_dtype)
        self.features_max = features_max
        if self.percept_dtype.hasobject or self.feature_dtype.hasobject:
            raise ConfigError(
                "a percept and a feature are values: no Python objects in their dtype"
            )
        self.percept_bytes = self.percept_dtype.itemsize * int(
            np.prod(self.percept_shape, dtype=int)
        )
        self.feature_bytes = self.feature_dtype.itemsize
        if not 1 <= self.percept_bytes <= 2**20:
            raise ConfigError(f"a percept has {self.percept_bytes} bytes, not 1 to 2^20")
        if not 1 <= self.feature_bytes <= 2**16:
            raise ConfigError(f"a feature has {self.feature_bytes} bytes, not 1 to 2^16")

    @abc.abstractmethod
    def exhibits(self, percept: npt.NDArray[Any], feature: Any) -> bool:
        """Whether a percept exhibits a feature.

        Parameters
        ----------
        percept : ndarray, percept_shape
            Read-only.
        feature : scalar of feature_dtype

        Returns
        -------
        bool
        """

    @abc.abstractmethod
    def candidates(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """List the features among which a class's split is searched (section 4.2.3).

        Parameters
        ----------
        percepts : ndarray, [n, *percept_shape]
            Those of the class and an action, by ascending target.

        Returns
        -------
        ndarray, [features], of feature_dtype
            The earlier of two that score alike wins.
        """

    @abc.abstractmethod
    def name(self, feature: Any) -> str:
        """Name a feature, in at most 63 bytes without quote, backslash or control character.

        Parameters
        ----------
        feature : scalar of feature_dtype

        Returns
        -------
        str
        """

    def pack(self, percept: Percept) -> bytes:
        """Give the record of a percept.

        Parameters
        ----------
        percept : bytes of percept_bytes, or ndarray of percept_dtype and percept_shape

        Returns
        -------
        bytes

        Raises
        ------
        PerceptError
            It is of another size, dtype or shape.
        """
        if isinstance(percept, bytes):
            if len(percept) != self.percept_bytes:
                raise PerceptError(f"a percept of {len(percept)} bytes, not {self.percept_bytes}")
            return percept
        if not isinstance(percept, np.ndarray | np.generic):
            raise PerceptError(f"a percept is bytes or an array, not {type(percept).__name__}")
        if percept.dtype != self.percept_dtype or percept.shape != self.percept_shape:
            raise PerceptError(
                f"a percept of {percept.dtype}{list(percept.shape)}, not "
                f"{self.percept_dtype}{list(self.percept_shape)}"
            )
        return percept.tobytes()

    def pack_many(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Check an array of percepts.

        Parameters
        ----------
        percepts : ndarray, [n, *percept_shape], of percept_dtype, C-contiguous

        Returns
        -------
        ndarray
            Itself, or another one whose memory holds the n records.

        Raises
        ------
        PerceptError
            It is of another dtype or shape, or not C-contiguous.
        """
        if not isinstance(percepts, np.ndarray):
            raise PerceptError(f"percepts are an array, not {type(percepts).__name__}")
        if percepts.dtype != self.percept_dtype or percepts.shape[1:] != self.percept_shape:
            raise PerceptError(
                f"percepts of {percepts.dtype}{list(percepts.shape)}, not "
                f"{self.percept_dtype}{['n', *self.percept_shape]}"
            )
        if not percepts.flags.c_contiguous:
            raise PerceptError(
                "percepts are not C-contiguous: numpy.ascontiguousarray makes them so"
            )
        return percepts

    def is_one(self, percept: Any) -> bool:
        """Whether this is one percept rather than an array of them."""
        return isinstance(percept, bytes) or np.ndim(percept) == len(self.percept_shape)

    def feature(self, record: bytes) -> Any:
        """Give the feature whose record this is."""
        return np.frombuffer(record, self.feature_dtype)[0]

    def native(self, guard: Guard) -> _lib.Domain:
        """Make the C struct, which keeps its callbacks alive.

        Parameters
        ----------
        guard : Guard
            Gets what the callbacks raise.

        Returns
        -------
        rlvc_domain
        """
        if not isinstance(self.features_max, int) or not 0 <= self.features_max < 2**32:
            raise ConfigError(f"features_max: {self.features_max!r} is out of range")
        return _Callbacks(self, guard).native()


class Bits(Domain):
    """Percepts that are strings of bits; a feature is the number of a bit (section 6.1).

    Parameters
    ----------
    bits : int
        How many, [1, 1024].

    Raises
    ------
    ConfigError
        ``bits`` is out of range.

    Notes
    -----
    A percept is given packed, as bytes or uint8 [ceil(bits / 8)] with bit i in bit i % 8 (0 the lowest)
    of byte i // 8, or as bool [bits]. Source: ``core/include/rlvc/bits.h``.
    """

    def __init__(self, bits: int) -> None:
        if not 1 <= bits <= _lib.BITS_MAX:
            raise ConfigError(f"bits: {bits} is not in [1, {_lib.BITS_MAX}]")
        super().__init__(np.uint8, ((bits + 7) // 8,), np.uint16, bits)
        self.bits = bits

    def exhibits(self, percept: npt.NDArray[Any], feature: Any) -> bool:
        """Whether the bit of that number is 1."""
        return bool(percept[int(feature) // 8] >> (int(feature) % 8) & 1)

    def candidates(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Every bit, in order."""
        return np.arange(self.bits, dtype=np.uint16)

    def name(self, feature: Any) -> str:
        """``bit`` and the number."""
        return f"bit {int(feature)}"

    def pack(self, percept: Percept) -> bytes:
        """Like :meth:`Domain.pack`; also packs bool [bits]."""
        if type(percept) is np.ndarray:
            if percept.dtype is _UINT8 and percept.shape == self.percept_shape:
                return percept.tobytes()
            if percept.dtype is _BOOL and percept.shape == (self.bits,):
                return np.packbits(percept, bitorder="little").tobytes()
        return super().pack(percept)

    def pack_many(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Like :meth:`Domain.pack_many`; also packs bool [n, bits]."""
        if isinstance(percepts, np.ndarray) and percepts.dtype == _BOOL:
            if percepts.ndim != 2 or percepts.shape[1] != self.bits:
                raise PerceptError(
                    f"percepts of bool{list(percepts.shape)}, not ['n', {self.bits}]"
                )
            return np.packbits(percepts, axis=1, bitorder="little")
        return super().pack_many(percepts)

    def native(self, guard: Guard) -> _lib.Domain:
        """The library's own domain, which calls no Python."""
        native = _lib.Domain()
        _lib.call.rlvc_bits_domain(self.bits, ctypes.byref(native))
        return native


class _Ready(Domain):
    """A ready-made domain whose callbacks are the library's, with parameters of its own."""

    parameters: tuple[Any, ...]
    _native: _lib.Domain

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the parameters."""
        return type(self), self.parameters

    def exhibits(self, percept: npt.NDArray[Any], feature: Any) -> bool:
        """Whether a percept exhibits a feature, as the library says."""
        present = ctypes.c_uint8()
        record = np.ascontiguousarray(feature).tobytes()
        if self._native.exhibits(self._native.ctx, self.pack(percept), record, present):
            raise PerceptError("a percept that is none of the domain")
        return bool(present.value)

    def candidates(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """List the features that the library looks at first for such a class."""
        records = self.pack_many(percepts)
        pairs = np.zeros((len(records), 2), np.uint32)
        pairs[:, 1] = np.arange(len(records))
        samples = _lib.Samples(
            records.ctypes.data, pairs.ctypes.data, self.percept_bytes, len(records)
        )
        found = np.zeros(_lib.DETECT_FEATURES, self.feature_dtype)
        written = ctypes.c_uint32()
        if self._native.candidates(
            self._native.ctx, samples, 0, len(found), found.ctypes.data, written
        ):
            raise PerceptError("a percept that is none of the domain")
        return found[: written.value]

    def name(self, feature: Any) -> str:
        """Name a feature as the library does."""
        text = ctypes.create_string_buffer(_lib.NAME_BYTES)
        record = np.ascontiguousarray(feature).tobytes()
        address = ctypes.cast(text, ctypes.c_void_p)
        self._native.name(self._native.ctx, record, address, _lib.NAME_BYTES)
        return text.value.decode()


class Descriptors(_Ready):
    """Percepts that are the vectors found at a picture's interest points (sections 3 and 6.2).

    A feature is a vector with a radius; a percept exhibits it if the nearest of its vectors is at most
    the radius away.

    Parameters
    ----------
    points : int
        The most vectors of a percept, [1, 1000].
    dimensions : int
        Numbers of a vector, [1, 256].
    radius : float
        tau, in units of the percept's numbers, (0, 1e15].
    form : {"float", "int8"}
        How the numbers are kept: as float32 or as int8.
    candidates : int
        The most features looked at for one class, [1, 65535].
    draws : int
        A candidate is the best of so many vectors by the margin rule, [1, 64].
    margin : float
        m, [1, 16]: each feature has a radius of its own in [tau / m, m tau]; 1: all have tau.

    Raises
    ------
    ConfigError
        A parameter is out of range.

    Notes
    -----
    A percept is given as an array of float32 or int8 [n, dimensions], n at most ``points``, or as its
    record, which :meth:`pack` makes; arrays of percepts are arrays of records, uint8
    [n, percept_bytes]. Source: ``core/include/rlvc/descriptors.h``.
    """

    def __init__(
        self,
        points: int,
        dimensions: int,
        radius: float,
        form: Literal["float", "int8"] = "float",
        candidates: int = 64,
        draws: int = 8,
        margin: float = 1.8,
    ) -> None:
        self.parameters = (points, dimensions, radius, form, candidates, draws, margin)
        if form not in ("float", "int8"):
            raise ConfigError(f"form: {form!r} is none of float, int8")
        self._made = _lib.Descriptors(
            points, dimensions, candidates, draws, radius, margin, int(form == "int8")
        )
        self._native = _lib.Domain()
        status = _lib.call.rlvc_descriptors_domain(
            ctypes.byref(self._made), ctypes.byref(self._native)
        )
        if status != _lib.OK:
            raise ConfigError(f"descriptors: {_lib.status_text(status)}")
        self.vector_dtype = np.dtype(np.int8 if form == "int8" else np.float32)
        self.points, self.dimensions = points, dimensions
        vector = (self.vector_dtype, (dimensions,))
        padding = self._native.feature_bytes - 4 - self.vector_dtype.itemsize * dimensions
        feature = [("radius", np.float32), ("vector", *vector), ("padding", np.uint8, (padding,))]
        super().__init__(
            np.uint8, (self._native.percept_bytes,), feature, self._native.features_max
        )

    def pack(self, percept: Percept) -> bytes:
        """Give the record of a percept: also from an array [n, dimensions] of its vectors."""
        if isinstance(percept, np.ndarray) and percept.ndim == 2:
            if percept.dtype != self.vector_dtype or percept.shape[1] != self.dimensions:
                raise PerceptError(
                    f"a percept of {percept.dtype}{list(percept.shape)}, not "
                    f"{self.vector_dtype}['n', {self.dimensions}]"
                )
            if len(percept) > self.points:
                raise PerceptError(
                    f"a percept of {len(percept)} vectors, not {self.points} at most"
                )
            if not np.isfinite(percept).all():
                raise PerceptError("a percept has a number in it that is not finite")
            record = len(percept).to_bytes(4, sys.byteorder) + percept.tobytes()
            return record.ljust(self.percept_bytes, b"\0")
        record = super().pack(percept)
        if int.from_bytes(record[:4], sys.byteorder) > self.points:
            raise PerceptError(f"a percept of more than {self.points} vectors")
        return record

    def pack_many(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Like :meth:`Domain.pack_many`, of records; their counts are looked at."""
        packed = super().pack_many(percepts)
        if (packed[:, :4].copy().view(np.uint32) > self.points).any():
            raise PerceptError(f"a percept of more than {self.points} vectors")
        return packed

    def is_one(self, percept: Any) -> bool:
        """Whether this is one percept: vectors or a record, and not an array of records."""
        return isinstance(percept, bytes) or not (
            np.ndim(percept) == 2 and getattr(percept, "dtype", None) == _UINT8
        )

    def native(self, guard: Guard) -> _lib.Domain:
        """The library's own domain, which calls no Python."""
        native = _lib.Domain()
        _lib.call.rlvc_descriptors_domain(ctypes.byref(self._made), ctypes.byref(native))
        native._keeps = self._made
        return native


class Thresholds(_Ready):
    """Percepts that are vectors of real numbers; a feature asks whether one lies above a cutpoint.

    Parameters
    ----------
    components : int
        Numbers of a percept, [1, 1024].
    cutpoints : int
        At most so many for each component, at quantiles of the class's own values, [1, 65535]; 0: every
        midpoint between neighbouring values, for small classes.
    oblique : bool
        Whether features may also weigh two components against each other, x[i] + w x[j] > c; of at most
        64 components.

    Raises
    ------
    ConfigError
        A parameter is out of range.

    Notes
    -----
    A percept is given as float32 [components], each number finite and at most 1e15 in absolute value:
    anything else, such as a NaN, is refused here, before the library sees it. A feature has the fields
    ``cutpoint``, ``slope``, ``component`` and ``other``. Source: ``core/include/rlvc/thresholds.h``.
    """

    def __init__(self, components: int, cutpoints: int = 15, oblique: bool = False) -> None:
        self.parameters = (components, cutpoints, oblique)
        self._made = _lib.Thresholds(components, cutpoints, oblique)
        self._native = _lib.Domain()
        status = _lib.call.rlvc_thresholds_domain(
            ctypes.byref(self._made), ctypes.byref(self._native)
        )
        if status != _lib.OK:
            raise ConfigError(f"thresholds: {_lib.status_text(status)}")
        self.components = components
        super().__init__(
            np.float32, (components,), np.dtype(_lib.Threshold), self._native.features_max
        )

    def pack(self, percept: Percept) -> bytes:
        """Like :meth:`Domain.pack`; the numbers are looked at."""
        record = super().pack(percept)
        self._look_at(np.frombuffer(record, np.float32))
        return record

    def pack_many(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Like :meth:`Domain.pack_many`; the numbers are looked at."""
        packed = super().pack_many(percepts)
        self._look_at(packed)
        return packed

    @staticmethod
    def _look_at(numbers: npt.NDArray[Any]) -> None:
        if not (np.abs(numbers) <= _lib.NUMBER_MAX).all():  # neither is a NaN
            raise PerceptError("a percept has a number in it that is a NaN, or beyond 1e15")

    def native(self, guard: Guard) -> _lib.Domain:
        """The library's own domain, which calls no Python."""
        native = _lib.Domain()
        _lib.call.rlvc_thresholds_domain(ctypes.byref(self._made), ctypes.byref(native))
        native._keeps = self._made
        return native


class _Callbacks:
    """The C callbacks of a domain in Python. Each returns 0, or 1 after it has kept an exception."""

    def __init__(self, domain: Domain, guard: Guard) -> None:
        self.domain = domain
        self.guard = guard
        self.listed: tuple[bytes, bytes] | None = None  # samples, and the candidates for them

    def native(self) -> _lib.Domain:
        domain = self.domain
        native = _lib.Domain()
        native.percept_bytes = domain.percept_bytes
        native.feature_bytes = domain.feature_bytes
        native.features_max = domain.features_max
        native.exhibits = _lib.EXHIBITS(self.guarded(self.exhibits))
        native.name = _lib.NAME(self.guarded(self.name))
        native.candidates = _lib.CANDIDATES(self.guarded(self.candidates))
        if domain.detect is not None:
            native.detect = _lib.DETECT(self.guarded(self.detect))
        if domain.oracle is not None:
            native.oracle = _lib.ORACLE(self.guarded(self.oracle))
        return native

    def guarded(self, callback: Callable[..., None]) -> Callable[..., int]:
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
        flat = np.frombuffer(records, self.domain.percept_dtype)
        return flat.reshape(count, *self.domain.percept_shape)

    def gather(self, samples: _lib.Samples, first: int, count: int) -> npt.NDArray[Any]:
        """Copy the percepts of some samples: [count, *percept_shape]."""
        size = ctypes.sizeof(_lib.Sample)
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
        domain = self.domain
        one = self.percepts(ctypes.string_at(percept, domain.percept_bytes), 1)[0]
        answer = domain.exhibits(
            one, domain.feature(ctypes.string_at(feature, domain.feature_bytes))
        )
        if not isinstance(answer, bool | np.bool_):
            raise DomainError(f"exhibits() returned {answer!r}, not a bool")
        present[0] = bool(answer)

    def name(self, feature: int, text: int, room: int) -> None:
        record = ctypes.string_at(feature, self.domain.feature_bytes)
        encoded = checked_name(self.domain.name(self.domain.feature(record)), room)
        ctypes.memmove(text, encoded + b"\0", len(encoded) + 1)

    def candidates(
        self, reference: Any, first: int, room: int, features: int, written: Any
    ) -> None:
        samples = reference[0]
        key = ctypes.string_at(samples.sample, samples.count * ctypes.sizeof(_lib.Sample))
        if first == 0 or self.listed is None or self.listed[0] != key:
            found = self.domain.candidates(self.gather(samples, 0, samples.count))
            self.listed = (key, self.records(found))
        size = self.domain.feature_bytes
        part = self.listed[1][first * size : (first + room) * size]
        ctypes.memmove(features, part, len(part))
        written[0] = len(part) // size

    def records(self, features: Any) -> bytes:
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
        domain = self.domain
        assert domain.detect is not None
        offered = np.frombuffer(
            ctypes.string_at(features, m * domain.feature_bytes), domain.feature_dtype
        )
        answer = domain.detect(self.gather(reference[0], first, n), offered)
        if not isinstance(answer, np.ndarray) or answer.dtype != _BOOL or answer.shape != (n, m):
            raise DomainError(f"detect() returned {answer!r:.80}, not an array bool[{n}, {m}]")
        words = np.zeros((m, _lib.DETECT_SAMPLES // 8), np.uint8)
        packed = np.packbits(answer.T, axis=1, bitorder="little")
        words[:, : packed.shape[1]] = packed
        for j, word in enumerate(words.view("<u8")[:, 0]):
            columns[j] = int(word)

    def oracle(self, reference: Any, below: int, feature: int, considered: Any) -> None:
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


def checked_name(name: object, room: int = _lib.NAME_BYTES) -> bytes:
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
