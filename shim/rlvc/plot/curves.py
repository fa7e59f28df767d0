# SPDX-License-Identifier: MIT
"""Learning curves, and the splits over time."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from ..errors import RunError
from .drawing import BLUE, GREY, ORANGE, Source, axes_of, explained, need, reports, save, tidy


def learning_curve(source: Source, file: str | Path | None = None) -> Figure:
    """Draw the number of classes, and of optimal cells or the mean return, over interactions.

    Of a planner it is the number of leaves. Needs ``history``. All runs of a report are drawn.
    """
    runs = [need(run, "history") for run in reports(source)]
    if not runs[0]["history"]:
        raise RunError("the report has no learning step to draw")
    optimal = "optimal_cells" in runs[0]["history"][0]
    second = "optimal_cells" if optimal else "mean_return"
    figure = Figure(figsize=(7, 5), layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True)
    for run in runs:
        points = [record["interactions"] for record in run["history"]]
        thin = 2.0 if len(runs) == 1 else 0.9
        upper.plot(
            points,
            [record["classes"] for record in run["history"]],
            color=BLUE,
            linewidth=thin,
            marker="o" if len(points) == 1 else None,  # of a log, which is learnt in one step
            markersize=3.5,
        )
        known = [record for record in run["history"] if record[second] is not None]
        lower.plot(
            [record["interactions"] for record in known],
            [record[second] for record in known],
            color=ORANGE,
            linewidth=thin,
            marker="o" if len(runs) == 1 else None,
            markersize=3.5,
        )
    upper.set_ylabel("leaves" if runs[0].get("method") == "planner" else "classes")
    lower.set_ylabel("optimal cells" if optimal else "mean return while learning")
    lower.set_xlabel("interactions")
    if optimal and "cells" in runs[0]:
        lower.axhline(runs[0]["cells"], color=GREY, linewidth=0.9, linestyle=":")
        lower.annotate(
            f"all {runs[0]['cells']} cells",
            (1, runs[0]["cells"]),
            xycoords=("axes fraction", "data"),
            xytext=(0, 3),
            textcoords="offset points",
            ha="right",
            va="bottom",
            fontsize=9,
            color=GREY,
        )
        lower.set_ylim(top=1.15 * runs[0]["cells"])
    if not any(len(line.get_xdata()) for line in lower.lines):
        lower.text(0.5, 0.5, "no return is known", ha="center", transform=lower.transAxes)
        lower.set_yticks([])
    upper.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    tidy(upper)
    tidy(lower)
    title = "Learning" if len(runs) == 1 else f"Learning: {len(runs)} runs"
    upper.set_title(title, fontsize=12, loc="left")
    return save(figure, file)


def returns(source: Any, file: str | Path | None = None, ax: Any = None) -> Figure:
    """Draw the return without exploring over interactions: of an EvalCallback, or of learn_many.

    Of many runs the line is the median, and the band holds half of them; thin lines are the worst and
    the best.
    """
    figure, axes = axes_of(ax, 7, 4)
    if hasattr(source, "evaluations"):
        means = np.array([evaluation.mean for evaluation in source.evaluations])
        axes.plot(source.interactions, means, color=BLUE, linewidth=2, marker="o", markersize=3.5)
    else:
        low, middle, high = np.percentile(source.returns, [25, 50, 75], axis=0)
        ends = (source.returns.min(axis=0), source.returns.max(axis=0))
        axes.fill_between(source.interactions, low, high, color=BLUE, alpha=0.25, linewidth=0)
        for edge in ends:
            axes.plot(source.interactions, edge, color=GREY, linewidth=0.8, linestyle=":")
        axes.plot(source.interactions, middle, color=BLUE, linewidth=2)
        text = f"median of {len(source.returns)} seeds, half of them in the band, worst and best dotted"
        axes.set_title(text, fontsize=10, loc="left")
    axes.set_xlabel("interactions")
    axes.set_ylabel("return without exploring")
    tidy(axes)
    return save(figure, file)


def splits(source: Source, file: str | Path | None = None, ax: Any = None) -> Figure:
    """Draw a disc for each split, by feature and learning step. Larger discs have smaller p-values.

    Needs ``tree``.
    """
    report = need(reports(source)[0], "tree")
    found = [node for node in report["tree"]["nodes"] if "test" in node]
    if not found:
        raise RunError("the tree has a single class: there is no split to draw")
    if "split" not in found[0]:
        raise RunError("the tree of a planner: its tests have no learning steps to draw")
    found.sort(key=lambda node: node["split"])
    tests: dict[str, int] = {}
    for node in found:
        tests.setdefault(explained(node["test"], report), len(tests))
    height = min(20.0, max(2.5, 0.3 * len(tests) + 1.2))
    figure, axes = axes_of(ax, 7.5, height)
    at: dict[tuple[int, int], int] = {}
    xs, ys, sizes = [], [], []
    for node in found:
        place = (node["step"], tests[explained(node["test"], report)])
        at[place] = at.get(place, 0) + 1
        xs.append(place[0] + 0.14 * (at[place] - 1))
        ys.append(place[1])
        sizes.append(18 + 12 * math.log1p(-node["log_p"]))
    axes.scatter(xs, ys, s=sizes, color=BLUE, alpha=0.75, edgecolors="white", linewidths=0.5)
    axes.set_yticks(range(len(tests)), list(tests), fontsize=9)
    axes.set_ylim(len(tests) - 0.4, -0.6)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    axes.set_xlabel("learning step k (splits of one step are side by side)")
    axes.set_title(f"{len(found)} splits, by feature", fontsize=12, loc="left")
    tidy(axes, grid="y")
    return save(figure, file)
