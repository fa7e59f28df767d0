# SPDX-License-Identifier: MIT
"""Every picture can be drawn from every source, as PNG and as SVG; and the command."""

import json
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import gymnasium
import numpy as np
import pytest
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure

import rlvc
import rlvc.envs
from rlvc import __main__ as command
from rlvc import errors, plot, report
from rlvc.cli import parser
from rlvc.plot import mazes

OF_BITS = ["maze", "values", "curve", "splits", "tree"]  # test_tiled.py has the others


@pytest.fixture(scope="module")
def env():
    return rlvc.envs.BinaryGridworld()


@pytest.fixture(scope="module")
def run(env):
    return rlvc.learn(env, 3000, seed=1, discount=0.9)


@pytest.fixture(scope="module")
def made(run, env):
    return json.loads(json.dumps(report.make(run, env)))


def test_the_command_knows_every_picture():
    assert tuple(plot.KINDS) == parser.FIGURES


@pytest.mark.parametrize("suffix", ["pdf", "png", "svg"])
@pytest.mark.parametrize("kind", OF_BITS)
def test_every_picture(made, kind, suffix, tmp_path):
    file = tmp_path / f"picture.{suffix}"
    plot.KINDS[kind](made, file)
    content = file.read_bytes()
    if suffix == "png":
        assert content.startswith(b"\x89PNG")
        assert len(content) > 5000
    elif suffix == "pdf":
        assert content.startswith(b"%PDF")
    else:
        assert ElementTree.fromstring(content).tag.endswith("svg")
        other = tmp_path / "again.svg"
        plot.KINDS[kind](made, other)
        assert other.read_bytes() == content


@pytest.mark.parametrize("kind", ["tree", "splits"])
def test_from_an_agent_and_a_run(run, kind, tmp_path):
    for source in (run, run.agent):
        plot.KINDS[kind](source, tmp_path / "picture.svg")
    with pytest.raises(errors.RunError, match="no maze"):
        plot.maze(run)
    for draw in (plot.tiles, plot.features):
        with pytest.raises(errors.RunError, match="the report has no"):
            draw(run)
    with pytest.raises(errors.RunError, match="no history"):
        plot.learning_curve(run.agent)


# ---------------------------------------------------------------- asked of a run


@pytest.fixture(scope="module")
def pole():
    return rlvc.learn(gymnasium.make("CartPole-v1"), 300, seed=1)


@pytest.fixture(scope="module")
def lake():
    return rlvc.learn(gymnasium.make("FrozenLake-v1", is_slippery=False), 300, seed=1)


HERE = [0.0, 0.1, 0.02, -0.1]
OF_A_RUN = [("regions", {}), ("regions", {"components": ["angle", "position"], "observation": HERE}),
            ("importances", {}), ("path", {"observation": HERE})]  # fmt: skip


def within(figure):
    """All type lies within the figure."""
    figure.canvas.draw()
    box = figure.get_tightbbox()
    width, height = figure.get_size_inches()
    return min(box.x0, box.y0) > -0.1 and box.x1 < width + 0.1 and box.y1 < height + 0.1


@pytest.mark.parametrize(("kind", "asked"), OF_A_RUN)
def test_pictures_of_a_run(pole, kind, asked, tmp_path):
    for suffix, begin in (("png", b"\x89PNG"), ("pdf", b"%PDF"), ("svg", b"<?xml")):
        file = tmp_path / f"picture.{suffix}"
        figure = pole.plot(kind, file, **asked)
        assert file.read_bytes().startswith(begin)
    assert within(figure)
    axes = Figure().subplots()
    assert pole.plot(kind, ax=axes, **asked) is axes.figure
    assert axes.has_data() or axes.texts


def test_regions_are_the_actions_that_are_taken(pole):
    figure = pole.plot("regions", components=["angle", "velocity"], observation=HERE)
    axes = figure.axes[0]
    filled = [c for c in axes.get_children() if isinstance(c, ContourSet) and c.filled]
    shown = [text.get_text() for text in axes.get_legend().get_texts()]
    assert shown[-1] == "seen"
    assert len(filled) == len(shown) - 1 > 1
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    told = 0
    for angle, velocity in np.random.default_rng(3).uniform((left, low), (right, high), (40, 2)):
        action = pole.predict(np.array([HERE[0], velocity, angle, HERE[3]], np.float32))
        there = [region.get_paths()[0].contains_point((angle, velocity)) for region in filled]
        told += shown[there.index(True)] == pole.actions.name(int(action))
    assert told >= 39  # a border is drawn between two points of three hundred


