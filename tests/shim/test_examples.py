# SPDX-License-Identifier: MIT
"""The examples run, and the README shows the one it says it shows."""

import os
import re
import subprocess
import sys

import pytest
from conftest import ROOT, without_vision

EXAMPLES = sorted((ROOT / "examples").glob("[0-9][0-9]_*.py"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example(example, tmp_path):
    if any(word in example.stem for word in ("tiled", "grasp", "frames")) and without_vision():
        pytest.skip(without_vision())
    if "fleet" in example.stem:
        pytest.importorskip("ray")
    home = {**os.environ, "HOME": str(tmp_path.parent)}  # a cluster keeps its token there
    done = subprocess.run(
        [sys.executable, str(example)], cwd=tmp_path, capture_output=True, text=True, timeout=300, env=home
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout
    drawn = {path.name for path in tmp_path.iterdir()}
    if "maze_figures" in example.stem:
        assert {
            "maze.png",
            "maze.svg",
            "tree.svg",
            "values.png",
            "curve.png",
            "splits.png",
        } <= drawn
    if "tiled_figures" in example.stem:
        assert {"tiles.png", "tiles.svg", "features.png", "features.svg"} == drawn
        assert float(done.stdout.split()[2]) >= 95
    if "grasp" in example.stem:
        assert done.stdout.splitlines()[-1].endswith("held-out grasps: 1.000")
    if "frames" in example.stem:
        right, tried = re.search(r"(\d+) of (\d+) new frames", done.stdout).groups()
        assert int(right) >= 0.95 * int(tried)
    if "lake" in example.stem:
        assert float(done.stdout.split("mean return:")[1]) >= 0.7
    if "fleet" in example.stem:
        assert "20000 interactions" in done.stdout
        assert float(done.stdout.split("mean return:")[1]) >= 0.7
    if "cart_pole" in example.stem:
        assert float(re.search(r"mean return: (.*)", done.stdout)[1]) >= 475
        assert drawn == {"balance.rlvc"}
    if "log" in example.stem:
        answers = re.findall(r"(heat|wait)$", done.stdout, re.MULTILINE)
        assert answers[0] == "heat"
        assert answers[-1] == "wait"


def test_the_readme_shows_the_example():
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    example = (ROOT / "examples/02_frozen_lake.py").read_text(encoding="utf-8")
    match = re.search(r"^```python\n(.*?)^```$", readme, re.MULTILINE | re.DOTALL)
    assert match, "README.md has no Python program"
    assert match[1] == example[example.index("import gymnasium") :]
