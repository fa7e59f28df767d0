#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The size of the core on microcontrollers: code and constant data of each module, worst stack of each
public function, and the memory of the examples for microcontrollers. Compares with core/SIZE.md, or writes it there
with --write. Needs the compilers that tools/setup targets installs."""

import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import committed
import stack
from committed import ROOT, sources

TABLE = ROOT / "core/SIZE.md"

TARGETS = {  # name: prefix, options of the processor
    "M0": ("arm-none-eabi-", ["-mthumb", "-mcpu=cortex-m0"]),
    "M3": ("arm-none-eabi-", ["-mthumb", "-mcpu=cortex-m3"]),
    "M4F": ("arm-none-eabi-", ["-mthumb", "-mcpu=cortex-m4", "-mfloat-abi=hard",
                               "-mfpu=fpv4-sp-d16"]),
    "rv32imac": ("riscv64-unknown-elf-", ["-march=rv32imac", "-mabi=ilp32"]),
}
PICOLIBC = "--specs=picolibc.specs"
FLAGS = ["-std=c99", "-ffp-contract=off", "-ffunction-sections", "-fdata-sections", PICOLIBC]
BARE = ["--crt0=minimal", "-Wl,--gc-sections", "-Wl,--defsym=__flash=0x80000000",
        "-Wl,--defsym=__flash_size=0x200000", "-Wl,--defsym=__ram=0x80200000",
        "-Wl,--defsym=__ram_size=0x10000"]  # an image that has nothing but what it needs
FLASH_MAX = 18_000     # of the library without printing on the M3, by -Os
PLANNER_FLASH_MAX = 48 * 1024  # of the library in a program that plans on the M4F, by -Os
EXAMPLES = {  # name: heading, target, memory at most and stack set aside, a definition, sources
    "firmware": ("Learning the Binary Gridworld", "M3", 32 * 1024, 2048, "FIRMWARE_RETURNS=0",
                 ("main", "robot", "report")),
    "balance": ("Learning to balance a pole", "M4F", 128 * 1024, 8192, "BALANCE_SHORT=0",
                ("main", "cart_pole", "controller", "report")),
}
LEVELS = ("-O2", "-Os", "-Os -flto")
LEAN = ("-DRLVC_SOLVERS=1", "-DRLVC_SCORES=1", "-DRLVC_CRITERIA=2", "-DRLVC_ORACLES=1",
        "-DRLVC_DEPENDENCES=1")  # what a controller uses, one of each
HELPER_STACK = 64      # granted to a function of the compiler's own library


def run(*command):
    return subprocess.run([str(part) for part in command], check=True, stdout=subprocess.PIPE,
                          text=True).stdout


def compile_core(target, level, folder, *definitions):
    prefix, options = TARGETS[target]
    folder.mkdir(exist_ok=True)

    def compile_one(source):
        name = f"{source.parent.name}/{source.stem}"
        file = folder / f"{target}{level}_{source.parent.name}_{source.stem}.o"
        run(prefix + "gcc", *FLAGS, *options, *level.split(), *definitions, "-fstack-usage", "-fcallgraph-info=su",
            f"-I{ROOT}/core/include", "-c", source, "-o", file)
        return name, file

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return dict(pool.map(compile_one, sources()))


def sections(prefix, file):
    """(code, constants, writable data) in bytes."""
    totals = [0, 0, 0]
    for line in run(prefix + "size", "-A", "-d", file).splitlines():
        match = re.match(r"\.(\S+)\s+(\d+)\s", line)
        if not match:
            continue
        kind = match[1].split(".")[0]
        if kind in ("text", "init"):
            totals[0] += int(match[2])
        elif kind in ("rodata", "srodata"):
            totals[1] += int(match[2])
        elif kind in ("data", "bss", "sdata", "sbss"):
            totals[2] += int(match[2])
    return totals


# Everything that learning a maze of bits takes, and nothing of printing.
LEARNER = """
#include <rlvc/agent.h>
#include <rlvc/bits.h>
void *volatile keep[] = {(void *)rlvc_bits_domain, (void *)rlvc_config_default,
    (void *)rlvc_agent_size, (void *)rlvc_agent_init, (void *)rlvc_begin, (void *)rlvc_act,
    (void *)rlvc_observe, (void *)rlvc_learn, (void *)rlvc_predict, (void *)rlvc_stats,
    (void *)rlvc_q, (void *)rlvc_value, (void *)rlvc_split_at};
