# SPDX-License-Identifier: MIT
"""The config of an agent: ``rlvc_config`` with its defaults."""

from __future__ import annotations

import ctypes
import dataclasses
import math
from typing import Literal

from .. import _native
from ..errors import ConfigError

Criterion = Literal["returns", "residual"]
Score = Literal["gain", "ranks"]
Solver = Literal["value_iteration", "policy_iteration", "q_learning", "sarsa"]
Explore = Literal["uniform", "directed"]

# Field: its names. The name n of field f is the constant F_N of agent.h.
CHOICES: dict[str, tuple[str, ...]] = {
    "criterion": ("returns", "residual"),
    "score": ("gain", "ranks"),
    "solver": ("value_iteration", "policy_iteration", "q_learning", "sarsa"),
    "explore": ("uniform", "directed"),
}


@dataclasses.dataclass(frozen=True)
class Config:
    """How an agent learns: chosen once, when it is made.

    Parameters
    ----------
    actions : int
        How many actions there are, [1, 255].
    capacity : int
        Interactions the ring holds, [1, 2**31 - 1]; when it is full the oldest leaves. A truncated
        or torn episode takes the room of one more.
    classes : int
        Classes the tree may grow to, [1, 65535].
    features_at_once : int or None
        Candidate features whose bit columns are held in memory together, [1, 64]. None: 64, or as
        many features as there are if that is known and less.
    min_samples : int
        A class with fewer samples than this is not tested for a split, [2, 2**31 - 1].
    max_sweeps : int
        Sweeps after which a batch solver stops unconverged, [1, 2**31 - 1].
    seed : int
        Of the exploration, [0, 2**32 - 1].
    criterion : {"residual", "returns"}
        Which classes are aliased (section 4.2.2): by one-step returns on one growing database, or
        by truncated discounted returns on a fresh one each step, as published.
    score : {"gain", "ranks"}
        How well a feature explains a partition (section 4.2.3); or, without a partition, the
        rank-sum test of the targets with the feature against those without it (not for a domain
        with its own ``oracle``; ``capacity`` below 2**21).
    solver : {"value_iteration", "policy_iteration", "q_learning", "sarsa"}
        Where the values of the classes come from.
    continuing : bool
        Whether the window of definition 1 runs on through a terminated interaction.
    successors : bool or None
        Whether a class is aliased, too, if what follows the same action differs, even while all
        rewards are alike (residual criterion; the candidates must fit into ``features_at_once``).
        None: for up to 64 bits yes, else no.
    explore : {"directed", "uniform"}
        How to explore: one action in two leads to the nearest class-action pair that was little
        tried, the other is drawn with preference for what was seldom tried in the class; or all
        alike, as published.
    discount : float
        gamma of equation (1), [0, 1].
    epsilon : float
        Probability that ``act`` explores at random, [0, 1].
    alpha : float
        The probability that the tree ever takes up a feature while there is nothing to learn, at
        most, (0, 1]: all learning steps share it.
    alpha_known : float
        A split by a feature that the tree tests already is kept if its corrected p-value is below
        this, (0, 1]; below the share of ``alpha`` without effect.
    tolerance : float
        Of a batch solver's values, in units of reward, (0, 1e12].
    learning_rate : float
        Of the incremental solvers, (0, 1].

    Notes
    -----
    The fields are those of ``rlvc_config`` in ``core/include/rlvc/agent.h``, which says more. They
    are checked when an agent is made: :class:`ConfigError` then names the field and its range.
    """

    actions: int
    capacity: int = 2000
    classes: int = 64
    features_at_once: int | None = None
    min_samples: int = 8
    max_sweeps: int = 10_000
    seed: int = 1
    criterion: Criterion = "residual"
    score: Score = "gain"
    solver: Solver = "value_iteration"
    continuing: bool = False
    successors: bool | None = None
    explore: Explore = "directed"
    discount: float = 0.9
    epsilon: float = 0.9
    alpha: float = 0.01
    alpha_known: float = 1.0
    tolerance: float = 0.01
    learning_rate: float = 0.1

    def replace(self, **changes: object) -> Config:
        """Give a copy with some fields changed.

        Parameters
        ----------
        **changes
            Fields of the config and their new values.

        Returns
        -------
        Config
            The copy.
        """
        try:
            return dataclasses.replace(self, **changes)  # type: ignore[arg-type]
        except TypeError as error:
            raise ConfigError(f"no such field: {error}") from None


def _native_value(field: str, kind: object, value: object) -> object:
    if field in CHOICES:
        if value not in CHOICES[field]:
            raise ConfigError(f"{field}: {value!r} is none of {', '.join(CHOICES[field])}")
        return getattr(_native, f"{field}_{value}".upper())
    try:
        if kind is ctypes.c_float:
            number = float(value)  # type: ignore[arg-type]
            if not math.isfinite(number):
                raise ConfigError(f"{field}: {value!r} is no finite number")
            return number
        whole = int(value.__index__())  # type: ignore[attr-defined]
    except (AttributeError, TypeError, ValueError) as error:
        if isinstance(error, ConfigError):
            raise
        raise ConfigError(f"{field}: {value!r} is no number of the kind that is wanted") from None
    limit = 2 ** (8 * ctypes.sizeof(kind))  # type: ignore[arg-type]
    if not 0 <= whole < limit:
        raise ConfigError(f"{field}: {whole} is out of range")
    return whole


def to_native(config: Config, domain: _native.Domain) -> _native.Config:
    """Make the C struct and check it.

    Parameters
    ----------
    config : Config
    domain : rlvc_domain

    Returns
    -------
    rlvc_config

    Raises
    ------
    ConfigError
        A field is out of range; the text names it.
    """
    native = _native.Config()
    reference = ctypes.byref(native)
    domain_reference = ctypes.byref(domain)
    actions = _native_value("actions", ctypes.c_uint32, config.actions)
    _native.call.rlvc_config_default(reference, domain_reference, actions)
    for field, kind in _native.Config._fields_:  # type: ignore[misc]
        value = getattr(config, field, None)
        if value is not None and field != "reserved":
            setattr(native, field, _native_value(field, kind, value))
    why = ctypes.c_char_p()
    if _native.call.rlvc_config_check(reference, domain_reference, ctypes.byref(why)) != _native.OK:
        raise ConfigError((why.value or b"a field is out of range").decode())
    return native
