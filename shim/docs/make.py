#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the parts of the documentation that are generated: the pictures, and the page of C.

    make.py FOLDER

copies the pages into the folder, puts the examples in where a page asks for them (<<< FILE:LINE, from
that line on), draws the pictures and writes c.md from the headers.
"""

import pathlib
import re
import subprocess
import sys

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

import rlvc
import rlvc.envs
from rlvc import plot, report
from rlvc.plot import mazes
from rlvc.plot.drawing import tidy

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BLUE, ORANGE, GREY = "#0072B2", "#D55E00", "#9a9a9a"
INCLUDE = re.compile(r"^<<< (.*):(\d+)$", re.MULTILINE)


def pages(folder):
    for page in HERE.rglob("*.md"):
        text = page.read_text(encoding="utf-8")

        def included(match):
            lines = (ROOT / match[1]).read_text(encoding="utf-8").splitlines()
            return "\n".join(lines[int(match[2]) - 1 :]).strip()

        made = folder / page.relative_to(HERE)
        made.parent.mkdir(exist_ok=True)
        made.write_text(INCLUDE.sub(included, text), encoding="utf-8")


def c_page(folder):
    parts = [
        "# C\n\nThe headers are the reference.\n"
    ]
    headers = [*sorted((ROOT / "core/include/rlvc").glob("*.h")), ROOT / "vision/include/rlvc/vision.h"]
    for header in headers:
        text = header.read_text(encoding="utf-8").rstrip()
        parts.append(f"\n## rlvc/{header.name}\n\n```c\n{text}\n```\n")
    (folder / "c.md").write_text("".join(parts), encoding="utf-8")


def save(figure, file):
    with mpl.rc_context({"svg.hashsalt": "rlvc"}):
        figure.savefig(file, bbox_inches="tight", metadata={"Date": None})


def visits(env, count):
    """A random walk: the percepts, actions, rewards, s', ends and cells of its interactions."""
    random = np.random.default_rng(4)
    observation, info = env.reset(seed=4)
    rows = []
    for _ in range(count):
        action = int(random.integers(4))
        following, reward, over, _, after = env.step(action)
        rows.append((observation, action, reward, following, over, (info["x"], info["y"])))
        observation, info = env.reset() if over else (following, after)
    return rows


def draw_visits(env, rows, file):
    table = np.zeros((env.maze.height, env.maze.width))
    for row in rows:
        table[row[5][1], row[5][0]] += 1
    figure = Figure(figsize=(6, 4), layout="constrained")
    axes = figure.subplots()
    mazes.board(axes, env.maze.rows, f"{len(rows)} interactions, by cell")
    extent = (0, env.maze.width, env.maze.height, 0)
    shown = axes.imshow(table, cmap="cividis", extent=extent, zorder=0)
    figure.colorbar(shown, ax=axes, label="interactions", shrink=0.8)
    save(figure, file)


def draw_returns(rows, bit, file):
    """Step 3: what moving up was worth in class 0, once one value is known: that of the exit."""
    up = [(row[2], row[0][bit]) for row in rows if row[1] == 0]
    figure = Figure(figsize=(6, 2.8), layout="constrained")
    axes = figure.subplots()
    values = [[r for r, present in up if present == side] for side in (0, 1)]
    bins = np.linspace(-5, 105, 12)
    axes.hist(values, bins=bins, color=[GREY, BLUE], label=["bit 3 absent", "bit 3 present"])
    axes.set_yscale("log")
    axes.set_ylim(bottom=0.8)  # a single interaction is visible
    axes.set_xlabel("reward of moving up in class 0")
    axes.set_ylabel("interactions")
    axes.legend(frameon=False)
    tidy(axes, grid="y")
    save(figure, file)


def entropy(share):
    share = np.clip(share, 1e-12, 1 - 1e-12)
    return -(share * np.log2(share) + (1 - share) * np.log2(1 - share))


def gains(rows):
    """The information gain of each bit for the partition at the one cutpoint, when moving up."""
    up = [row for row in rows if row[1] == 0]
    above = np.array([row[2] > 50 for row in up])
    bits = np.array([row[0] for row in up]).astype(bool)
    found = []
    for column in bits.T:
        inside = sum(
            np.mean(column == side) * entropy(above[column == side].mean())
            for side in (False, True)
        )
        found.append(entropy(above.mean()) - inside)
    return np.array(found)


def draw_gains(found, file):
    figure = Figure(figsize=(6, 2.8), layout="constrained")
    axes = figure.subplots()
    colours = [GREY if 4 <= bit <= 14 else BLUE for bit in range(18)]
    bars = axes.bar(range(18), 1000 * found, color=colours)
    for bit in range(4, 15):
        bars[bit].set_hatch("///")
    axes.set_xticks(range(18))
    axes.set_xlabel("bit (hatched: irrelevant)")
    axes.set_ylabel("gain (thousandths of a bit)")
    tidy(axes, grid="y")
    save(figure, file)


def pictures(folder):
    env = rlvc.envs.BinaryGridworld()
    stages = {}

    def look(run):
        stages[run.history[-1].interactions] = report.make(run, env)

    run = rlvc.learn(env, 2500, every=100, seed=1, discount=0.9)
    final = report.make(run, env)
    for kind in ("maze", "values", "curve", "splits", "tree"):
        plot.KINDS[kind](final, folder / f"{kind}.svg")
    # The page that explains the method goes by rewards alone.
    alone = {"seed": 1, "discount": 0.9, "successors": False}
    rlvc.learn(env, 100, every=100, callback=look, **alone)
    small = rlvc.learn(env, 3000, classes=4, **alone)
    plot.maze(next(iter(stages.values())), folder / "step1.svg")
    rows = visits(rlvc.envs.BinaryGridworld(), 3000)
    draw_visits(env, rows, folder / "step2.svg")
    draw_returns(rows, 3, folder / "step3.svg")
    draw_gains(gains(rows), folder / "step4.svg")
    plot.maze(report.make(small, env), folder / "step5.svg")
    plot.maze(final, folder / "step6.svg")


def tiled(folder):
    """What the example draws of the Tiled Gridworld; needs the vision module."""
    example = ROOT / "examples/06_tiled_figures.py"
    subprocess.run([sys.executable, example, folder], check=True, stdout=subprocess.DEVNULL)


def main():
    folder = pathlib.Path(sys.argv[1])
    (folder / "pictures").mkdir(parents=True, exist_ok=True)
    pages(folder)
    c_page(folder)
    pictures(folder / "pictures")
    tiled(folder / "pictures")


if __name__ == "__main__":
    main()
