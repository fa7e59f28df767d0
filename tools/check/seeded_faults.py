#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Shows that the tests can fail: plants faults in a copy of the project (build/seeded), one at a time, runs the
stage of tools/test that is there to find it, and prints whether it did. Of a stage, only that part is run which is to
find the fault, where it can be run by itself. What is committed is copied, not what is changed here."""

import argparse
import pathlib
import re
import subprocess
import sys
from typing import NamedTuple

ROOT = pathlib.Path(__file__).resolve().parents[2]
COPY = ROOT / "build/seeded"


class Fault(NamedTuple):
    stage: str
    what: str
    file: str
    old: str  # found once in the file
    new: str
    tests: str  # which of a preset's tests are to find it (ctest -R); "": the whole stage is run, or the part
    found_by: str  # a pattern in what is printed, beside the failure
    part: str = ""  # the command of the stage that is to find it


NEXT = "uint32_t rlvc_rng_next(rlvc_rng *rng) {\n"
STEP = "rng->state = {} * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);\n"
FAULTS = [
    Fault("dev", "a result that is wrong: of equal actions the last is taken", "core/src/tree/values.c",
          "values->q[pair] > values->q[", "values->q[pair] >= values->q[", "test_values", r"core\.test_values .*Failed"),
    Fault("dev", "an assertion that fails", "core/src/base/rng.c",
          "RLVC_ASSERT(bound >= 1u);", "RLVC_ASSERT(bound > 1u);", "test_rng", r"Assertion .bound > 1u. failed"),
    Fault("dev", "a counter that all agents share", "core/src/base/rng.c",
          "uint32_t rlvc_rng_next(rlvc_rng *rng) {\n",
          "uint32_t rlvc_rng_next(rlvc_rng *rng) {\n    static uint32_t calls;\n    calls++;\n",
          "threads", r"ThreadSanitizer: data race"),
    Fault("dev", "a room that includes a later one", "core/src/base/rng.c",
          '#include "assert.h"\n', '#include "assert.h"\n#include "../agent/state.h"\n',
          "checks.sources", r"checks\.sources .*Failed"),
    Fault("shipped", "work that is done inside an assertion", "core/src/base/rng.c",
          "    RLVC_ASSERT(bound >= 1u);\n    return (uint32_t)(((uint64_t)rlvc_rng_next(rng) * bound) >> 32);",
          "    uint64_t word = rng->state >> 32;\n    RLVC_ASSERT((word = rlvc_rng_next(rng), bound >= 1u));\n"
          "    return (uint32_t)((word * bound) >> 32);",
          "test_rng", r"core\.test_rng .*Failed"),
    Fault("shipped", "a package without its headers", "core/CMakeLists.txt",
          "install(DIRECTORY include/rlvc TYPE INCLUDE)\n", "", "package", r"package\.find_package .*Failed"),
    Fault("clang", "a result that depends on the order in which gcc evaluates arguments", "core/src/base/rng.c",
          NEXT + "    uint64_t state = rng->state;\n    " + STEP.format("state"),
          "static uint64_t step(rlvc_rng *rng) {\n    return " + STEP.format("rng->state") + "}\n"
          "static uint64_t second(uint64_t first, uint64_t other) {\n    return (void)first, other;\n}\n"
          + NEXT + "    uint64_t state = second(step(rng), rng->state);\n",
          "test_rng", r"core\.test_rng .*Failed"),
    Fault("asan-ubsan", "a byte read beyond a buffer, whose value does not matter", "core/src/base/crc.c",
          "    crc = ~crc;\n", "    crc = ~crc;\n    (void)*(const volatile unsigned char *)(byte + bytes);\n",
          "core", r"AddressSanitizer: .*-buffer-overflow"),
    Fault("asan-ubsan", "a log from outside that is not checked", "core/src/store/log.c",
          "return record->choice.action < reader->actions && ", "return reader != NULL && ", "fuzz.log", r"fuzz\.log .*Failed"),
    Fault("coverage", "a branch that no test reaches", "core/src/base/rng.c",
          "    rng->state = z ^ (z >> 31);\n",
          "    rng->state = z ^ (z >> 31);\n    if (seed == 0xdeadbeefu)\n        rng->state = 1;\n",
          "", r"base/rng\.c: missed .*'branches': 1", "tools/coverage"),
    Fault("coverage", "a condition that never decides", "core/src/base/rng.c",
          "    rng->state = z ^ (z >> 31);\n",
          "    rng->state = z ^ (z >> 31);\n    if (seed == 1u && rng->state != 0)\n        rng->state = rng->state + 0u;\n",
          "", r"not shown to decide: condition 2 of 2", "tools/coverage"),
    Fault("bits", "a product and a sum that clang contracts", "core/src/solve/value_iteration.c",
          "enum { SWEEP, IMPROVE };\n",
          "#ifdef __clang__\n#pragma STDC FP_CONTRACT ON\n#endif\nenum { SWEEP, IMPROVE };\n",
          "", r"run_gridworld-clang-O3 and .* differ"),
    Fault("targets", "a char that holds negative numbers", "core/src/base/float_math.c",
          "rlvc_float_of((uint32_t)(e + 127) << 23)", "rlvc_float_of((uint32_t)((char)e + 127) << 23)",
          "", r"targets\.\w+ .*Failed", "tools/targets cortex-m3"),
    Fault("targets", "a table that is stale", "core/SIZE.md", "# Size on", "# Sizes on", "", r"core/SIZE\.md is stale",
          "python3 -B tools/check/size.py"),
    Fault("packages", "numbers that are written in the byte order of the machine", "core/src/base/bytes.h",
          "to[i] = (unsigned char)(number >> (8u * i));", "to[i] = ((const unsigned char *)&number)[i];",
          "", r"PowerPC[^\n]*(differs|exit status)", "python3 -B tools/check/alone.py PowerPC"),
    Fault("packages", "an installed tree that cannot be moved", "core/cmake/rlvc.pc.in",
          "prefix=${pcfiledir}/@pc_prefix@", "prefix=@CMAKE_INSTALL_PREFIX@",
          "", r"cmake: FAILED", "python3 -B tools/packages/check.py --unoptimised cmake"),
    Fault("docs", "a link that leads nowhere", "shim/docs/index.md", "](c/agent.md)", "](c/agents.md)",
          "", r"c/agents\.md"),
    Fault("docs", "a word that is not spelt well", "shim/docs/index.md", "What runs in this page is", "What runs in this pagge is",
          "", r"pagge"),
    Fault("shim", "a struct that Python sees otherwise than C", "shim/rlvc/_native/bindings.py",
          '("min_samples", c.c_uint32)', '("min_samples", c.c_uint64)', "", r"(?i)layout|bindings"),
    Fault("shim", "a byte written beyond an array of numpy's", "shim/native/records.c",
          "        records->ends[i] = record->end;\n",
          "        records->ends[i] = records->ends[i + 1] = record->end;\n", "", r"AddressSanitizer: .*-overflow"),
    Fault("shim", "a function that is not annotated", "shim/rlvc/report.py",
          "def _cells(run: Any, env: Any) -> dict[str, Any]:", "def _cells(run: Any, env: Any):",
          "", r"Function is missing a return type annotation"),
]


def plant(fault):
    path = COPY / fault.file
    text = path.read_text(encoding="utf-8")
    if text.count(fault.old) != 1:
        raise SystemExit(f"{fault.file} has {text.count(fault.old)} times, not once: {fault.old}")
    path.write_text(text.replace(fault.old, fault.new), encoding="utf-8")


def run(fault):
    """Runs what is to find the fault; what it printed, and whether it passed."""
    commands = [fault.part.split() or ["tools/test", fault.stage]]
    if fault.tests:
        commands = [["cmake", "--preset", fault.stage], ["cmake", "--build", "--preset", fault.stage],
                    ["ctest", "--preset", fault.stage, "--tests-regex", fault.tests]]
    printed = ""
    for command in commands:
        done = subprocess.run(command, cwd=COPY, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, errors="replace", check=False)
        printed += done.stdout
        if done.returncode:
            return printed, False
    return printed, True


def git(*arguments):
    subprocess.run(["git", "-C", COPY, *arguments], check=True, stdout=subprocess.DEVNULL)


def copy():
    """The copy, as the project is committed; what was built in it stays."""
    if not (COPY / ".git").exists():
        subprocess.run(["git", "clone", "--quiet", ROOT, COPY], check=True)
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "HEAD"], check=True, stdout=subprocess.PIPE,
                            text=True).stdout.strip()
    git("fetch", "--quiet", ROOT, commit)
    git("reset", "--quiet", "--hard", commit)


def main():
    stages = list(dict.fromkeys(fault.stage for fault in FAULTS))
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("stage", nargs="*", help=f"default: all, which are {', '.join(stages)}")
    arguments = parser.parse_args()
    if unknown := set(arguments.stage) - set(stages):
        parser.error(f"no such stage: {', '.join(sorted(unknown))}")
    missed = 0
    for number, fault in enumerate(FAULTS):
        if arguments.stage and fault.stage not in arguments.stage:
            continue
        copy()
        plant(fault)
        printed, passed = run(fault)
        log = ROOT / f"build/seeded-{number}-{fault.stage}.log"
        log.write_text(printed, encoding="utf-8")
        caught = not passed and re.search(fault.found_by, printed)
        missed += not caught
        print(f"{'caught' if caught else f'MISSED ({log.relative_to(ROOT)})'}  {fault.stage}: {fault.what}",
              flush=True)
    return missed > 0


if __name__ == "__main__":
    sys.exit(main())
