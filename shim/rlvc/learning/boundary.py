# SPDX-License-Identifier: MIT
"""Checks of the values that an environment returns.

numpy's numbers, arrays of one element, and 0 or 1 as a flag are accepted. For other values the
error says what the environment should return. What an environment raises itself is the cause of an
:class:`~rlvc.errors.EnvError`, which says in which call.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import flag, real, shown, told
from ..errors import EnvError, Error, RewardError

_OLD = (
    "it has the interface of an old version of Gym: wrap it, for example with Shimmy's "
    "GymV21CompatibilityV0"
)


def check(env: Any) -> None:
    """Raise :class:`~rlvc.errors.EnvError` if an object is not an environment of Gymnasium.

    Parameters
    ----------
    env : object
    """
    if isinstance(env, str):
        raise EnvError(f"env: {shown(env)} is a name: pass gymnasium.make({shown(env)})")
    for name in ("reset", "step", "action_space", "observation_space"):
        try:
            getattr(env, name)
        except Exception as error:  # it has none, or making it fails
            kind = type(env).__name__
            raise EnvError(f"env: {kind} is not an environment: {told(error)}") from error
    try:
        parameters = inspect.signature(env.reset).parameters
    except Exception:  # of a function in C, or of a class of the caller: to call it tells more
        return
    if "seed" not in parameters and all(p.kind is not p.VAR_KEYWORD for p in parameters.values()):
        raise EnvError(f"env: its reset() takes no seed: {_OLD}")


def reset(env: Any, **arguments: Any) -> Any:
    """Reset an environment, or a vector of them.

    Parameters
    ----------
    env : gymnasium.Env or gymnasium.vector.VectorEnv
    **arguments
        ``seed`` and ``options``.

    Returns
    -------
    observation, dict
        The first observation, and the info.
    """
    returned = _called("reset", env.reset, **arguments)
    if not isinstance(returned, tuple) or len(returned) != 2 or not isinstance(returned[1], dict):
        raise EnvError(f"reset() returned {shown(returned)}, expected (observation, info): {_OLD}")
    return returned


def step(env: Any, action: Any) -> tuple[Any, float, bool, bool, Any]:
    """Act in an environment.

    Parameters
    ----------
    env : gymnasium.Env
    action : element of its action space

    Returns
    -------
    observation, float, bool, bool, dict
        The next observation, the reward, terminated, truncated, and the info.
    """
    returned = _called("step", env.step, action)
    observation, reward, terminated, truncated, info = _five(returned)
    if (
        terminated.__class__ is bool
        and truncated.__class__ is bool
        and reward.__class__ in (float, int)
        and -_native.REWARD_MAX <= reward <= _native.REWARD_MAX
    ):
        return returned  # type: ignore[no-any-return]
    return (
        observation,
        _reward("reward", reward),
        flag("terminated", terminated, EnvError),
        flag("truncated", truncated, EnvError),
        info,
    )


def step_all(env: Any, chosen: npt.NDArray[Any]) -> tuple[Any, Any, Any, Any, Any]:
    """Act in each environment of a vector.

    Parameters
    ----------
    env : gymnasium.vector.VectorEnv
    chosen : ndarray, [n, ...]

    Returns
    -------
    observations, float64 [n], bool [n], bool [n], dict
        The next observations, the rewards, terminated, truncated, and the info.
    """
    returned = _called("step", env.step, chosen)
    observations, rewards, terminated, truncated, info = _five(returned)

    def flags(name: str, values: Any) -> npt.NDArray[np.bool_]:
        if isinstance(values, np.ndarray) and values.dtype == np.bool_ and values.shape == (count,):
            return values
        each = enumerate(_each(values, name, count))
        return np.array([flag(f"{name}[{i}]", value, EnvError) for i, value in each])

    count = len(chosen)
    if not (
        isinstance(rewards, np.ndarray)
        and rewards.dtype == np.float64
        and rewards.shape == (count,)
        and (np.abs(rewards) <= _native.REWARD_MAX).all()
    ):
        each = enumerate(_each(rewards, "rewards", count))
        rewards = np.array([_reward(f"rewards[{i}]", value) for i, value in each])
    return (
        observations,
        rewards,
        flags("terminated", terminated),
        flags("truncated", truncated),
        info,
    )


def _called(name: str, method: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
    """What a method of the environment returns; what it raises is the cause of an EnvError."""
    try:
        return method(*arguments, **options)
    except Error:
        raise
    except Exception as error:
        call = f"{name}({', '.join(map(shown, arguments))})"
        fault = told(error)
        raise EnvError(f"{call} of the environment raised {fault}") from error


def _five(returned: Any) -> Any:
    if not isinstance(returned, tuple) or len(returned) != 5:
        count = f"{len(returned)} values" if isinstance(returned, tuple) else shown(returned)
        raise EnvError(
            f"step() returned {count}, expected (observation, reward, terminated, truncated, info)"
            + (f": {_OLD}" if count == "4 values" else "")
        )
    return returned


def _each(values: Any, name: str, count: int) -> list[Any]:
    """The elements of an array, one for each environment."""
    try:
        listed = list(values)
    except Exception:  # also of a class of the caller
        listed = []
    if len(listed) != count:
        raise EnvError(f"{name}: {shown(values)} is not an array of {count} elements")
    return listed


def _reward(name: str, value: Any) -> float:
    reward = real(name, value, RewardError)
    if abs(reward) > _native.REWARD_MAX:
        raise RewardError(f"{name}: {shown(value)} is not in [-1e12, 1e12]: scale the rewards")
    return reward
