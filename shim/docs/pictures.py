#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the pictures of the documentation, which are committed: pictures.py [FOLDER]

FOLDER is that of the committed ones by default. Text stays text, so that the files are small. Needs a package
that was made where OpenCV is."""

import base64
import io
import pathlib
import re
import sys

import gymnasium
import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from PIL import Image
from scour import scour

import rlvc
import rlvc.envs
from rlvc import plot, report, vision
from rlvc.plot import mazes
from rlvc.plot.drawing import tidy

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BLUE, ORANGE, GREY = "#0072B2", "#D55E00", "#9a9a9a"
# Without text as outlines, and the same text at each run.
STYLE = {"svg.fonttype": "none", "svg.hashsalt": "rlvc", "font.family": "sans-serif"}


def save(figure, file):
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
    for kind in ("maze", "values", "curve", "splits"):
        save(plot.KINDS[kind](final), folder / f"{kind}.svg")
    plot.tree(final, folder / "tree.svg")
    # The page that explains the method goes by rewards alone.
    alone = {"seed": 1, "discount": 0.9, "successors": False}
    rlvc.learn(env, 100, every=100, callback=look, **alone)
    small = rlvc.learn(env, 3000, classes=4, **alone)
    save(plot.maze(next(iter(stages.values()))), folder / "step1.svg")
    rows = visits(rlvc.envs.BinaryGridworld(), 3000)
    draw_visits(env, rows, folder / "step2.svg")
    draw_returns(rows, 3, folder / "step3.svg")
    draw_gains(gains(rows), folder / "step4.svg")
    save(plot.maze(report.make(small, env)), folder / "step5.svg")


def tiled(folder):
    """The Tiled Gridworld, as examples/06_tiled_figures.py learns it; needs the vision module."""
    env = rlvc.envs.TiledGridworld(rlvc.envs.SMALL, placement=1)
    metric = vision.Metric.fit(
        env.objects.pictures[:, 0], sigma=4.0, form="int8", normalise=True, share=0.035
    )
    eye = vision.Eye(vision.Extractor(metric=metric))
    run = rlvc.learn(env, 1000, encoder=eye, every=500, seed=1, discount=0.9)
    made = report.make(run, env)
    save(plot.tiles(made, objects=env.objects), folder / "tiles.svg")
    save(plot.features(made, objects=env.objects), folder / "features.svg")


def policies(folder):
    """The policies of the guide: over two components, and on a map."""
    pole = rlvc.learn(gymnasium.make("CartPole-v1"), 2000, seed=1)
    save(pole.plot("regions"), folder / "regions.svg")
    env = gymnasium.make("CliffWalking-v1")
    save(rlvc.learn(env, 8000, seed=1).plot("grid", env=env), folder / "cliff.svg")


def learners(folder):
    """RESULTS.md's comparison of learners in Sutton's maze, as bars."""
    text = (ROOT / "RESULTS.md").read_text(encoding="utf-8")
    table = text[text.index("| learner | sees | optimal after |") :].split("\n\n")[0]
    lines = table.replace("`", "").splitlines()[2:]
    rows = [[cell.strip(" *") for cell in line.strip("|").split("|")] for line in lines]
    figure = Figure(figsize=(7, 0.42 * len(rows) + 0.9), layout="constrained")
    axes = figure.subplots()
    for y, (name, _, after) in enumerate(rows):
        number = re.match(r"[\d,]+", after)
        length = int(number[0].replace(",", "")) if number else 2500
        axes.barh(y, length, color=BLUE if "rlvc" in name else GREY, hatch="" if number else "//")
        axes.text(length + 25, y, after, va="center", fontsize=9)
    axes.set_yticks(range(len(rows)), [f"{name} ({sees})" for name, sees, _ in rows], fontsize=9)
    axes.invert_yaxis()
    axes.set_xlim(0, 3900)
    axes.set_xlabel("interactions until the policy is optimal (median of 20 runs)")
    tidy(axes, grid="x")
    save(figure, folder / "learners.svg")


def smaller(match):
    """A picture within a drawing, with few pixels and colours."""
    picture = Image.open(io.BytesIO(base64.b64decode(match[1].replace("\n", ""))))
    picture.thumbnail((56, 56))
    alpha = picture.convert("RGBA").getchannel("A").getextrema()[0] < 255
    made = io.BytesIO()
    (picture if alpha else picture.convert("RGB").quantize(24)).save(made, "PNG", optimize=True)
    return f"data:image/png;base64,{base64.b64encode(made.getvalue()).decode()}"


def shrink(file):
    text = re.sub(r"data:image/png;base64,([A-Za-z0-9+/=\s]+)", smaller, file.read_text(encoding="utf-8"))
    options = scour.sanitizeOptions()
    options.digits, options.enable_viewboxing, options.strip_ids, options.newlines = 4, True, True, False
    file.write_text(scour.scourString(text, options), encoding="utf-8")


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "pictures"
    with mpl.rc_context(STYLE):
        pictures(folder)
        policies(folder)
        learners(folder)
        tiled(folder)
    for file in folder.glob("*.svg"):
        shrink(file)


if __name__ == "__main__":
    main()
