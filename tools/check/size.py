#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The size of the core on small machines: flash and RAM by what a program uses, code of each module, worst stack of
each public function, and the memory of the examples for microcontrollers. Compares with core/SIZE.md, or writes it
there with --write. Needs the compilers for ARM and RISC-V that tools/setup targets installs; where another one of the
first table is missing, its row stays as it is."""

import argparse
import concurrent.futures
import os
import pathlib
import re
import sys
import tempfile

import committed
import cross
import profiles
import stack
from committed import ROOT, sources

TABLE = ROOT / "core/SIZE.md"

FLASH_MAX = 18_000     # of the library in a lean learner on the M3
PLANNER_FLASH_MAX = 48 * 1024  # of a program that learns on numbers on the M4F
EXAMPLES = {  # name: heading, target, memory at most and stack set aside, a definition, sources
    "firmware": ("Learning the Binary Gridworld", "M3", 32 * 1024, 2048, "FIRMWARE_RETURNS=0",
                 ("main", "robot", "report")),
    "balance": ("Learning to balance a pole", "M4F", 128 * 1024, 4096, "BALANCE_SHORT=0",
                ("main", "cart_pole", "controller", "report")),
}
LEAN = ("-DRLVC_METHODS=1", "-DRLVC_SOLVERS=1", "-DRLVC_SCORES=1", "-DRLVC_CRITERIA=2", "-DRLVC_DOMAINS=2",
        "-DRLVC_ORACLES=1", "-DRLVC_DEPENDENCES=1", "-DRLVC_EFFECTS=1",
        "-DRLVC_DISCOUNTS=1", "-DRLVC_AT_ONCE=0", "-DRLVC_STARTS=0")  # what a controller uses, one of each
HELPER_STACK = 64      # granted to a function of the compiler's own library
STACK_TARGETS = ("M0", "M3", "M4F", "rv32imac")


def compile_modules(folder):
    """Each source on the M3, with no more built in than a controller uses, by module."""
    folder.mkdir()

    def one(source):
        file = folder / f"{source.parent.name}_{source.stem}.o"
        cross.compile_c("M3", source, file, "-Os", *LEAN)
        return f"{source.parent.name}/{source.stem}", file

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return dict(pool.map(one, sources()))


# What a compiler brings along where the processor has no such instruction.
HELPERS = """
#include <stdint.h>
#include <string.h>
volatile float x, y;
volatile int32_t i;
volatile uint32_t u;
volatile int64_t l;
volatile uint64_t v;
char text[99];
int main(void) {
    x = x + y; x = x - y; x = x * y; x = x / y;
    i = x < y; i = x > y; i = x <= y; i = x >= y; i = x == y;
    x = (float)i; x = (float)u; x = (float)l; x = (float)v;
    i = (int32_t)x; u = (uint32_t)x;
    i = i / (int32_t)u; u = u % (uint32_t)i; v = v / u; v = v * v; v = v << i; v = v >> i;
    memcpy(text, text + u, u); memset(text, 0, u); memmove(text, text + u, u);
    return memcmp(text, text + u, u);
}
"""


def lean_learner(modules, folder):
    """Bytes of flash that the library takes of a program that learns by bits on the M3."""
    functions = profiles.PROFILES["learner on bits"].functions
    whole, _ = cross.link("M3", profiles.EMPTY, functions, modules.values(), folder / "lean.elf")
    helpers, _ = cross.link("M3", HELPERS, (), (), folder / "helpers.elf")
    return whole - helpers


def image_memory(name, library, folder):
    """Static memory of an example: the whole, and of that the block."""
    _, target, ram, stack_bytes, definition, parts = EXAMPLES[name]
    compiler, options = cross.TARGETS[target]
    image = folder / f"{name}.elf"
    shared = ROOT / "examples/firmware"
    cross.run(compiler, *options, *cross.FLAGS, "-O2", f"-D{definition}", f"-I{shared}", f"-I{ROOT}/examples/gridworld",
              "--crt0=semihost", "--oslib=semihost", "-Wl,--gc-sections",
              "-Wl,--defsym=__flash=0", "-Wl,--defsym=__flash_size=0x400000",
              "-Wl,--defsym=__ram=0x20000000", f"-Wl,--defsym=__ram_size={ram}",
              f"-Wl,--defsym=__stack_size={stack_bytes}",
              *[ROOT / f"examples/{name}/{part}.c" for part in parts], shared / "load.c", shared / "port_bare.c",
              *(ROOT / "examples/gridworld").glob("*.c"), library, "-o", image)
    block = 0
    for line in cross.run(compiler.removesuffix("gcc") + "nm", "-S", image).splitlines():
        if re.search(r" b block$", line):
            block = int(line.split()[1], 16)
    sizes = cross.sections(target, image)
    return sum(sizes[kind] for kind in cross.IN_RAM), block


class Stack(stack.Graph):
    """The call graph on a target; a helper of the compiler's library is granted HELPER_STACK."""

    def __init__(self, library):
        super().__init__([], [], None)
        self.read(library.with_suffix(".ci").read_text(encoding="utf-8"))

    def worst(self, title):
        if title not in self.functions and title not in stack.EXTERNAL:
            return HELPER_STACK, None
        return super().worst(title)