int main(void) { return keep[0] == 0; }
"""

# Everything that learning on real numbers takes, and nothing of printing.
PLANNER = """
#include <rlvc/planner.h>
void *volatile keep[] = {(void *)rlvc_planner_default, (void *)rlvc_planner_size, (void *)rlvc_planner_init,
    (void *)rlvc_planner_begin, (void *)rlvc_planner_act, (void *)rlvc_planner_observe,
    (void *)rlvc_planner_learn, (void *)rlvc_planner_budget_min, (void *)rlvc_planner_predict,
    (void *)rlvc_planner_node, (void *)rlvc_planner_stats};
int main(void) { return keep[0] == 0; }
"""


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


def linked(target, level, objects, folder):
    """Bytes of flash that the library takes of a program that learns by bits and of one that plans, and that the
    compiler's helpers take."""
    prefix, options = TARGETS[target]
    flash = {}
    for name, text, parts in (("empty", "int main(void) { return 0; }", []), ("helpers", HELPERS, []),
                              ("learner", LEARNER, objects.values()),
                              ("planner", PLANNER, objects.values())):
        source, image = folder / f"{name}.c", folder / f"{name}.elf"
        source.write_text(text, encoding="utf-8")
        run(prefix + "gcc", *FLAGS, *options, *level.split(), f"-I{ROOT}/core/include", *BARE, source,
            *parts, "-o", image)
        code, constants, _ = sections(prefix, image)
        flash[name] = code + constants
    return {"learner": flash["learner"] - flash["helpers"], "planner": flash["planner"] - flash["helpers"],
            "helpers": flash["helpers"] - flash["empty"]}


def image_memory(name, folder):
    """Static memory of an example: the whole, and of that the block."""
    _, target, ram, stack_bytes, definition, parts = EXAMPLES[name]
    prefix, options = TARGETS[target]
    image = folder / f"{name}.elf"
    shared = ROOT / "examples/firmware"
    run(prefix + "gcc", *FLAGS, *options, "-O2", f"-D{definition}", f"-I{ROOT}/core/include", f"-I{shared}",
        f"-I{ROOT}/examples/gridworld", "--crt0=semihost", "--oslib=semihost", "-Wl,--gc-sections",
        "-Wl,--defsym=__flash=0", "-Wl,--defsym=__flash_size=0x400000",
        "-Wl,--defsym=__ram=0x20000000", f"-Wl,--defsym=__ram_size={ram}",
        f"-Wl,--defsym=__stack_size={stack_bytes}",
        *[ROOT / f"examples/{name}/{part}.c" for part in parts], shared / "load.c", shared / "port_bare.c",
        *(ROOT / "examples/gridworld").glob("*.c"), *sources(), "-o", image)
    block = 0
    for line in run(prefix + "nm", "-S", image).splitlines():
        if re.search(r" b block$", line):
            block = int(line.split()[1], 16)
    return sections(prefix, image)[2], block


class Stack(stack.Graph):
    """The call graph on a target; a helper of the compiler's library is granted HELPER_STACK."""

    def __init__(self, objects):
        super().__init__([], [], None)
        for file in objects.values():
            self.read(file.with_suffix(".ci").read_text(encoding="utf-8"))

    def worst(self, title):
        if title not in self.functions and title not in stack.EXTERNAL:
            return HELPER_STACK, None
        return super().worst(title)


