# SPDX-License-Identifier: MIT
"""Pictures as percepts (sections 3 and 6.2): colour Harris points with local descriptors.

Needs the vision module, which is in the package if OpenCV was there when it was installed. A picture is
an array of uint8: [height, width] of grey, or [height, width, 3] of colour, red first unless ``order``
says ``"bgr"``; in any layout, from 1 x 1 to 32767 x 32767 pixels. Source:
``vision/include/rlvc/vision.h``.
"""

from __future__ import annotations

import ctypes
import dataclasses
import os
import threading
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _lib
from .domain import Descriptors
from .errors import (
    BlockError,
    ConfigError,
    Error,
    MetricError,
    PictureError,
    RangeError,
    StoreError,
)

_library = _lib.load_seeing("rlvc-vision", _lib.VISION)

Order = Literal["rgb", "bgr"]
Picture: TypeAlias = "npt.NDArray[np.uint8]"

DESCRIPTORS = ("invariants", "sqrt-invariants", "sift-upright", "sift", "orb")
"""What can stand in a point's vector."""

METRICS = ("plain", "covariance", "change", "discriminant")
"""How a metric can be fitted."""

_FORMS = ("float", "int8")
_PAIRS = ("copies", "views")
_FORMATS = {"rgb": 2, "bgr": 1}
_SIDE_MAX = 32767

_ERRORS: dict[int, type[Error]] = {
    -102: ConfigError,
    -103: PictureError,
    -105: RangeError,
    -106: MetricError,
    -107: StoreError,
    -108: MetricError,
    -109: MetricError,
    -110: MetricError,
    -111: BlockError,
}


def _call(name: str, *arguments: Any) -> None:
    """Call a function whose last argument is an ``rlvc_vision_error``."""
    error = _lib.VisionError()
    try:
        status = getattr(_library, name)(*arguments, ctypes.byref(error))
    except ctypes.ArgumentError as wrong:
        raise RangeError(f"{name}: {wrong}") from None
    if status != 0:
        text = error.text.decode(errors="replace") or _library.rlvc_vision_status_text(
            status
        ).decode(errors="replace")
        raise _ERRORS.get(status, Error)(text)


def _native_picture(picture: Any, order: Order) -> _lib.Picture:
    """Make the C struct of a picture, which keeps its pixels alive."""
    if order not in _FORMATS:
        raise PictureError(f"order: {order!r} is none of rgb, bgr")
    if not isinstance(picture, np.ndarray):
        raise PictureError(f"a picture is an array, not {type(picture).__name__}")
    if picture.dtype != np.uint8:
        raise PictureError(f"a picture of {picture.dtype}, not uint8")
    grey = picture.ndim == 2
    if not grey and (picture.ndim != 3 or picture.shape[2] != 3):
        raise PictureError(f"a picture of {list(picture.shape)}, not [height, width] or [..., 3]")
    if not 1 <= min(picture.shape[:2]) <= max(picture.shape[:2]) <= _SIDE_MAX:
        raise PictureError(
            f"a picture of {picture.shape[1]} x {picture.shape[0]} pixels: a side is 1 to {_SIDE_MAX}"
        )
    pixel = (1,) if grey else (3, 1)
    if picture.strides[1:] != pixel or abs(picture.strides[0]) < picture.shape[1] * pixel[0]:
        picture = np.ascontiguousarray(picture)
    height, width = picture.shape[:2]
    form = 0 if grey else _FORMATS[order]
    native = _lib.Picture(picture.ctypes.data, picture.strides[0], width, height, form)
    native._keeps = picture
    return native


