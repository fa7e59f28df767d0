#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The worst-case stack of each public function of the core, as gcc sees it on x86-64.

Compiles the core twice: unoptimised, where the call graph is the one that the source shows, to find
recursion, arrays of variable length, calls of anything outside and calls through pointers; and with
-O2, where the bytes of the table come from. Compares the table with core/STACK.md, or writes it
there with --write."""

import argparse
import collections
import pathlib
import re
import subprocess
import sys
import tempfile

import committed
from committed import ROOT

TABLE = ROOT / "core/STACK.md"

FLAGS = ["-std=c99", "-ffp-contract=off", "-mno-red-zone", "-fno-stack-protector",
         "-fcf-protection=none", "-fstack-usage", "-fcallgraph-info=su"]
# What a compiler makes calls of on its own, and the bytes that the table grants each.
EXTERNAL = {"memcpy": 64, "memmove": 64, "memset": 64, "memcmp": 64, "strlen": 64}
# The pointers that the core may call through: the domain's callbacks, and those of the caller's files.
INDIRECT = re.compile(r"\b(exhibits|candidates|detect|oracle|name|check_percept|check_feature|read|write|erase|sync)\s*\(")
# A call through the table of a method (base/method.h): it goes to that function of each method.
THROUGH_METHOD = re.compile(r"\bmethod(?:_of\(\w+\))?->(\w+)\(")
METHODS = ("rlvc_classes_", "rlvc_planner_")
PLACEHOLDER = "__indirect_call"

Function = collections.namedtuple("Function", "name place bytes kind")


class Graph:
    """What gcc's .ci files say: functions by title, and the calls of each."""

    def __init__(self, sources, options, folder):
        self.functions = {}
        self.externals = set()
        self.calls = collections.defaultdict(set)     # title -> titles
        self.indirect = collections.defaultdict(set)  # title -> places in the source
        self.known = {}                               # what worst() found
        for source in sources:
            stem = folder / f"{source.parent.name}_{source.stem}"
            self.compile(options, source, f"{stem}.o")
            self.read(pathlib.Path(f"{stem}.ci").read_text(encoding="utf-8"))

    def compile(self, options, source, output):
        subprocess.run(["gcc", *FLAGS, *options, f"-I{ROOT}/core/include", "-c", str(source),
                        "-o", output], check=True)

    def read(self, text):
        for match in re.finditer(r'^node: \{ title: "(.*?)" label: "(.*?)"', text, re.MULTILINE):
            title, label = match.groups()
            lines = label.split("\\n")
            usage = re.fullmatch(r"(\d+) bytes \((.*)\)", lines[2]) if len(lines) > 2 else None
            if usage:
                self.functions[title] = Function(lines[0], lines[1], int(usage[1]), usage[2])
            elif title != PLACEHOLDER:
                self.externals.add(title)
        for match in re.finditer(
                r'^edge: \{ sourcename: "(.*?)" targetname: "(.*?)"(?: label: "(.*?)")?', text,
                re.MULTILINE):
            caller, callee, place = match.groups()
            through = THROUGH_METHOD.search(source_line(place)) if callee == PLACEHOLDER else None
            if through:
                self.calls[caller] |= {prefix + through[1] for prefix in METHODS}
            elif callee == PLACEHOLDER:
                self.indirect[caller].add(place)
            else:
                self.calls[caller].add(callee)

    def worst(self, title):
        """(bytes, bytes at the deepest call through a pointer or None) of the worst path."""
        if title in EXTERNAL:
            return EXTERNAL[title], None
        if title in self.known:
            return self.known[title]
        own = self.functions[title].bytes
        below, callback = 0, (own if self.indirect[title] else None)
        for callee in self.calls[title]:
            deep, deep_callback = self.worst(callee)
            below = max(below, deep)
            if deep_callback is not None:
                callback = max(callback or 0, own + deep_callback)
        self.known[title] = own + below, callback
        return self.known[title]

    def reaches_itself(self, title):
        seen, todo = set(), list(self.calls[title])
        while todo:
            callee = todo.pop()
            if callee == title:
                return True
            if callee not in seen:
                seen.add(callee)
                todo += self.calls[callee]
        return False

    def faults(self):
        for title, function in sorted(self.functions.items()):
            if self.reaches_itself(title):
                yield f"{function.place}: {function.name} is recursive"
            # Pushed arguments make a frame dynamic, but bounded: the bytes are then a bound.
            if function.kind not in ("static", "dynamic,bounded"):
                yield f"{function.place}: {function.name} has a frame of variable size"
            for place in sorted(self.indirect[title]):
                if not INDIRECT.search(source_line(place)):
                    yield f"{place}: {function.name} calls through a pointer that is no callback"
        for title in sorted(self.externals - set(self.functions) - set(EXTERNAL)):
            yield f"{title} is called, but is no part of the core"


