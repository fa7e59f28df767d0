# SPDX-License-Identifier: MIT
"""What a program links of the two methods of learning, and that each of them works where it alone is built in. The core
is compiled as one file and not optimised: what is linked is the same, in a fifth of the time."""

import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FLAGS = ["gcc", "-std=c99", "-O0", "-ffp-contract=off", "-ffunction-sections", "-fdata-sections",
         f"-I{ROOT}/core/include", f"-I{ROOT}/examples/firmware", f"-I{ROOT}/examples/gridworld", "-DBALANCE_SHORT=1"]
SHARED = [ROOT / "examples/firmware/load.c", ROOT / "examples/firmware/port_host.c"]
EXAMPLES = {  # name: what it is made of, its method's number, what it must not link
    "firmware": ([*(ROOT / "examples/firmware").glob("r*.c"), ROOT / "examples/firmware/main.c",
                  *ROOT.glob("examples/gridworld/*.c")], 1, ("rlvc_planner_", "rlvc_planning_", "rlvc_dynamics_")),
    "balance": (list(ROOT.glob("examples/balance/*.c")), 2,
                ("rlvc_classes_", "rlvc_split_search_", "rlvc_value_iteration_", "rlvc_learner_")),
}


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    """The core as one file."""
    folder = tmp_path_factory.mktemp("source")
    subprocess.run([sys.executable, "-B", ROOT / "tools/packages/amalgamate.py", folder], check=True)
    return folder / "rlvc.c"


def compiled(folder, source, *flags):
    core = folder / "core.o"
    subprocess.run([*FLAGS, *flags, "-c", str(source), "-o", str(core)], check=True)
    return core


@pytest.fixture(scope="module")
def core_of_both(tmp_path_factory, source):
    return compiled(tmp_path_factory.mktemp("both"), source)


def built(folder, sources, core, *flags):
    """A program, of which the linker has left out what nothing names."""
    program = folder / "program"
    subprocess.run([*FLAGS, *flags, *map(str, [*sources, *SHARED, core]), "-Wl,--gc-sections", "-o", str(program)],
                   check=True)
    return program


def output(command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


@pytest.mark.parametrize("name", EXAMPLES)
def test_one_method_of_two(tmp_path, source, core_of_both, name):
    """Where both are built in, a program on bits links nothing of the planner, and one on numbers nothing of
    classes; where its own is alone, it learns the same."""
    sources, method, foreign = EXAMPLES[name]
    program = built(tmp_path, sources, core_of_both)
    symbols = output(["nm", program]).split()
    assert "rlvc_begin" in symbols
    assert [symbol for symbol in symbols if symbol.startswith(foreign)] == []
    both = output([program])
    alone = f"-DRLVC_METHODS={method}"
    assert output([built(tmp_path, sources, compiled(tmp_path, source, alone), alone)]) == both
