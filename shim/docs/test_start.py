# SPDX-License-Identifier: MIT
"""The ways in that the front page promises, from a fresh clone: at most five commands each, run as they stand there."""

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


def test_there_are_two():
    assert len(WAYS) == 2


@pytest.mark.parametrize("commands", WAYS, ids=["an environment of one's own", "C on a board"])
def test_way(clone, commands):
    assert len(commands.splitlines()) <= 5
    # Without what sees pictures, which takes longest to compile.
    environment = {**os.environ, "SKBUILD_CMAKE_DEFINE": "RLVC_VISION=OFF"}
    environment.pop("RLVC_PYTHON_LIBRARY", None)
    done = subprocess.run(["bash", "-eux", "-c", commands], cwd=clone, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    if "own_environment" in commands:
        assert float(re.search(r"mean return: (\S+)", done.stdout)[1]) > -12
    else:
        assert re.search(r"\n\s+\d+\s+0\s+", done.stdout), "the policy has constants, and no data in RAM"