def source_line(place):
    name, line, column = place.rsplit(":", 2)
    # From the column on, as a line may hold two calls; a call is placed at its name or its object.
    text = pathlib.Path(name).read_text(encoding="utf-8").splitlines()[int(line) - 1]
    return text if INDIRECT.search(text) is None else text[max(0, int(column) - 40):]


def callbacks(graph, title):
    """The callbacks that a function reaches, by name."""
    seen, todo, names = {title}, [title], set()
    while todo:
        caller = todo.pop()
        names |= {INDIRECT.search(source_line(place))[1] for place in graph.indirect[caller]}
        todo += graph.calls[caller] - seen
        seen |= graph.calls[caller]
    return names


def public_functions():
    names = []
    for header in sorted((ROOT / "core/include/rlvc").glob("*.h")):
        text = re.sub(r"/\*.*?\*/", "", header.read_text(encoding="utf-8"), flags=re.DOTALL)
        names += re.findall(r"^RLVC_API [^(]*?(\w+)\(", text, re.MULTILINE)
    return names


def table(plain, optimised, compiler):
    yield from (
        "# Worst-case stack\n",
        f"x86-64, gcc {compiler}, `-O2`; bytes, return addresses included, and 64 granted to memcpy",
        "and its like. Written by `tools/check/stack.py --write`; a test fails when it is stale. No",
        "function of the core is recursive or has a frame of variable size.\n",
        "*Callback at* is how much of the stack is in use when the deepest callback is called.",
        "What the callback needs comes on top of that; the sum may be more than the *bytes*.\n",
        "| public function | bytes | callback at | callbacks it may call |",
        "|---|--:|--:|---|")
    for name in public_functions():
        total, callback = optimised.worst(name)
        names = ", ".join(sorted(callbacks(plain, name))) or "-"
        yield f"| `{name}` | {total} | {'-' if callback is None else callback} | {names} |"
    called = set().union(*optimised.calls.values())
    yield from ("\nThe ready-made domains' own callbacks:\n", "| callback | bytes |", "|---|--:|")
    for title, function in sorted(optimised.functions.items()):
        if function.place.startswith(str(ROOT / "core/domains")) and ":" in title \
                and title not in called:
            yield f"| `{function.name}` | {optimised.worst(title)[0]} |"
    yield from ("\nWhere the core calls through a pointer:\n", "| function | callback |",
                "|---|---|")
    for title, function in sorted(plain.functions.items(), key=lambda item: item[1].name):
        names = sorted({INDIRECT.search(source_line(place))[1] for place in plain.indirect[title]})
        if names:
            yield f"| `{function.name}` | {', '.join(names)} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="write core/STACK.md")
    arguments = parser.parse_args()

    compiler = subprocess.run(["gcc", "-dumpfullversion"], check=True, stdout=subprocess.PIPE,
                              text=True).stdout.strip()
    machine = subprocess.run(["gcc", "-dumpmachine"], check=True, stdout=subprocess.PIPE,
                             text=True).stdout.strip()
    if not machine.startswith("x86_64"):
        print(f"the table is of x86-64, and gcc here makes code for {machine}")
        return committed.SKIPPED
    sources = committed.sources()
    with tempfile.TemporaryDirectory() as folder:
        plain = Graph(sources, ["-O0"], pathlib.Path(folder))
        optimised = Graph(sources, ["-O2"], pathlib.Path(folder))
    faults = sorted(set(plain.faults()) | set(optimised.faults()))
    missing = [name for name in public_functions() if name not in optimised.functions]
    faults += [f"{name} is declared in a public header, but is nowhere" for name in missing]
    for fault in faults:
        print(fault, file=sys.stderr)
    if faults:
        return 1

    return committed.settle(TABLE, "\n".join(table(plain, optimised, compiler)) + "\n",
                            f"gcc {compiler},", arguments.write)


if __name__ == "__main__":
    sys.exit(main())