@dataclasses.dataclass(frozen=True)
class VisionConfig:
    """How pictures are looked at.

    Attributes
    ----------
    descriptor : {"sift-upright", "sift", "orb", "invariants", "sqrt-invariants"}
        What stands in a point's vector: SIFT, its window not turned, or turned to the point's own
        direction; ORB; the published colour differential invariants of first order, or those with the
        signed square root of their terms of second degree.
    points : int
        P, the most points of a picture, [1, 1000]; the strongest are kept.
    radius : int
        In pixels: a point's response exceeds all others in the square of side 2 radius + 1, [1, 31].
    form : {"float", "int8"}
        How a number of a vector stands in the percept.
    normalise : bool
        Whether each channel of a picture is first brought to mean 128 and standard deviation 64.
    axes : int
        Numbers of a vector in the percept: the first so many axes of a ``discriminant`` metric, at
        most 255; 0: all numbers.
    sd, si : float
        In pixels: scale of the derivatives of the Harris response, [0.5, 4], and that over which it
        integrates, [0.5, 8].
    k : float
        H = det M - k (trace M)^2, [0, 0.25).
    threshold : float
        A point's response exceeds this share of the picture's largest, [0, 1).
    sigma : float or None
        In pixels: scale of the vectors, [0.5, 8], for SIFT [1, 8]. None: 2.5, SIFT 6, ORB 5.

    Raises
    ------
    ConfigError
        A field is out of range; the text names it.
    """

    descriptor: str = "sift-upright"
    points: int = 30
    radius: int = 3
    form: str = "float"
    normalise: bool = False
    axes: int = 0
    sd: float = 1.0
    si: float = 2.0
    k: float = 0.04
    threshold: float = 0.001
    sigma: float | None = None

    def __post_init__(self) -> None:
        native = self.native()
        _call("rlvc_vision_config_check", ctypes.byref(native))
        if self.sigma is None:
            object.__setattr__(self, "sigma", float(native.sigma))

    def native(self) -> _lib.VisionConfig:
        """Make the C struct."""
        for name, values in (("descriptor", DESCRIPTORS), ("form", _FORMS)):
            if getattr(self, name) not in values:
                raise ConfigError(f"{name}: {getattr(self, name)!r} is none of {', '.join(values)}")
        native = _lib.VisionConfig()
        _library.rlvc_vision_config_default(
            DESCRIPTORS.index(self.descriptor), ctypes.byref(native)
        )
        native.form = _FORMS.index(self.form)
        for name in ("points", "radius", "normalise", "axes", "sd", "si", "k", "threshold", "sigma"):
            value = getattr(self, name)
            whole = {"points": 2**32, "radius": 2**32, "axes": 2**8}.get(name)
            if name == "sigma" and value is None:
                continue
            if whole and (not isinstance(value, int) or not 0 <= value < whole):
                raise ConfigError(f"{name}: {value!r} is no whole number in range")
            try:
                setattr(native, name, value)
            except TypeError:
                raise ConfigError(f"{name}: {value!r} is no number") from None
        return native

    @classmethod
    def of(cls, native: _lib.VisionConfig) -> VisionConfig:
        """Give the config that a C struct says."""
        fields = {field.name: getattr(native, field.name) for field in dataclasses.fields(cls)}
        for name in ("sd", "si", "k", "threshold", "sigma"):
            fields[name] = float(str(np.float32(fields[name])))  # 0.04, and not 0.03999999910593033
        fields["descriptor"] = DESCRIPTORS[native.descriptor]
        fields["form"] = _FORMS[native.form]
        fields["normalise"] = bool(native.normalise)
        return cls(**fields)


def _config(config: VisionConfig | str, changes: dict[str, Any]) -> VisionConfig:
    if isinstance(config, str):
        config = VisionConfig(config)
    try:
        return dataclasses.replace(config, **changes)
    except TypeError as error:
        raise ConfigError(f"no such field: {error}") from None


class _Owned:
    """An object of the library's, freed with this one. One thread at a time: the lock sees to that."""

    def __init__(self, make: str, free: str, *arguments: Any) -> None:
        self._lock = threading.Lock()
        made = ctypes.c_void_p()
        reference = ctypes.byref(made)
        _call(make, *arguments, reference)
        self._handle: int | None = made.value
        self._free: Callable[[int | None], None] = getattr(_library, free)

    def __del__(self) -> None:
        if hasattr(self, "_free"):
            self._free(self._handle)