def module_table(objects):
    names = [f"{source.parent.name}/{source.stem}" for source in sources()]
    yield "| module | " + " | ".join(f"{target} code | const" for target in TARGETS) + " |"
    yield "|---|" + "--:|--:|" * len(TARGETS)
    totals = [0] * (2 * len(TARGETS))
    for name in names:
        row = []
        for target, (prefix, _) in TARGETS.items():
            code, constants, data = sections(prefix, objects[target][name])
            if data != 0:
                raise SystemExit(f"{name} has {data} bytes of writable data on {target}")
            row += [code, constants]
        totals = [a + b for a, b in zip(totals, row)]
        yield f"| `{name}` | " + " | ".join(f"{n:,}" for n in row) + " |"
    yield "| all | " + " | ".join(f"{n:,}" for n in totals) + " |"


def stack_table(objects):
    graphs = {target: Stack(objects[target]) for target in TARGETS}
    yield "| function | " + " | ".join(TARGETS) + " |"
    yield "|---|" + "--:|" * len(TARGETS)
    for name in stack.public_functions():
        yield f"| `{name}` | " + " | ".join(
            str(graph.worst(name)[0]) for graph in graphs.values()) + " |"


def flash_table(flash, program):
    yield "| | " + " | ".join(TARGETS) + " |"
    yield "|---|" + "--:|" * len(TARGETS)
    for level, sizes in flash.items():
        for what, parts in (("library", (program,)), ("helpers", ("helpers",)),
                            ("together", (program, "helpers"))):
            yield f"| {level}, {what} | " + " | ".join(
                f"{sum(sizes[target][part] for part in parts):,}" for target in TARGETS) + " |"


def memory_table(name, folder):
    heading, target, ram, stack_bytes, _, _ = EXAMPLES[name]
    memory, block = image_memory(name, folder)
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


def table(folder, compilers):
    objects = {target: compile_core(target, "-O2", folder) for target in TARGETS}
    flash = {level: {target: linked(target, level, compile_core(target, level, folder / "lean", *LEAN), folder)
                     for target in TARGETS} for level in LEVELS}
    yield f"""# Size on microcontrollers

{compilers}; bytes.
Written by `tools/check/size.py --write`; the stage `targets` of the tests fails when it is stale. No module
has writable data.

## A learner in flash

What the linker keeps of the library in a program that learns by bits and does not print, built with one solver,
value iteration, one score, the information gain, and one criterion, the residual (`{' '.join(LEAN)}`,
core/src/base/solver_select.h). Beside it stand the helpers that the compiler brings along where the processor
lacks an instruction (floating point, division). On the M3 the library may take {FLASH_MAX:,} by -Os.
"""
    yield from flash_table(flash, "learner")
    yield f"""
## A planner in flash

The same of a program that learns on real numbers (`rlvc/planner.h`). On the M4F the library may take
{PLANNER_FLASH_MAX:,} by -Os.
"""
    yield from flash_table(flash, "planner")
    for name in EXAMPLES:
        yield from memory_table(name, folder)
    yield """
## Modules

Code and constant data of each, with `-O2`, before the linker leaves out what is not called.
"""
    yield from module_table(objects)
    yield f"""
## Worst stack

With `-O2`, the callbacks that it calls not counted; {HELPER_STACK} are granted to each helper of a compiler's
library.
"""
    yield from stack_table(objects)
    library, planner = flash["-Os"]["M3"]["learner"], flash["-Os"]["M4F"]["planner"]
    if library > FLASH_MAX or planner > PLANNER_FLASH_MAX:
        raise SystemExit(f"too large: {library} bytes of flash of a learner, {planner} of a planner")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="write core/SIZE.md")
    arguments = parser.parse_args()
    prefixes = sorted({prefix for prefix, _ in TARGETS.values()})
    missing = [prefix for prefix in prefixes if not shutil.which(prefix + "gcc")]
    if missing:
        print("skipped: there is no " + ", ".join(prefix + "gcc" for prefix in missing))
        return committed.SKIPPED
    compilers = " and ".join(f"{prefix}gcc {run(prefix + 'gcc', '-dumpfullversion').strip()}"
                             for prefix in prefixes)
    with tempfile.TemporaryDirectory() as folder:
        text = "\n".join(table(pathlib.Path(folder), compilers)) + "\n"
    return committed.settle(TABLE, text, f"\n{compilers};", arguments.write)


if __name__ == "__main__":
    sys.exit(main())
