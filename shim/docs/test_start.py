# SPDX-License-Identifier: MIT
"""The ways in that the front page promises, from a fresh clone: at most five commands each, run as they stand there.

Commands that two ways have in common run once, as both go on from the same state."""

import os
import pathlib
import re
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = (ROOT / "shim/docs/index.md").read_text(encoding="utf-8")
WAYS = re.findall(r"^```sh\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)


@pytest.fixture
def clone(tmp_path):
    """The files that git knows of, as they are now."""
    names = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT,
                           capture_output=True, check=True).stdout  # fmt: skip
    subprocess.run(["tar", "--null", "-T", "-", "-cf", tmp_path / "all.tar"], cwd=ROOT, input=names, check=True)
    subprocess.run(["tar", "-xf", "all.tar"], cwd=tmp_path, check=True)
    return tmp_path


def run(commands, clone):
    # Without what sees pictures, which takes longest to compile.
    environment = {**os.environ, "SKBUILD_CMAKE_DEFINE": "RLVC_VISION=OFF"}
    environment.pop("RLVC_PYTHON_LIBRARY", None)
    done = subprocess.run(["bash", "-eux", "-c", "\n".join(commands)], cwd=clone, env=environment, capture_output=True,
                          text=True)  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_ways(clone):
    environment, board = (way.splitlines() for way in WAYS)
    assert max(len(environment), len(board)) <= 5
    printed = run(environment, clone)
    assert float(re.search(r"mean return: (\S+)", printed)[1]) > -12
    assert board[:2] == environment[:2]
    printed = run(board[2:], clone)
    assert re.search(r"\n\s+\d+\s+0\s+", printed), "the policy has constants, and no data in RAM"