class Metric(_Owned):
    """What is known of the vectors of one descriptor: how to whiten them, and tau.

    Made by :meth:`fit`, :meth:`load` or :meth:`read`. It can be pickled.

    Attributes
    ----------
    tau : float
        Within this distance two vectors count as the same feature.
    kind : str
        How it was fitted: one of :data:`METRICS`.
    config : VisionConfig
        With which it was fitted.
    """

    def __init__(self, make: str, *arguments: Any) -> None:
        super().__init__(make, "rlvc_metric_destroy", *arguments)
        self.tau = float(_library.rlvc_metric_tau(self._handle))
        self.kind = METRICS[_library.rlvc_metric_kind(self._handle)]
        native = _lib.VisionConfig()
        _library.rlvc_metric_config(self._handle, ctypes.byref(native))
        self.config = VisionConfig.of(native)

    @classmethod
    def fit(
        cls,
        pictures: Iterable[Picture],
        objects: Sequence[int] | None = None,
        *,
        pairs: Iterable[tuple[Picture, Picture, str]] = (),
        config: VisionConfig | str = "sift-upright",
        kind: str | None = None,
        share: float = 0.2,
        order: Order = "rgb",
        **changes: Any,
    ) -> Metric:
        """Fit a metric to a task's pictures.

        Parameters
        ----------
        pictures : iterable of ndarray of uint8, [height, width] or [height, width, 3]
        objects : sequence of int or None
            What is to be seen in each. Pictures of one object are not asked whether they exhibit each
            other's features when tau is sought. None: something else in each.
        pairs : iterable of (ndarray, ndarray, {"copies", "views"})
            Two pictures of the same, for the metrics of ``change`` and ``discriminant``: the second is
            the first in other light, noise or the like (of one size), or a neighbouring view.
        config : VisionConfig or str
            A str means the defaults for that descriptor.
        kind : {"plain", "covariance", "change", "discriminant"} or None
            tau alone; Mahalanobis's distance; by what changes within the pairs; or likewise, on the axes
            along which vectors differ most. None: plain for SIFT and ORB, else covariance.
        share : float
            tau is such that of the other objects' pictures this share exhibits a feature, (0, 1).
        order : {"rgb", "bgr"}
        **changes
            Fields of the config to be changed.

        Returns
        -------
        Metric

        Raises
        ------
        ConfigError
            A field of the config is out of range.
        PictureError
            A picture is of the wrong dtype, shape or size.
        MetricError
            There are too few pictures, vectors or pairs.
        RangeError
            ``share``, ``kind`` or ``how`` is out of range, or ``objects`` of another length.
        """
        chosen = _config(config, changes)
        if kind is None:
            kind = "covariance" if "invariants" in chosen.descriptor else "plain"
        if kind not in METRICS:
            raise RangeError(f"kind: {kind!r} is none of {', '.join(METRICS)}")
        native = chosen.native()
        fitter = _Owned("rlvc_fitter_create", "rlvc_fitter_destroy", ctypes.byref(native))
        seen = list(pictures)
        numbers = range(len(seen)) if objects is None else objects
        if len(numbers) != len(seen):
            raise RangeError(f"objects: {len(numbers)} of them for {len(seen)} pictures")
        for picture, number in zip(seen, numbers, strict=True):
            one = _native_picture(picture, order)
            if not 0 <= int(number) < 2**32:
                raise RangeError(f"objects: {number!r} is not in [0, 2**32 - 1]")
            _call("rlvc_fitter_add", fitter._handle, ctypes.byref(one), int(number))
        for before, after, how in pairs:
            if how not in _PAIRS:
                raise RangeError(f"pairs: {how!r} is none of {', '.join(_PAIRS)}")
            two = [_native_picture(picture, order) for picture in (before, after)]
            references = (ctypes.byref(native) for native in two)
            _call("rlvc_fitter_pair", fitter._handle, *references, _PAIRS.index(how))
        return cls("rlvc_fitter_fit", fitter._handle, METRICS.index(kind), share)

    @classmethod
    def load(cls, file: str | Path) -> Metric:
        """Read a metric from a file that :meth:`save`, or ``run_gridworld tiled``, wrote.

        Parameters
        ----------
        file : str or Path

        Returns
        -------
        Metric

        Raises
        ------
        StoreError
            The file cannot be read.
        MetricError
            It is no metric, or is damaged; the text says where.
        """
        return cls("rlvc_metric_load", os.fsencode(file))

    @classmethod
    def read(cls, text: bytes) -> Metric:
        """Read a metric from what :meth:`write` gave.

        Parameters
        ----------
        text : bytes

        Returns
        -------
        Metric

        Raises
        ------
        MetricError
            It is no metric, or is damaged; the text says where.
        """
        return cls("rlvc_metric_read", bytes(text), len(text))

    def save(self, file: str | Path) -> None:
        """Write the metric to a file, which is there as a whole or as it was before.

        Parameters
        ----------
        file : str or Path

        Raises
        ------
        StoreError
            The file cannot be written.
        """
        _call("rlvc_metric_save", self._handle, os.fsencode(file))

    def write(self) -> bytes:
        """Give the metric as JSON.

        Returns
        -------
        bytes
        """
        count = ctypes.c_size_t()
        text = ctypes.create_string_buffer(0)
        while True:
            room = len(text)
            error = ctypes.byref(_lib.VisionError())
            status = _library.rlvc_metric_write(
                self._handle, text, room, ctypes.byref(count), error
            )
            if status == 0:
                return text.raw[: count.value]
            if count.value <= room:
                raise Error(_library.rlvc_vision_status_text(status).decode())
            text = ctypes.create_string_buffer(count.value)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the text."""
        return type(self).read, (self.write(),)


class Sight(NamedTuple):
    """What is seen of a picture.

    Attributes
    ----------
    percept : bytes
        The record that an agent on :meth:`Extractor.domain` takes.
    vectors : ndarray of float32 or int8, [n, dimensions]
        Strongest point first.
    points : ndarray of float32, [n, 3]
        x, y in pixels, and the response, of each.
    """

    percept: bytes
    vectors: npt.NDArray[Any]
    points: npt.NDArray[np.float32]


class Extractor(_Owned):
    """Turns pictures into percepts.

    Parameters
    ----------
    config : VisionConfig, str or None
        A str means the defaults for that descriptor. None: the metric's, or those of SIFT.
    metric : Metric or None
        None: vectors are as the descriptor has them.
    **changes
        Fields of the config to be changed.

    Attributes
    ----------
    config : VisionConfig
    metric : Metric or None
    dimensions : int
        D: numbers of a vector.
    percept_bytes : int
    step : float
        What one step of the percept's numbers is worth: tau / step is tau in their units.

    Raises
    ------
    ConfigError
        A field of the config is out of range.
    MetricError
        The metric belongs to other vectors, or this config needs one.

    Examples
    --------
    >>> pictures = np.random.default_rng(1).integers(256, size=(4, 48, 48, 3), dtype=np.uint8)
    >>> metric = Metric.fit(pictures, form="int8")
    >>> extractor = Extractor(metric=metric, form="int8")
    >>> len(extractor.extract(pictures[0])) == extractor.percept_bytes
    True
    """

    def __init__(
        self,
        config: VisionConfig | str | None = None,
        metric: Metric | None = None,
        **changes: Any,
    ) -> None:
        if config is None:
            config = VisionConfig() if metric is None else metric.config
        self.config = _config(config, changes)
        self.metric = metric
        native = self.config.native()
        super().__init__(
            "rlvc_extractor_create",
            "rlvc_extractor_destroy",
            ctypes.byref(native),
            None if metric is None else metric._handle,
        )
        self.dimensions = int(_library.rlvc_vision_dimensions(ctypes.byref(native)))
        self.percept_bytes = int(_library.rlvc_vision_percept_bytes(ctypes.byref(native)))
        self.step = float(_library.rlvc_extractor_step(self._handle))

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle config and metric."""
        return type(self), (self.config, self.metric)

    def _record(self, picture: Picture, order: Order, points: Any) -> bytes:
        native = _native_picture(picture, order)
        record = np.empty(self.percept_bytes // 4, np.uint32)  # aligned to 4
        place = (record.ctypes.data, self.percept_bytes)
        with self._lock:
            _call("rlvc_extractor_extract", self._handle, ctypes.byref(native), *place, points)
        return record.tobytes()

    def extract(self, picture: Picture, order: Order = "rgb") -> bytes:
        """Give the percept of a picture.

        Parameters
        ----------
        picture : ndarray of uint8, [height, width] or [height, width, 3]
        order : {"rgb", "bgr"}

        Returns
        -------
        bytes
            The record that an agent on :meth:`domain` takes.

        Raises
        ------
        PictureError
            The picture is of the wrong dtype, shape or size.
        """
        return self._record(picture, order, None)

    def extract_many(self, pictures: Iterable[Picture], order: Order = "rgb") -> Picture:
        """Give the percepts of pictures, as an agent's methods for arrays take them.

        Parameters
        ----------
        pictures : iterable of ndarray
        order : {"rgb", "bgr"}

        Returns
        -------
        ndarray of uint8, [n, percept_bytes]

        Raises
        ------
        PictureError
            A picture is of the wrong dtype, shape or size.
        """
        records = b"".join(self.extract(picture, order) for picture in pictures)
        return np.frombuffer(records, np.uint8).reshape(-1, self.percept_bytes)

    def look(self, picture: Picture, order: Order = "rgb") -> Sight:
        """Give the percept of a picture, and where its vectors were found.

        Parameters
        ----------
        picture : ndarray of uint8, [height, width] or [height, width, 3]
        order : {"rgb", "bgr"}

        Returns
        -------
        Sight

        Raises
        ------
        PictureError
            The picture is of the wrong dtype, shape or size.
        """
        points = np.zeros((self.config.points, 3), np.float32)
        record = self._record(picture, order, points.ctypes.data)
        count = int(np.frombuffer(record, np.uint32, 1)[0])
        dtype = np.int8 if self.config.form == "int8" else np.float32
        numbers = np.frombuffer(record, dtype, count * self.dimensions, 4)
        return Sight(record, numbers.reshape(count, self.dimensions), points[:count])

    def domain(self, radius: float | None = None, **parameters: Any) -> Descriptors:
        """Give the domain of these percepts.

        Parameters
        ----------
        radius : float or None
            In units of the percept's numbers. None: the metric's tau.
        **parameters
            ``candidates``, ``draws`` and ``margin`` of :class:`rlvc.Descriptors`.

        Returns
        -------
        Descriptors

        Raises
        ------
        MetricError
            There is neither a radius nor a metric.
        ConfigError
            A parameter is out of range.
        """
        if radius is None:
            if self.metric is None:
                raise MetricError("radius: give one, or make the extractor with a metric")
            radius = self.metric.tau / self.step
        form: Any = self.config.form
        return Descriptors(self.config.points, self.dimensions, radius, form, **parameters)


class Eye:
    """An encoder of pictures for :func:`rlvc.learn`: an extractor, and the domain of its percepts.

    Parameters
    ----------
    extractor : Extractor
    order : {"rgb", "bgr"}
        Of the environment's pictures.
    cache : int
        How many pictures are remembered with their percepts: environments show the same ones again.
    **parameters
        ``radius``, ``candidates``, ``draws`` and ``margin``, as for :meth:`Extractor.domain`.

    Attributes
    ----------
    extractor : Extractor
    domain : Descriptors
    """

    def __init__(
        self, extractor: Extractor, order: Order = "rgb", cache: int = 256, **parameters: Any
    ) -> None:
        self.extractor = extractor
        self.domain = extractor.domain(**parameters)
        self.names: list[str] = []
        self._order = order
        self._cache = cache
        self._known: dict[tuple[Any, bytes], bytes] = {}

    def encode(self, observation: Picture) -> bytes:
        """Give the percept of a picture.

        Parameters
        ----------
        observation : ndarray of uint8, [height, width] or [height, width, 3]

        Returns
        -------
        bytes

        Raises
        ------
        PictureError
            The picture is of the wrong dtype, shape or size.
        """
        if not isinstance(observation, np.ndarray):
            return self.extractor.extract(observation, self._order)  # which says what is wrong
        key = ((observation.shape, observation.dtype), observation.tobytes())
        known = self._known.pop(key, None)
        if known is None:
            known = self.extractor.extract(observation, self._order)
            if len(self._known) >= self._cache > 0:
                del self._known[next(iter(self._known))]  # the longest not seen
        if self._cache > 0:
            self._known[key] = known
        return known

    def look(self, picture: Picture) -> Sight:
        """Give the percept of a picture, and where its vectors were found.

        Parameters
        ----------
        picture : ndarray of uint8, [height, width] or [height, width, 3]

        Returns
        -------
        Sight

        Raises
        ------
        PictureError
            The picture is of the wrong dtype, shape or size.
        """
        return self.extractor.look(picture, self._order)

    def explain(self, text: str) -> str:
        """Leave a tree's text as it is: a feature's name says all there is in words.

        Parameters
        ----------
        text : str

        Returns
        -------
        str
        """
        return text