def test_importances_and_path_say_what_the_run_says(pole):
    axes = pole.plot("importances").axes[0]
    found = pole.importances()
    assert [label.get_text() for label in axes.get_yticklabels()] == list(found)
    assert [bar.get_width() for bar in axes.patches] == list(found.values())
    explained = pole.explain(HERE)
    shown = [text.get_text() for text in pole.plot("path", observation=HERE).axes[0].texts]
    for step in explained.steps:
        assert any(text.startswith(f"{step.test}?") for text in shown)
    assert explained.action_name in shown


def arrows(axes):
    """The arrows of a map: of each cell (x, y) the way that the arrow goes."""
    found = {}
    for text in axes.texts:
        if getattr(text, "arrow_patch", None) is not None:
            (x, y), (u, v) = text.xy, text.xyann
            found[int((x + u) / 2), int((y + v) / 2)] = (round(x - u), round(y - v))
    return found


WAYS = {
    "FrozenLake-v1": [(-1, 0), (0, 1), (1, 0), (0, -1)],
    "CliffWalking-v1": [(0, -1), (1, 0), (0, 1), (-1, 0)],
}


@pytest.mark.parametrize("task", list(WAYS))
def test_arrows_are_what_the_policy_does(task, tmp_path):
    env = gymnasium.make(task)
    run = rlvc.learn(env, 600, seed=1, epsilon=0.5)
    run.compact()
    figure = run.plot("grid", tmp_path / "grid.svg", env=env)
    assert within(figure)
    shown = arrows(figure.axes[0])
    width = 4 if task == "FrozenLake-v1" else 12
    assert len(shown) == (11 if task == "FrozenLake-v1" else 37)  # no holes, no cliff, no goal
    for (x, y), way in shown.items():
        assert way == WAYS[task][int(run.predict(y * width + x))], (x, y)


def test_taxi_has_a_board_for_each_ride():
    env = gymnasium.make("Taxi-v4")
    run = rlvc.learn(env, 300, seed=1)
    axes = Figure(figsize=(8, 9)).subplots()
    figure = run.plot("grid", env=env, ax=axes)
    assert within(figure)
    letters = [text.get_text() for text in axes.texts]
    assert letters.count("there already") == 4
    signs = letters.count("P") + letters.count("D")
    assert signs + sum(getattr(text, "arrow_patch", None) is not None for text in axes.texts) == 400


def test_what_a_run_cannot_draw(pole, lake, made, env):
    for kind in ("regions", "importances", "path", "grid"):
        with pytest.raises(errors.RunError, match=rf"{kind}: drawn of an rlvc\.Run"):
            plot.KINDS[kind](made)
    for call, said in [
        (lambda: lake.plot("regions"), "two components of real numbers"),
        (lambda: pole.plot("regions", components=["angle"]), "give two of position, velocity"),
        (lambda: pole.plot("path"), "give the observation"),
        (lambda: lake.plot("grid"), "give a FrozenLake"),
        (lambda: lake.plot("grid", env=env), "give a FrozenLake"),
        (lambda: pole.plot("grid", env=gymnasium.make("Taxi-v4")), "does not observe the number"),
    ]:
        with pytest.raises(errors.RunError, match=said):
            call()


def test_the_command_draws_a_saved_run(pole, lake, tmp_path, capsys):
    saved, frozen = str(tmp_path / "pole.rlvc"), str(tmp_path / "lake.rlvc")
    pole.save(saved)
    lake.save(frozen)
    drawn = str(tmp_path / "drawn.pdf")
    for arguments in (
        [saved, "regions", drawn, "--components", "angle,velocity", "--observation", json.dumps(HERE)],
        [saved, "importances", drawn], [saved, "path", drawn, "--observation", json.dumps(HERE)],
        [frozen, "grid", drawn, "--env", "FrozenLake-v1", "--env-arg", "is_slippery=False"],
    ):  # fmt: skip
        assert command.main(["plot", *arguments]) == 0
    for arguments, said in (
        ([saved, "tree", drawn, "--observation", "5"], "tree does not take it"),
        ([saved, "path", drawn, "--observation", "{"], "is not JSON"),
        ([frozen, "grid", drawn], "give a FrozenLake"),
    ):
        assert command.main(["plot", *arguments]) == 1
        assert said in capsys.readouterr().err


def test_into_axes_of_the_caller(made):
    for kind in ("values", "splits"):
        axes = Figure().subplots()
        assert plot.KINDS[kind](made, ax=axes) is axes.figure


def texts(figure):
    return {text.get_text() for axes in figure.axes for text in axes.texts}


