# SPDX-License-Identifier: MIT
"""Every picture can be drawn from every source, as PNG and as SVG; and the command."""

import json
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

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


def texts(figure):
    return {text.get_text() for axes in figure.axes for text in axes.texts}


def test_the_maze_shows_every_class(made):
    shown = texts(plot.maze(made))
    classes = {str(c) for row in made["cell_classes"] for c in row if c is not None}
    assert classes | {"exit"} <= shown


def test_nothing_is_cut(made):
    """All type lies within its figure, and cells' numbers within their cells."""
    for kind in ("maze", "values", "curve", "splits"):
        figure = plot.KINDS[kind](made)
        figure.canvas.draw()
        box = figure.get_tightbbox()
        width, height = figure.get_size_inches()
        assert box.x0 > -0.1 and box.y0 > -0.1, kind
        assert box.x1 < width + 0.1 and box.y1 < height + 0.1, kind


def test_pale_colours_carry_black_type():
    for fraction in np.linspace(0, 1, 11):
        red, green, blue = mazes._pale(fraction)
        assert 0.2126 * red**2.2 + 0.7152 * green**2.2 + 0.0722 * blue**2.2 > 0.3


def test_several_runs(made):
    figure = plot.learning_curve({"version": 1, "runs": [made, made]})
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