def module_table(modules):
    yield "| module | code | const |"
    yield "|---|--:|--:|"
    totals = [0, 0]
    for name, file in modules.items():
        sizes = cross.sections("M3", file)
        data = sum(sizes[kind] for kind in cross.IN_RAM)
        if data != 0:
            raise SystemExit(f"{name} has {data} bytes of writable data")
        row = [sizes["text"], sizes["rodata"]]
        totals = [a + b for a, b in zip(totals, row)]
        yield f"| `{name}` | " + " | ".join(f"{n:,}" for n in row) + " |"
    yield "| all | " + " | ".join(f"{n:,}" for n in totals) + " |"


def stack_table(measured):
    graphs = [Stack(measured[target].library) for target in STACK_TARGETS]
    yield "| function | " + " | ".join(STACK_TARGETS) + " |"
    yield "|---|" + "--:|" * len(STACK_TARGETS)
    for name in stack.public_functions():
        yield f"| `{name}` | " + " | ".join(str(graph.worst(name)[0]) for graph in graphs) + " |"


def memory_table(name, library, folder):
    heading, target, ram, stack_bytes, _, _ = EXAMPLES[name]
    memory, block = image_memory(name, library, folder)
    yield f"""
## Memory of the {name} example

{heading} on the {target}, in an image that is linked for {ram:,} bytes of memory:

| what | bytes |
|---|--:|
| the learner's block | {block:,} |
| other static data, of the example and of its C library | {memory - block:,} |
| stack set aside (measured: less than that) | {stack_bytes:,} |
| all | {memory + stack_bytes:,} |"""
    if memory + stack_bytes > ram:
        raise SystemExit(f"too large: {memory + stack_bytes} bytes of memory of {name}")


def table(folder, compilers, before, write):
    rows = profiles.committed_rows(before)
    measured = profiles.measure_all(folder, list(profiles.measurable(rows, write)))
    modules = compile_modules(folder / "lean")
    lean = lean_learner(modules, folder)
    yield f"""# Size on microcontrollers

{compilers}; bytes, by -Os.
Written by `tools/check/size.py --write`; the stage `targets` of the tests fails when it is stale. No module
has writable data.

## By what a program uses

Flash is code, constants and what the compiler brings along where the processor lacks an instruction (floating
point, division), beyond those of a program that does nothing; RAM is static memory, to which the stack
comes (below). The library is compiled as one file (tools/packages/amalgamate.py), with everything built in,
and the linker drops what is not called.

- **policy**: acts by a tree that was learnt elsewhere (`rlvc_planner_policy_of`, `rlvc_policy_act`). Exported as C
  a policy needs nothing of the library.
- **learner on bits** (`rlvc/agent.h`): 3 bits, 2 actions, 200 interactions, 10 classes.
- **learner on numbers** (`rlvc/planner.h`): 2 components, 2 actions, 200 interactions, 4 leaves of a model.

A learner carries its method whole, with what saves and loads it (core/src/base/method.h), and not the other one;
where one method alone is built in, what is not called is left out of it too (below).

More interactions and classes need more RAM and no more flash. Constants lie in RAM, too, on the AVR (an
ATmega1284P, whose 16 KiB are too few for the learner on numbers) and in WebAssembly. On the M4F the learner on
numbers may take {PLANNER_FLASH_MAX:,} of flash. The check measures a machine only if its compiler is installed
and is the one of its row; else it names the machine and passes over it.
"""
    yield from profiles.table(measured, rows)
    yield f"""
## A lean learner

Built with one method, classes, one solver, value iteration, one score, the information gain, and one criterion, the residual
(`{' '.join(LEAN)}`,
core/src/base/solver_select.h), the library takes {lean:,} of the flash of a program that learns by bits on the
M3, and may take {FLASH_MAX:,}. Its modules, before the linker leaves out what is not called:
"""
    yield from module_table(modules)
    for name, example in EXAMPLES.items():
        yield from memory_table(name, measured[example[1]].library, folder)
    yield f"""
## Worst stack

The callbacks that a function calls are not counted; {HELPER_STACK} are granted to each helper of a compiler's
library. Everything is built in.
"""
    yield from stack_table(measured)
    planner = measured["M4F"].sizes["learner on numbers"][0]
    if lean > FLASH_MAX or planner > PLANNER_FLASH_MAX:
        raise SystemExit(f"too large: {lean} bytes of flash of a lean learner, {planner} of a learner on numbers")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="write core/SIZE.md")
    arguments = parser.parse_args()
    needed = [cross.ARM[0], cross.RISCV[0]]
    missing = [compiler for compiler in needed if cross.missing(compiler)]
    if missing:
        print("skipped: there is no " + ", ".join(missing))
        return committed.SKIPPED
    compilers = " and ".join(cross.named(compiler) for compiler in needed)
    before = TABLE.read_text(encoding="utf-8") if TABLE.exists() else ""
    if not arguments.write and f"\n{compilers};" not in before:
        print(f"the figures are not compared: they are of other compilers than {compilers}")
        return committed.SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        text = "\n".join(table(pathlib.Path(folder), compilers, before, arguments.write)) + "\n"
    return committed.settle(TABLE, text, f"\n{compilers};", arguments.write)


if __name__ == "__main__":
    sys.exit(main())