def test_the_maze_shows_every_class(made):
    shown = texts(plot.maze(made))
    classes = {str(c) for row in made["cell_classes"] for c in row if c is not None}
    assert classes | {"exit"} <= shown


def test_nothing_is_cut(made):
    """All type lies within its figure, and cells' numbers within their cells."""
    for kind in ("maze", "values", "curve", "splits"):
        assert within(plot.KINDS[kind](made)), kind


def test_pale_colours_carry_black_type():
    for fraction in np.linspace(0, 1, 11):
        red, green, blue = mazes._pale(fraction)
        assert 0.2126 * red**2.2 + 0.7152 * green**2.2 + 0.0722 * blue**2.2 > 0.3


def test_a_log_is_learnt_in_one_step():
    """Its curve is a point, at a whole number of classes; returns while learning there are none."""
    record = {"step": 1, "interactions": 9, "classes": 2, "mean_return": None}
    upper, lower = plot.learning_curve({"version": 1, "history": [record]}).axes
    assert upper.lines[0].get_marker() == "o"
    assert all(float(tick).is_integer() for tick in upper.get_yticks())
    assert [text.get_text() for text in lower.texts] == ["no return is known"]


def test_several_runs(made):
    figure = plot.learning_curve({"version": 1, "runs": [made, made]})
    assert figure.axes[0].get_ylabel() == "classes"
    assert "2 runs" in figure.axes[0].get_title(loc="left")


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (None, "cannot be read"), ("{", "line 1: is not JSON"), ("[]", "is not the report"), ("{}", "is not the report"),
        ('{"version": 2}', "version 2"), ('{"version": 1, "runs": []}', "no run"),
        ('{"version": 1}', "no tree"),
    ],
)  # fmt: skip
def test_damaged_reports(tmp_path, content, said):
    file = tmp_path / "run.json"
    if content is not None:
        file.write_text(content, encoding="utf-8")
    with pytest.raises(errors.RunError, match=said):
        plot.tree(file)


def test_other_file_types(made, tmp_path):
    for kind in OF_BITS:
        with pytest.raises(errors.RunError, match=r"\.png, a \.svg or a \.pdf"):
            plot.KINDS[kind](made, tmp_path / "picture.jpg")


def test_a_tree_of_one_class():
    agent = rlvc.Agent(3, 2)
    assert "class 0" in plot.tree(agent).source
    with pytest.raises(errors.RunError, match="single class"):
        plot.splits(agent)


def test_the_leaf_of_a_policy_is_no_class():
    source = plot.tree(rlvc.Policy(rlvc.Agent(3, 2))).source
    assert "action 0" in source
    assert "class" not in source


def test_the_command_learns_and_draws(tmp_path, capsys):
    file, header = tmp_path / "run.json", tmp_path / "policy.h"
    assert command.main([
        "learn", "rlvc/BinaryGridworld-v0", "--interactions", "2000", "--discount", "0.9", "--quiet",
        "--episodes", "5", "--json", str(file), "--c", str(header),
    ]) == 0  # fmt: skip
    out = capsys.readouterr().out
    assert "mean return of 5 episodes" in out
    assert "policy_act" in header.read_text(encoding="utf-8")
    for kind in OF_BITS:
        assert command.main(["plot", str(file), kind, str(tmp_path / f"{kind}.svg")]) == 0


def test_the_command_learns_from_a_log(tmp_path, capsys):
    file = tmp_path / "log.csv"
    file.write_text("x,action,reward,terminated\n" + "1,0,0,1\n2,0,1,1\n" * 40, encoding="utf-8")
    assert command.main(["learn", "--log", str(file), "--columns", "x"]) == 0
    assert "x > 1.5?" in capsys.readouterr().out


@pytest.mark.parametrize(
    "arguments",
    [
        ["learn"], ["learn", "X-v0", "--log", "y.csv"], ["learn", "NoSuchThing-v0"],
        ["learn", "--log", "none.csv"], ["plot", "none.json", "tree", "x.png"],
        ["learn", "FrozenLake-v1", "--alpha", "7", "--interactions", "10"],
    ],
)  # fmt: skip
def test_errors_are_one_line(arguments, capsys):
    assert command.main([*arguments, *(["--quiet"] if arguments[0] == "learn" else [])]) == 1
    said = capsys.readouterr().err
    assert said.startswith("rlvc: ")
    assert said.count("\n") == 1


@pytest.mark.parametrize("arguments", [[], ["learn"], ["plot"], ["bench"]])
def test_help(arguments):
    done = subprocess.run(
        [sys.executable, "-m", "rlvc", *arguments, "--help"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.startswith("usage: python -m rlvc")
