# SPDX-License-Identifier: MIT
"""The config of the feature extraction."""

from __future__ import annotations

import ctypes
import dataclasses
from typing import Any

import numpy as np

from .. import _native
from ..checks import known, one_of, shown
from ..errors import (
    ConfigError,
)
from .library import call, library

DESCRIPTORS = ("invariants", "sqrt-invariants", "sift-upright", "sift", "orb", "quarters")
"""The descriptors."""

FORMS = ("float", "int8")
PLACES = ("none", "points", "directed")


@dataclasses.dataclass(frozen=True)
class VisionConfig:
    """How features are extracted from pictures.

    Attributes
    ----------
    descriptor : {"sift-upright", "sift", "orb", "invariants", "sqrt-invariants", "quarters"}
        sift-upright: SIFT without rotation. sift: SIFT rotated to the direction of the point. orb:
        ORB. invariants: the published colour differential invariants of first order.
        sqrt-invariants: the same with the signed square root of the second-degree terms. quarters:
        one vector for the whole picture, the mean colours of its quarters.
    points : int or None
        P, the maximum number of points of a picture, [1, 1000]; the strongest are kept. None: 30,
        quarters 1.
    radius : int
        In pixels, [1, 31]: a point has the largest response in the square of side 2 radius + 1.
    form : {"float", "int8"}
        Type of the vectors' elements in the percept.
    normalise : bool
        Whether to first bring each channel of a picture to mean 128 and standard deviation 64.
    axes : int
        Length of the vectors in the percept: the first axes of a ``discriminant`` metric, [0, 255];
        0: all elements.
    places : {"none", "points", "directed"}
        What the percept has besides the vectors, for features of several points
        (:class:`rlvc.Spatial`). points: their places. directed: also their directions.
    sd, si : float
        In pixels: the scale of the derivatives in the Harris response, [0.5, 4], and the scale of
        its integration, [0.5, 8].
    k : float
        H = det M - k (trace M)^2, [0, 0.25).
    threshold : float
        The smallest response of a point, as a fraction of the picture's largest, [0, 1).
    sigma : float or None
        In pixels: the scale of the descriptor, [0.5, 8], for SIFT [1, 8]. None: 2.5, SIFT 6, ORB 5.
    noise : float
        In grey levels, [0, 64]: responses as noise of this standard deviation has them are not
        points.

    Raises
    ------
    ConfigError
        A field is out of range. The message names it.
    """

    descriptor: str = "sift-upright"
    points: int | None = None
    radius: int = 3
    form: str = "float"
    normalise: bool = False
    axes: int = 0
    places: str = "none"
    sd: float = 1.0
    si: float = 2.0
    k: float = 0.04
    threshold: float = 0.001
    sigma: float | None = None
    noise: float = 3.0

    def __post_init__(self) -> None:
        native = self.native()
        call("rlvc_vision_config_check", ctypes.byref(native))
        for name in ("points", "sigma"):
            if getattr(self, name) is None:
                object.__setattr__(self, name, getattr(native, name))

    def native(self) -> _native.VisionConfig:
        """Make the C struct."""
        for name, values in (
            ("descriptor", DESCRIPTORS),
            ("form", FORMS),
            ("places", PLACES),
        ):
            one_of(name, getattr(self, name), values)
        native = _native.VisionConfig()
        library.rlvc_vision_config_default(DESCRIPTORS.index(self.descriptor), ctypes.byref(native))
        native.form = FORMS.index(self.form)
        native.places = PLACES.index(self.places)
        for name in (
            "points",
            "radius",
            "normalise",
            "axes",
            "sd",
            "si",
            "k",
            "threshold",
            "sigma",
            "noise",
        ):
            value = getattr(self, name)
            whole = {"points": 2**32, "radius": 2**32, "axes": 2**8}.get(name)
            if name in ("points", "sigma") and value is None:
                continue  # the library's default
            if whole and (not isinstance(value, int) or not 0 <= value < whole):
                raise ConfigError(f"{name}: {shown(value)} is not an int in range")
            try:
                setattr(native, name, value)
            except TypeError:
                raise ConfigError(f"{name}: {shown(value)} is not a number") from None
        return native

    @classmethod
    def of(cls, native: _native.VisionConfig) -> VisionConfig:
        """Return the config of a C struct."""
        fields = {field.name: getattr(native, field.name) for field in dataclasses.fields(cls)}
        for name in ("sd", "si", "k", "threshold", "sigma", "noise"):
            fields[name] = float(str(np.float32(fields[name])))  # 0.04, not 0.03999999910593033
        fields["descriptor"] = DESCRIPTORS[native.descriptor]
        fields["form"] = FORMS[native.form]
        fields["places"] = PLACES[native.places]
        fields["normalise"] = bool(native.normalise)
        return cls(**fields)


def config_of(config: VisionConfig | str, changes: dict[str, Any]) -> VisionConfig:
    """Return a config with some fields changed; a str names a descriptor with its defaults."""
    if isinstance(config, str):
        config = VisionConfig(config)
    known(changes, (field.name for field in dataclasses.fields(config)), "an extractor")
    return dataclasses.replace(config, **changes)
