# SPDX-License-Identifier: MIT
"""Why a policy acts as it does: what matters to it, and the path of an observation."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from ..errors import RunError
from ..words import shortest
from .drawing import BLUE, GREY, Source, axes_of, run_of, save, tidy

_MOST = 20  # bars


def importances(source: Source, file: str | Path | None = None, ax: Any = None) -> Figure:
    """Draw a bar for each number of an observation: how much it matters to the policy.

    Needs a run; ``run.importances()`` says what is measured. Of more than twenty numbers the first
    twenty are drawn.
    """
    found = list(run_of(source, "importances").importances().items())
    shown = found[:_MOST]
    figure, axes = axes_of(ax, 7, 0.32 * len(shown) + 1.3)
    axes.barh(range(len(shown)), [share for _, share in shown], color=BLUE, height=0.65)
    for place, (_, share) in enumerate(shown):
        axes.annotate(
            f"{share:.3g}",
            (share, place),
            (4, 0),
            textcoords="offset points",
            va="center",
            fontsize=9,
        )
    axes.set_yticks(range(len(shown)), [name for name, _ in shown], fontsize=9)
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.set_xlim(0, 1.15 * max([share for _, share in shown], default=0) or 1)
    axes.set_xlabel("share of percepts whose action depends on it")
    left = f", the first {_MOST} of {len(found)}" if len(found) > _MOST else ""
    axes.set_title(f"Importance of each number{left}", fontsize=12, loc="left")
    tidy(axes, grid="x")
    return save(figure, file)


def path(
    source: Source, file: str | Path | None = None, observation: Any = None, ax: Any = None
) -> Figure:
    """Draw the path of an observation through the tree: its tests, their answers, and the action.

    Needs a run; ``observation`` is an element of the environment's space.
    """
    run = run_of(source, "path")
    if observation is None:
        raise RunError("path: give the observation whose path is drawn")
    explanation = run.explain(observation)
    worth = "" if explanation.value is None else f", value {explanation.value:.4g}"
    lines = [_asked(step) for step in explanation.steps] + [f"{explanation.action_name}{worth}"]
    width = max(3.0, 0.105 * max(map(len, lines)) + 0.8)
    figure, axes = axes_of(ax, width, 0.75 * len(lines) + 0.5)
    frame: dict[str, Any] = {
        "boxstyle": "round,pad=0.45",
        "facecolor": "#ffffff",
        "edgecolor": BLUE,
        "linewidth": 1.4,
    }
    for place, line in enumerate(lines):
        if place == len(explanation.steps):
            frame |= {"facecolor": "#fbf3d9", "edgecolor": GREY, "linewidth": 1.0}
        axes.text(0, place, line, ha="center", va="center", fontsize=10, bbox=frame, zorder=3)
    for place, step in enumerate(explanation.steps):
        style = "-" if step.passed else "--"
        drawn = {"arrowstyle": "-|>", "color": GREY, "linestyle": style, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", (0, place + 0.76), (0, place + 0.24), arrowprops=drawn)
        axes.annotate(
            "yes" if step.passed else "no", (0, place + 0.48), (8, 0), textcoords="offset points",
            va="center", fontsize=9,
        )  # fmt: skip
    axes.set_xlim(-1, 1)
    axes.set_ylim(len(lines) - 0.5, -0.5)
    axes.set_title("Path of the observation", fontsize=12, loc="left")
    axes.set_axis_off()
    return save(figure, file)


def _asked(step: Any) -> str:
    """A test, with the value that it compares."""
    if step.value is None:
        return f"{step.test}?"
    return f"{step.test}?   here {shortest(float(f'{step.value:.4g}'))}"
