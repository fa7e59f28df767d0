# SPDX-License-Identifier: MIT
"""What the tests of the Python package share."""

import pathlib
import subprocess
import sys

import hypothesis
import hypothesis.configuration
import numpy as np
import pytest

import rlvc

ROOT = pathlib.Path(__file__).resolve().parents[2]

hypothesis.configuration.set_hypothesis_home_dir(ROOT / "build/hypothesis")
hypothesis.settings.register_profile("fixed", derandomize=True, deadline=None, database=None)
hypothesis.settings.load_profile("fixed")


def without_vision():
    """Why the package has no vision module; empty if it has one."""
    try:
        import rlvc.vision  # noqa: F401
    except ImportError as error:
        return str(error)
    return ""


@pytest.fixture(scope="session")
def caller(tmp_path_factory):
    """The C program that makes the calls it reads, linked with a core of its own."""
    folder = tmp_path_factory.mktemp("caller")
    program = folder / "caller"
    subprocess.run([sys.executable, ROOT / "tools/packages/amalgamate.py", folder], check=True)
    subprocess.run(
        ["gcc", "-std=c99", "-O0", "-ffp-contract=off", f"-I{ROOT / 'core/include'}", "-o", program,
         pathlib.Path(__file__).with_name("caller.c"), folder / "rlvc.c"],
        check=True,
    )  # fmt: skip
    return program


@pytest.fixture
def acts_of_export(tmp_path):
    """What the C of an agent on vectors does at packed percepts, by gcc."""
    program = """
        #include "seen.h"
        #include <stdio.h>
        int main(void) {
            static uint32_t percept[WORDS];
            while (fread(percept, sizeof percept, 1, stdin) == 1)
                putchar((int)seen_act(percept) + '0');
            return 0;
        }"""

    def run(agent, records):
        (tmp_path / "seen.h").write_text(agent.export_c("seen"), encoding="utf-8")
        subprocess.run(
            ["gcc", "-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-ffp-contract=off",
             f"-I{tmp_path}", f"-DWORDS={len(records[0]) // 4}", "-o", tmp_path / "seen",
             "-x", "c", "-"],
            input=program, text=True, check=True,
        )  # fmt: skip
        done = subprocess.run(
            [tmp_path / "seen"], input=b"".join(records), capture_output=True, check=True
        )
        return [int(c) for c in done.stdout.decode()]

    return run


@pytest.fixture
def walk():
    """Makes an agent that walked along cells 0 to 7, of which 5 pays 1."""

    def make(domain=3, **config):
        agent = rlvc.Agent(domain, 2, epsilon=1.0, **config)
        cell = 7
        agent.begin(np.array([cell], np.uint8))
        for _ in range(400):
            choice = agent.act()
            cell = min(cell + 1, 7) if choice.action else max(cell - 1, 0)
            percept = np.array([cell], np.uint8)
            agent.observe(choice, float(cell == 5), percept, terminated=cell == 5)
            if cell == 5:
                cell = 7 if agent.statistics.interactions % 2 else 0
                agent.begin(np.array([cell], np.uint8))
        return agent

    return make
