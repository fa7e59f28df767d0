# SPDX-License-Identifier: MIT
"""Metrics on local descriptors: whitening, and the radius tau."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from .. import _native, files
from ..checks import one_of, real, whole
from ..errors import (
    Error,
    MetricError,
    RangeError,
    StoreError,
)
from .config import VisionConfig, config_of
from .library import Order, Owned, Picture, call, library, native_picture

METRICS = ("plain", "covariance", "change", "discriminant")
"""The kinds of metrics."""
_PAIRS = ("copies", "views")


class Metric(Owned):
    """A metric on the vectors of one descriptor: a linear map, and the radius tau.

    :meth:`fit`, :meth:`load` and :meth:`read` make one. It can be pickled.

    Attributes
    ----------
    tau : float
        Two vectors within this distance count as the same feature.
    kind : str
        One of :data:`METRICS`.
    config : VisionConfig
        The config that it was fitted with.
    """

    def __init__(self, make: str, *arguments: Any) -> None:
        super().__init__(make, "rlvc_metric_destroy", *arguments)
        self.tau = float(library.rlvc_metric_tau(self._handle))
        self.kind = METRICS[library.rlvc_metric_kind(self._handle)]
        native = _native.VisionConfig()
        library.rlvc_metric_config(self._handle, ctypes.byref(native))
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
            The object in each picture. To choose tau, a feature is only compared with pictures of
            other objects. None: each picture has another object.
        pairs : iterable of (ndarray, ndarray, {"copies", "views"})
            Pairs of pictures of the same object, for the kinds ``change`` and ``discriminant``.
            copies: the second is the first with other light, noise or the like, of the same size.
            views: a neighbouring view.
        config : VisionConfig or str
            A str names a descriptor with its defaults.
        kind : {"plain", "covariance", "change", "discriminant"} or None
            plain: Euclidean distance. covariance: Mahalanobis distance. change: weighted by the
            changes within the pairs. discriminant: likewise, on the axes that separate vectors
            best. None: plain for SIFT and ORB, else covariance.
        share : float
            tau is chosen so that this fraction of the other objects' pictures exhibits a feature,
            (0, 1).
        order : {"rgb", "bgr"}
        **changes
            Fields of the config to change.

        Returns
        -------
        Metric

        Raises
        ------
        ConfigError
            A field of the config is out of range.
        PictureError
            A picture has the wrong dtype, shape or size.
        MetricError
            There are too few pictures, vectors or pairs.
        RangeError
            ``share``, ``kind`` or a pair is out of range, or ``objects`` has another length.
        """
        chosen = config_of(config, changes)
        if kind is None:
            kind = "covariance" if "invariants" in chosen.descriptor else "plain"
        one_of("kind", kind, METRICS, RangeError)
        native = chosen.native()
        fitter = Owned("rlvc_fitter_create", "rlvc_fitter_destroy", ctypes.byref(native))
        seen = list(pictures)
        numbers = range(len(seen)) if objects is None else objects
        if len(numbers) != len(seen):
            raise RangeError(f"objects: {len(numbers)} for {len(seen)} pictures")
        for picture, number in zip(seen, numbers, strict=True):
            one = native_picture(picture, order)
            number = whole("objects", number, 0, 2**32 - 1, RangeError)
            call("rlvc_fitter_add", fitter._handle, ctypes.byref(one), number)
        for before, after, how in pairs:
            one_of("pairs", how, _PAIRS, RangeError)
            two = [native_picture(picture, order) for picture in (before, after)]
            references = (ctypes.byref(native) for native in two)
            call("rlvc_fitter_pair", fitter._handle, *references, _PAIRS.index(how))
        share = real("share", share, RangeError)
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
            It is not a metric, or is damaged. The message names the place.
        """
        try:
            text = files.read(file)
        except OSError as error:
            raise StoreError(f"{file}: cannot be read: {error.strerror}") from error
        try:
            return cls.read(text)
        except MetricError as error:
            raise MetricError(f"{file}: {error}") from None

    @classmethod
    def read(cls, text: bytes) -> Metric:
        """Read a metric from a result of :meth:`write`.

        Parameters
        ----------
        text : bytes

        Returns
        -------
        Metric

        Raises
        ------
        MetricError
            It is not a metric, or is damaged. The message names the place.
        """
        if not isinstance(text, bytes | bytearray | memoryview):
            raise MetricError(f"a metric is bytes, not {type(text).__name__}")
        return cls("rlvc_metric_read", bytes(text), len(text))

    def save(self, file: str | Path) -> None:
        """Write the metric to a file. If that fails, an existing file stays as it was.

        Parameters
        ----------
        file : str or Path

        Raises
        ------
        StoreError
            The file cannot be written.
        """
        files.replace(file, self.write())

    def write(self) -> bytes:
        """Return the metric as JSON.

        Returns
        -------
        bytes
        """
        count = ctypes.c_size_t()
        text = ctypes.create_string_buffer(0)
        while True:
            room = len(text)
            error = ctypes.byref(_native.VisionError())
            status = library.rlvc_metric_write(self._handle, text, room, ctypes.byref(count), error)
            if status == 0:
                return text.raw[: count.value]
            if count.value <= room:
                raise Error(library.rlvc_vision_status_text(status).decode())
            text = ctypes.create_string_buffer(count.value)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the JSON."""
        return type(self).read, (self.write(),)
