# SPDX-License-Identifier: MIT
"""The config of an agent."""

from __future__ import annotations

import ctypes
import dataclasses
from typing import Any, Literal, get_args

from .. import _native
from ..checks import flag, one_of, real, whole
from ..errors import ConfigError
from .fields import Fields

Criterion = Literal["returns", "residual"]
Score = Literal["gain", "ranks"]
Solver = Literal["value_iteration", "policy_iteration", "q_learning", "sarsa"]
Explore = Literal["uniform", "directed"]

# A field and its names. The name n of field f is the constant RLVC_F_N of agent.h.
CHOICES: dict[str, tuple[str, ...]] = {
    "criterion": get_args(Criterion),
    "score": get_args(Score),
    "solver": get_args(Solver),
    "explore": get_args(Explore),
}


@dataclasses.dataclass(frozen=True)
class Config(Fields):
    """How an agent learns. It is fixed when the agent is made.

    Parameters
    ----------
    actions : int
        Number of actions, [1, 255].
    capacity : int
        Capacity of the replay buffer in interactions, [1, 2**31 - 1]. When it is full, the oldest
        interaction is dropped. Each truncated or unfinished episode takes the room of one more.
    classes : int
        Maximum number of classes, [1, 65535].
    features_at_once : int or None
        Number of candidate features that are compared at a time, [1, 64]; each needs memory for a
        bit column. None: 64, or the number of features if that is known and smaller.
    min_samples : int
        A class with fewer samples than this is not split, [2, 2**31 - 1].
    max_sweeps : int
        Maximum number of sweeps of a batch solver, [1, 2**31 - 1].
    seed : int
        Seed of the exploration, [0, 2**32 - 1].
    criterion : {"residual", "returns"}
        How aliased classes are detected (section 4.2.2). residual: by one-step returns, with all
        interactions so far. returns: by truncated discounted returns, with new interactions for
        each learning step, as published.
    score : {"gain", "ranks"}
        How features are compared (section 4.2.3). gain: information gain for the best cutpoint of
        the targets. ranks: rank-sum test of the targets with and without the feature (not with an
        ``oracle``; ``capacity`` below 2**21).
    solver : {"value_iteration", "policy_iteration", "q_learning", "sarsa"}
        How the values of the classes are computed.
    continuing : bool
        Whether the returns of definition 1 continue after a terminated interaction.
    successors : bool or None
        Whether to also split a class by a feature that the agent influences and that lasts, even
        while all rewards are equal (residual criterion; a domain whose number of candidates is
        known). None: yes for bits, else no.
    dependence : bool or None
        Whether, for a feature that is new to the tree, the samples of a class count as fewer if
        both the feature and what it leaves unexplained of the targets stay for long, from one visit
        to the next: what stays agrees with other things that do by chance, as a lamp that is on for
        a while with rewards that drift. No effect without ``successors``, which find what the agent
        influences. None: where ``successors`` are, but not from logs, so that counts, which keep no
        order, make the same tree of them.
    explore : {"directed", "uniform"}
        How to explore. directed: one action in two leads towards the nearest class-action pair with
        few tries, the other prefers actions with few tries in the class. uniform: every action is
        equally likely, as published.
    discount : float
        Discount factor, gamma of equation (1), [0, 1].
    epsilon : float
        Probability that ``act`` explores, [0, 1].
    alpha : float
        Significance level, (0, 1]: the probability that an irrelevant feature ever enters the tree,
        over all learning steps together.
    alpha_known : float or None
        Significance level of a split by a feature that is in the tree already, or that the agent
        influences, (0, 1]. No effect if it is below the level that ``alpha`` gives. None: 0.1 for
        bits, else 1.
    tolerance : float
        Accuracy of the values of a batch solver, in units of reward, (0, 1e12].
    learning_rate : float
        Learning rate of q_learning and sarsa, (0, 1].
    smallest_effect : float
        In units of return, [0, 1e12]. A class is not split by targets if the mean targets of the two
        sides surely differ by less, after each action. For very many interactions, of which any
        difference becomes significant. 0: any difference is worth a split.

    Notes
    -----
    The fields are checked when an agent is made. ``rlvc_config`` in ``core/include/rlvc/agent.h``
    has more details.
    """

    _learner = "an agent"

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
    dependence: bool | None = None
    explore: Explore = "directed"
    discount: float = 0.9
    epsilon: float = 0.9
    alpha: float = 0.01
    alpha_known: float | None = None
    tolerance: float = 0.01
    learning_rate: float = 0.1
    smallest_effect: float = 0.0



_FLAGS = ("continuing", "successors", "dependence")


def _native_value(field: str, kind: Any, value: Any) -> object:
    if field in CHOICES:
        return getattr(_native, f"{field}_{one_of(field, value, CHOICES[field])}".upper())
    if kind is ctypes.c_float:
        return real(field, value)
    if field in _FLAGS:
        return flag(field, value)
    return whole(field, value, 0, 2 ** (8 * ctypes.sizeof(kind)) - 1)


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
        A field is out of range. The message names it.
    """
    native = _native.Config()
    reference = ctypes.byref(native)
    domain_reference = ctypes.byref(domain)
    actions = _native_value("actions", ctypes.c_uint32, config.actions)
    _native.call.rlvc_config_default(reference, domain_reference, actions)
    native.method = _native.METHOD_CLASSES
    for field, kind in _native.Config._fields_:  # type: ignore[misc]
        value = getattr(config, field, None)
        if value is not None and field != "reserved":
            setattr(native, field, _native_value(field, kind, value))
    why = ctypes.c_char_p()
    if _native.call.rlvc_config_check(reference, domain_reference, ctypes.byref(why)) != _native.OK:
        raise ConfigError((why.value or b"a field is out of range").decode())
    return native
