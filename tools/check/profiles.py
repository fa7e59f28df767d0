# SPDX-License-Identifier: MIT
"""Flash and RAM of the library in a program, by what the program uses of it and by the machine: the first table of
core/SIZE.md, for size.py. A machine whose compiler is not here keeps the row that it has there."""

import collections
import concurrent.futures
import os
import re
import sys

import cross
from committed import ROOT

sys.path.insert(0, str(ROOT / "tools/packages"))
import amalgamate  # noqa: E402

Profile = collections.namedtuple("Profile", "bytes functions")  # of memory that it is given, and what is called
Measured = collections.namedtuple("Measured", "library sizes")  # an object file; (flash, RAM) by profile

# What a program needs that does not print, save or load.
PROFILES = {
    "policy": Profile("RLVC_PLANNER_POLICY_BYTES", (
        "rlvc_thresholds_default", "rlvc_thresholds_policy_domain", "rlvc_planner_policy_of", "rlvc_policy_act")),
    "learner on bits": Profile("RLVC_AGENT_BYTES(2, 200, 10, 1, RLVC_BITS_FEATURE_BYTES, 3)", (
        "rlvc_bits_domain", "rlvc_config_default", "rlvc_agent_size", "rlvc_agent_init", "rlvc_begin", "rlvc_act",
        "rlvc_observe", "rlvc_learn", "rlvc_predict", "rlvc_stats", "rlvc_q", "rlvc_value", "rlvc_split_at")),
    "learner on numbers": Profile("RLVC_PLANNER_BYTES(2, 2, 200, 200, 4)", (
        "rlvc_thresholds_default", "rlvc_thresholds_domain", "rlvc_config_default", "rlvc_agent_size", "rlvc_agent_init",
        "rlvc_begin", "rlvc_act", "rlvc_observe", "rlvc_learn", "rlvc_budget_min", "rlvc_predict", "rlvc_planner_node",
        "rlvc_planner_stats")),
}
EMPTY = "int main(void) { return 0; }\n"
BLOCK = """#include <rlvc/rlvc.h>
#include <rlvc/planner.h>
uint64_t block[(%s + 7u) / 8u];
""" + EMPTY


def compile_core(target, source, folder):
    """The core as one object file, and where gcc can tell the calls and the stack of its functions, those."""
    output = folder / f"{target}.o"
    known = () if target in ("AVR", "wasm32") else ("-fstack-usage", "-fcallgraph-info=su")
    cross.compile_c(target, source, output, "-Os", *known)
    return output


def measure(target, library, folder):
    """(flash, RAM) of each profile, beyond those of a program that does nothing."""
    empty = cross.link(target, EMPTY, (), (), folder / f"{target}_empty.elf")
    for name, profile in PROFILES.items():
        image = folder / f"{target} {name}.elf"
        whole = cross.link(target, BLOCK % profile.bytes, ("block", *profile.functions), (library,), image)
        yield name, tuple(a - b for a, b in zip(whole, empty))


def committed_rows(text):
    """The rows that are in the table, by target."""
    return {match[1]: match[0] for match in re.finditer(r"^\| (\w+) \| [\w-]+ [\d.]+ \|.*$", text, re.MULTILINE)}


def measurable(rows, write):
    """The targets to measure; says which are skipped, and why."""
    for name, target in cross.TARGETS.items():
        absent = cross.missing(target.compiler)
        if absent:
            print(f"skipped {name}: there is no {' and no '.join(absent)}")
        elif not write and name in rows and f"| {cross.named(target.compiler)} |" not in rows[name]:
            print(f"skipped {name}: the table is of another compiler than {cross.named(target.compiler)}")
        else:
            yield name


def measure_all(folder, targets):
    """What is Measured of each target."""
    amalgamate.write(folder)

    def one(target):
        library = compile_core(target, folder / "rlvc.c", folder)
        return target, Measured(library, dict(measure(target, library, folder)))

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return dict(pool.map(one, targets))


def table(measured, rows):
    """The lines of the table: of what was measured, or as they were."""
    yield "| | compiler | " + " | ".join(f"{name}: flash | RAM" for name in PROFILES) + " |"
    yield "|---|---|" + "--:|--:|" * len(PROFILES)
    for name, target in cross.TARGETS.items():
        if name in measured:
            sizes = " | ".join(f"{flash:,} | {ram:,}" for flash, ram in measured[name].sizes.values())
            yield f"| {name} | {cross.named(target.compiler)} | {sizes} |"
        elif name in rows:
            yield rows[name]
