# SPDX-License-Identifier: MIT
"""The configuration of the feature extraction."""

from __future__ import annotations

import ctypes
import dataclasses
from typing import Any

import numpy as np

from .. import _native
from ..errors import (
    ConfigError,
)
from .library import call, library

DESCRIPTORS = ("invariants", "sqrt-invariants", "sift-upright", "sift", "orb")
"""What can stand in a point's vector."""

FORMS = ("float", "int8")


@dataclasses.dataclass(frozen=True)
class VisionConfig:
    """How pictures are looked at.

    Attributes
    ----------
    descriptor : {"sift-upright", "sift", "orb", "invariants", "sqrt-invariants"}
        What stands in a point's vector: SIFT, its window not turned, or turned to the point's own
        direction; ORB; the published colour differential invariants of first order, or those with
        the signed square root of their terms of second degree.
    points : int
        P, the most points of a picture, [1, 1000]; the strongest are kept.
    radius : int
        In pixels: a point's response exceeds all others in the square of side 2 radius + 1, [1,
        31].
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
        call("rlvc_vision_config_check", ctypes.byref(native))
        if self.sigma is None:
            object.__setattr__(self, "sigma", float(native.sigma))

    def native(self) -> _native.VisionConfig:
        """Make the C struct."""
        for name, values in (("descriptor", DESCRIPTORS), ("form", FORMS)):
            if getattr(self, name) not in values:
                raise ConfigError(f"{name}: {getattr(self, name)!r} is none of {', '.join(values)}")
        native = _native.VisionConfig()
        library.rlvc_vision_config_default(
            DESCRIPTORS.index(self.descriptor), ctypes.byref(native)
        )
        native.form = FORMS.index(self.form)
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
    def of(cls, native: _native.VisionConfig) -> VisionConfig:
        """Give the config that a C struct says."""
        fields = {field.name: getattr(native, field.name) for field in dataclasses.fields(cls)}
        for name in ("sd", "si", "k", "threshold", "sigma"):
            fields[name] = float(str(np.float32(fields[name])))  # 0.04, and not 0.03999999910593033
        fields["descriptor"] = DESCRIPTORS[native.descriptor]
        fields["form"] = FORMS[native.form]
        fields["normalise"] = bool(native.normalise)
        return cls(**fields)


def config_of(config: VisionConfig | str, changes: dict[str, Any]) -> VisionConfig:
    """Give a config with some fields changed; a str means the defaults for that descriptor."""
    if isinstance(config, str):
        config = VisionConfig(config)
    try:
        return dataclasses.replace(config, **changes)
    except TypeError as error:
        raise ConfigError(f"no such field: {error}") from None
