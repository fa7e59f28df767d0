#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks what a static archive of the core needs and holds: it may call nothing but what every
compiler expects to find, and have no writable data."""

import argparse
import subprocess
import sys

# What a compiler makes calls of on its own, out of loops, copies and (bcmp, by clang where the C library
# has it) memcmp: it is there on every target.
ALLOWED = {"bcmp", "memcpy", "memmove", "memset", "memcmp", "strlen", "_GLOBAL_OFFSET_TABLE_"}
ASSERTS = {"__assert_fail"}
# The types that nm gives to code, read-only data and undefined names. All else is writable data,
# common or weak, but for constants that hold addresses: the loader writes these once.
READ_ONLY = set("tTrRU")
RELOCATED = ".data.rel.ro"


def symbols(archive):
    """(object file, type, name, section) of each symbol of the archive."""
    output = subprocess.run(["nm", "--format=sysv", archive],
                            check=True, stdout=subprocess.PIPE, text=True).stdout
    where = archive
    for line in output.splitlines():
        fields = [field.strip() for field in line.split("|")]
        if len(fields) == 7 and fields[0] != "Name":
            yield where, fields[2], fields[0], fields[6]
        elif line.endswith("]:"):
            where = line[line.index("[") + 1:-2]


def needs(table):
    """(object file, name) of what the archive needs from elsewhere."""
    defined = {name for _, kind, name, _ in table if kind != "U"}
    return sorted({(where, name) for where, kind, name, _ in table
                   if kind == "U" and name not in defined})


def functions(table):
    return {name for _, kind, name, _ in table if kind == "T"}


def faults(table, allowed):
    for where, name in needs(table):
        if name not in allowed:
            yield f"{where}: needs {name}"
    for where, kind, name, section in table:
        if kind not in READ_ONLY and not section.startswith(RELOCATED):
            yield f"{where}: {name}, in {section}, is neither code nor read-only data"
    for name in sorted(functions(table)):
        if not name.startswith("rlvc_"):
            yield f"{name} is not named rlvc_*"
    if not functions(table):
        yield "the archive defines no function"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("archive")
    parser.add_argument("--asserts", action=argparse.BooleanOptionalAction, default=False,
                        help="the archive was built with its assertions")
    arguments = parser.parse_args()
    allowed = ALLOWED | (ASSERTS if arguments.asserts else set())

    table = list(symbols(arguments.archive))
    found = list(faults(table, allowed))
    for fault in found:
        print(fault, file=sys.stderr)
    names = sorted({name for _, name in needs(table)})
    print(f"{len(functions(table))} functions; needs {', '.join(names) or 'nothing'}")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
