# SPDX-License-Identifier: MIT
"""The policy over two components of real numbers: which action is taken where."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ..checks import shown
from ..errors import RunError
from ..words import shortest
from .drawing import GREY, PAPER, Source, axes_of, run_of, save

_COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#999999"]
_HATCHES = ["", "//", "\\\\", "xx", "--", "||", "++"]  # seven, so that 56 actions differ
_LINES = "#7a7a7a"  # of hatches
_POINTS = 300  # in each direction
_TOLD = 4  # components that the title names


def regions(
    source: Source,
    file: str | Path | None = None,
    components: Sequence[str] | None = None,
    observation: Any = None,
    ax: Any = None,
) -> Figure:
    """Draw which action is taken where, over two components of real numbers.

    Needs a run with an :class:`rlvc.Encoder`. ``components`` are their names, the horizontal one
    first; None: the two that matter most by ``run.importances()``. All others are as in
    ``observation``; None: as in the most typical percept that was seen. Dots are
    percepts that were seen: where there are none, the policy was not tried.
    """
    run = run_of(source, "regions")
    names = _real_names(run)
    x, y = (names[name] for name in _chosen(run, names, components))
    seen = _seen(run)
    base = _typical(seen) if observation is None else _numbers(run.percept(observation))
    (left, right), (low, high) = _range(seen[:, x], base[x]), _range(seen[:, y], base[y])
    xs = np.linspace(left, right, _POINTS)
    ys = np.linspace(low, high, _POINTS)
    rows = np.tile(base, (_POINTS * _POINTS, 1))
    rows[:, x], rows[:, y] = np.tile(xs, _POINTS), np.repeat(ys, _POINTS)
    actions = run.indices(rows).reshape(_POINTS, _POINTS).astype(int)
    figure, axes = axes_of(ax, 7, 5)
    keys = _fill(axes, xs, ys, actions, run)
    dots = axes.scatter(
        seen[:, x], seen[:, y], s=9, color="black", edgecolors=PAPER, linewidths=0.5, label="seen"
    )
    keys.append(dots)
    axes.legend(handles=keys, loc="upper left", bbox_to_anchor=(1.01, 1), frameon=False, fontsize=9)
    axes.set_xlim(left, right)
    axes.set_ylim(low, high)
    axes.set_xlabel(run.encoder.names[x])
    axes.set_ylabel(run.encoder.names[y])
    axes.set_title(_others(run, base, (x, y)), fontsize=10, loc="left")
    return save(figure, file)


def _real_names(run: Any) -> dict[str, int]:
    """The components of real numbers, by name."""
    names, flags = getattr(run.encoder, "names", []), getattr(run.encoder, "flags", [])
    real = {name: i for i, (name, flag) in enumerate(zip(names, flags, strict=True)) if not flag}
    if len(real) < 2:
        raise RunError(f"regions: needs two components of real numbers, and there are {len(real)}")
    return real


def _chosen(run: Any, names: dict[str, int], components: Sequence[str] | None) -> list[str]:
    if components is None:
        return [name for name in run.importances() if name in names][:2]
    wanted = [components] if isinstance(components, str) else list(components)
    if len(wanted) != 2 or not set(wanted) <= set(names) or wanted[0] == wanted[1]:
        raise RunError(f"components: {shown(wanted)}: give two of {', '.join(names)}")
    return wanted


def _seen(run: Any) -> npt.NDArray[np.float32]:
    if not run.seen.percepts:
        raise RunError("regions: no percept was seen")
    flat = np.frombuffer(b"".join(run.seen.percepts), np.float32)
    return flat.reshape(len(run.seen.percepts), -1)


def _numbers(percept: Any) -> npt.NDArray[np.float32]:
    """Return the components of a percept, which may be bytes."""
    return np.frombuffer(percept, np.float32)


def _typical(seen: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Return the percept next to the median: one that exists, also in its components 0 or 1."""
    away = np.abs(seen - np.median(seen, axis=0)) / (seen.std(axis=0) + 1e-9)
    return np.asarray(seen[np.argmin(away.sum(axis=1))])


def _range(values: npt.NDArray[np.float32], base: float) -> tuple[float, float]:
    """Return what nearly all values lie in, and the base, with a margin."""
    low, high = (float(end) for end in np.percentile(values, [0.5, 99.5]))
    low, high = min(low, float(base)), max(high, float(base))
    margin = 0.05 * (high - low) or 0.5
    return low - margin, high + margin


def _fill(axes: Any, xs: Any, ys: Any, actions: npt.NDArray[np.int_], run: Any) -> list[Any]:
    """Fill the region of each action with its colour and its hatch; return the legend's keys."""
    present = np.unique(actions).tolist()
    # By its place among the policy's actions, one looks alike in all figures of a run.
    order = sorted({node["action"] for node in run.tree["nodes"] if "test" not in node})
    keys: list[Any] = []
    for action in present:
        place = order.index(action)
        pale: Any = tuple(0.5 + 0.5 * part for part in to_rgb(_COLOURS[place % len(_COLOURS)]))
        hatch = _HATCHES[place % len(_HATCHES)]
        inside = (actions == action).astype(float)
        with mpl.rc_context({"hatch.color": _LINES}):
            axes.contourf(xs, ys, inside, [0.5, 1.5], colors=[pale], hatches=[hatch])
        if len(present) > 1:
            axes.contour(xs, ys, inside, [0.5], colors=GREY, linewidths=0.8)
        name = run.actions.name(action)
        keys.append(Patch(facecolor=pale, edgecolor=_LINES, hatch=hatch, label=name))
    return keys


def _others(run: Any, base: npt.NDArray[np.float32], drawn: tuple[int, int]) -> str:
    """Say what the components are that are not drawn."""
    names = run.encoder.names
    told = [
        f"{name} = {shortest(float(f'{base[i]:.3g}'))}"
        for i, name in enumerate(names)
        if i not in drawn
    ]
    more = f" and {len(told) - _TOLD} more" if len(told) > _TOLD else ""
    where = f", where {', '.join(told[:_TOLD])}{more}" if told else ""
    return f"Action taken{where}"
