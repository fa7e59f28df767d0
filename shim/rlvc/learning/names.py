# SPDX-License-Identifier: MIT
"""Names of the numbers that Gymnasium's classic tasks observe."""

from __future__ import annotations

import re
from typing import Any

_POLE = ["position", "velocity", "angle", "angular velocity"]
_LINKS = ["cos angle 1", "sin angle 1", "cos angle 2", "sin angle 2", "speed 1", "speed 2"]
_LANDER = ["x", "y", "x speed", "y speed", "angle", "angular speed", "left leg", "right leg"]

NAMES = {
    "CartPole": _POLE,
    "MountainCar": ["position", "velocity"],
    "MountainCarContinuous": ["position", "velocity"],
    "Acrobot": _LINKS,
    "Pendulum": ["cos angle", "sin angle", "angular velocity"],
    "LunarLander": _LANDER,
    "LunarLanderContinuous": _LANDER,
    "Blackjack": ["own sum", "dealer's card", "usable ace"],
}
"""By the name of the task without its version."""


def known_names(env: Any, space: Any) -> list[str] | None:
    """Return the names of a task's numbers; None if it is not known, or its observations changed.

    Parameters
    ----------
    env : gymnasium.Env or gymnasium.vector.VectorEnv
    space : gymnasium.Space
        Of one observation.

    Returns
    -------
    list of str or None
    """
    try:
        match = re.fullmatch(r"(\w+)-v\d+", str(getattr(env.spec, "id", "")))
        base = env.unwrapped
        own = getattr(base, "single_observation_space", getattr(base, "observation_space", None))
        return list(NAMES[match[1]]) if match and match[1] in NAMES and space == own else None
    except Exception:  # of an environment with neither, or whose own code fails
        return None
