#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Mutation testing: changes one place of core/src or core/domains at a time, and asks whether a test of tests/core
then fails. A mutant that no test tells from the original shows what the tests do not look at.

Operators: relations, arithmetic, bits, constants, negated conditions, deleted statements. Left out are mutants that
do not compile, or compile to the same code. A test gets five times the processor time that it needs; a mutant that
takes more counts as killed. Those that live must be in tools/check/mutants.txt with a reason, else they count
against --least. Needs gcc, cmocka, and that tools/coverage has run, which counts what each test reaches."""

import argparse
import collections
import concurrent.futures
import functools
import hashlib
import math
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from typing import NamedTuple

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/mutants"
PROFILES = ROOT / "build/coverage/profiles"  # of each test of the core, what tools/coverage has counted
JUDGED = pathlib.Path(__file__).with_suffix(".txt")
FOLDERS = ("core/src", "core/domains")
FLAGS = ["-std=c99", "-w", "-ffp-contract=off", "-fPIC", f"-I{ROOT}/core/include", "-DRLVC_ASSERTS", "-UNDEBUG"]
HELPERS = [*sorted((ROOT / "examples/gridworld").glob("*.c")), ROOT / "examples/balance/cart_pole.c"]
INCLUDE = [f"-I{ROOT}/examples/gridworld", f"-I{ROOT}/examples/balance", f'-DRLVC_GOLDEN_DIR="{ROOT}/tests/golden"',
           "-DRLVC_POWER_CYCLES=20u", "-DRLVC_STRIDE=7u"]

SWAPS = [
    (r" < ", (" <= ", " >= ")), (r" > ", (" >= ", " <= ")), (r" <= ", (" < ", " > ")), (r" >= ", (" > ", " < ")),
    (r" == ", (" != ",)), (r" != ", (" == ",)), (r" && ", (" || ",)), (r" \|\| ", (" && ",)),
    (r" \+ ", (" - ",)), (r" - ", (" + ",)), (r" \* ", (" / ",)), (r" / ", (" * ",)), (r" % ", (" * ",)),
    (r" \+= ", (" -= ",)), (r" -= ", (" += ",)), (r"\+\+", ("--",)), (r"--", ("++",)),
    (r" & ", (" | ",)), (r" \| ", (" & ",)), (r" << ", (" >> ",)), (r" >> ", (" << ",)),
]
NUMBER = re.compile(r"(?<![\w.])(\d+)(u?)(?![\w.])")
REAL = re.compile(r"(?<![\w.])\d+\.\d+(e-?\d+)?f\b")
CONDITION = re.compile(r"\b(if|while) \((.+)\)( \{)?$")
STATEMENT = re.compile(r"^ +(?!return\b|break\b|continue\b|goto\b|RLVC_ASSERT|else\b|case\b|\})[^{}]+;$")
DECLARATION = re.compile(r"^ +(const |static |unsigned |struct )?(u?int\d*(_t)?|float|double|char|size_t|rlvc_\w+|[a-z]\w*)"
                         r" \**\w+(\[.*\])?(;| =|,)")
SKIPPED = re.compile(r"^\s*(#|RLVC_ASSERT)")
FUNCTION = re.compile(r"(\w+)\(")
STOPPED = (-signal.SIGXCPU, -signal.SIGKILL)  # for its processor time


class Mutant(NamedTuple):
    file: str
    line: int  # from 1
    old: str
    new: str
    function: str

    def key(self):
        return f"{self.file}: {self.old.strip()} => {self.new.strip()}"


# ------------------------------------------------------------------------- mutants
def without_comments(text):
    """The text with blanks in place of comments and of what is in quotes."""
    pattern = re.compile(r"/\*.*?\*/|//[^\n]*|\"(\\.|[^\"\\])*\"|'(\\.|[^'\\])*'", re.S)
    return pattern.sub(lambda match: re.sub(r"[^\n]", "\0", match.group()), text)


def functions_of(lines):
    """Of each line the function that it is in, or "": as the formatter leaves it, it begins and ends at the margin."""
    names, name, head = [], "", ""
    for line in lines:
        if line and not line[0].isspace() and line[0] not in "#}\0":
            head = head + line
            if line.endswith("{") and FUNCTION.search(head):
                name = FUNCTION.search(head).group(1)
            if line.endswith((";", "{")):
                head = ""
        elif head:
            head += line
            if line.endswith("{"):
                name, head = FUNCTION.search(head).group(1) if FUNCTION.search(head) else "", ""
        names.append(name)
        if line.startswith("}"):
            name = ""
    return names


def changes(code, before):
    """(begin, end, replacement) of each change of a line; `before` is the line before it."""
    for pattern, replacements in SWAPS:
        for match in re.finditer(pattern, code):
            for replacement in replacements:
                yield match.start(), match.end(), replacement
    for match in NUMBER.finditer(code):
        yield match.start(), match.end(), f"{int(match[1]) + 1}{match[2]}"
    for match in REAL.finditer(code):
        yield match.start(), match.end(), f"({match[0]} + 1.0f)"
    for match in CONDITION.finditer(code):
        if match[2].count("(") == match[2].count(")"):
            yield match.start(2), match.end(2), f"!({match[2]})"
    if STATEMENT.match(code) and not DECLARATION.match(code) and before.rstrip().endswith((";", "{", "}", ")", ":", "else")):
        indent = len(code) - len(code.lstrip())
        yield indent, len(code), ";"


def mutants_of(path):
    file = str(path.relative_to(ROOT))
    text = path.read_text(encoding="utf-8")
    lines, codes = text.split("\n"), without_comments(text).split("\n")
    functions = functions_of(codes)
    for at, code in enumerate(codes):
        if not functions[at] or SKIPPED.match(code) or not code.strip("\0 "):
            continue
        before = next((codes[i] for i in range(at - 1, -1, -1) if codes[i].strip("\0 ")), "")
        for begin, end, replacement in changes(code.rstrip("\0 "), before.rstrip("\0 ")):
            new = lines[at][:begin] + replacement + lines[at][end:]
            yield Mutant(file, at + 1, lines[at], new, functions[at])


def ordered(mutants):
    """By a number that depends on nothing but what is changed: the first so many are a sample."""
    return sorted(mutants, key=lambda mutant: hashlib.sha256(mutant.key().encode()).digest())


# ------------------------------------------------------------------------- the tests
def run(command, seconds=None, **more):
    """A command with a limit of processor time: its exit status, and the processor time that it took."""
    def limit():
        if seconds:
            resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=limit, **more) as started:
        _, status, used = os.wait4(started.pid, 0)
        started.returncode = os.waitstatus_to_exitcode(status)
    return started.returncode, used.ru_utime + used.ru_stime


def core_sources():
    return sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.c"))


def compiled(source, folder, flags):
    target = folder / (str(source.relative_to(ROOT)).replace("/", "_") + ".o")
    subprocess.run(["gcc", *FLAGS, *flags, "-iquote", ROOT / "core/src", "-c", source, "-o", target], check=True)
    return target


def build(workers):
    """The core as objects, and the shared library of them."""
    shutil.rmtree(BUILD, ignore_errors=True)
    (BUILD / "objects").mkdir(parents=True)
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        linked = list(pool.map(lambda source: compiled(source, BUILD / "objects", ["-O1"]), core_sources()))
    subprocess.run(["gcc", "-shared", "-o", BUILD / "objects/librlvc-mutant.so", *linked], check=True)


def reached_by():
    """Of each function the tests that call it, by what tools/coverage counted: those first that run the fewest blocks."""
    reached, blocks = {}, {}
    for profile in sorted(PROFILES.glob("test_*.profraw")):
        merged = BUILD / f"{profile.stem}.profdata"
        subprocess.run(["llvm-profdata-19", "merge", "-o", merged, profile], check=True)
        shown = subprocess.run(["llvm-profdata-19", "show", "--all-functions", "--counts", merged], check=True,
                               stdout=subprocess.PIPE, text=True).stdout
        counts = re.findall(r"^  (\S+):\n(?:    .*\n)*?    Function count: (\d+)", shown, re.M)
        blocks[profile.stem] = sum(int(n) for line in re.findall(r"Block counts: \[(.*)\]", shown) for n in line.split(", ") if n)
        reached[profile.stem] = {re.split("[:;]", name)[-1] for name, count in counts if int(count)}
    if not reached:
        raise SystemExit(f"{PROFILES.relative_to(ROOT)} is empty: run tools/coverage first")
    calls = {}
    for test in sorted(reached, key=blocks.get):
        for function in reached[test]:
            calls.setdefault(function, []).append(test)
    return calls


class Tests:
    """Builds a test when it is first asked for, and finds how much processor time it takes."""

    def __init__(self, most):
        self.most = most
        self.locks = collections.defaultdict(threading.Lock)
        self.found = {}
        self.helpers = [compiled(source, BUILD, ["-O1", *INCLUDE]) for source in HELPERS]

    def seconds(self, test):
        """None if it takes more than `most`, or so much that it was stopped."""
        with self.locks[test]:
            if test not in self.found:
                self.found[test] = self.measured(test)
            return self.found[test]

    def measured(self, test):
        source = compiled(ROOT / f"tests/core/{test}.c", BUILD, ["-O0", *INCLUDE])
        subprocess.run(["gcc", "-o", BUILD / test, source, *self.helpers, f"-L{BUILD}/objects", "-lrlvc-mutant", "-lcmocka",
                        "-lm"], check=True)
        limit = None if math.isinf(self.most) else math.ceil(self.most)
        status, seconds = run([BUILD / test], limit, cwd=BUILD, env=os.environ | {"LD_LIBRARY_PATH": str(BUILD / "objects")})
        if status not in (0, *STOPPED):
            raise SystemExit(f"{test} fails without a mutant: run tools/test dev")
        return seconds if status == 0 and seconds <= self.most else None


# ------------------------------------------------------------------------- trying one
def tried(mutant, calls, tests):
    """killed by which test; or lives; or not a mutant: does not compile, same code."""
    source = ROOT / mutant.file
    name = mutant.file.replace("/", "_") + ".o"
    with tempfile.TemporaryDirectory(dir=BUILD) as folder:
        folder = pathlib.Path(folder)
        text = source.read_text(encoding="utf-8").split("\n")
        text[mutant.line - 1] = mutant.new
        changed = folder / source.name
        changed.write_text("\n".join(text), encoding="utf-8")
        command = ["gcc", *FLAGS, "-O1", "-iquote", source.parent, "-iquote", ROOT / "core/src", "-c", changed]
        if run([*command, "-o", folder / name])[0]:
            return "does not compile"
        changed.write_text(source.read_text(encoding="utf-8"), encoding="utf-8")
        run([*command, "-o", folder / "same.o"])
        if (folder / name).read_bytes() == (folder / "same.o").read_bytes():
            return "same code"
        others = [path for path in (BUILD / "objects").glob("*.o") if path.name != name]
        if run(["gcc", "-shared", "-o", folder / "librlvc-mutant.so", folder / name, *others])[0]:
            return "does not compile"
        for test in calls.get(mutant.function, []):
            seconds = tests.seconds(test)
            if seconds is None:
                break  # those that follow take longer
            if run([BUILD / test], math.ceil(5 * seconds) + 1, cwd=folder, env=os.environ | {"LD_LIBRARY_PATH": str(folder)})[0]:
                return test
    return "lives"


def judged():
    """The mutants that are known to live, with the reason."""
    found = {}
    for line in JUDGED.read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            key, _, why = line.partition(" ## ")
            found[key] = why
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", nargs="*", help="of core/src or core/domains; default: all")
    parser.add_argument("--sample", type=int, default=0, help="try so many of the mutants (0: all)")
    parser.add_argument("--skip", type=int, default=0, help="leave out so many of them first")
    parser.add_argument("--seconds", type=float, default=math.inf,
                        help="leave out tests that take more processor time (default: none)")
    parser.add_argument("--least", type=float, default=0.98, help="of those not judged must be killed")
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    files = [pathlib.Path(file).resolve() for file in arguments.file] or core_sources()
    mutants = ordered(mutant for file in files for mutant in mutants_of(file))
    last = arguments.skip + arguments.sample if arguments.sample else len(mutants)
    chosen = mutants[arguments.skip:last]
    build(arguments.workers)
    calls, tests = reached_by(), Tests(arguments.seconds)
    known, counts = judged(), {}
    with concurrent.futures.ThreadPoolExecutor(arguments.workers) as pool:
        verdicts = pool.map(functools.partial(tried, calls=calls, tests=tests), chosen)
        for mutant, verdict in zip(chosen, verdicts):
            kind = verdict if " " in verdict or verdict == "lives" else "killed"
            kind = "judged" if kind == "lives" and mutant.key() in known else kind
            counts[kind] = counts.get(kind, 0) + 1
            if kind == "lives":
                print(f"lives, line {mutant.line}: {mutant.key()}", flush=True)
    killed, lives = counts.get("killed", 0), counts.get("lives", 0)
    share = killed / max(killed + lives, 1)
    print(f"{len(chosen)} of {len(mutants)} mutants: " +
          ", ".join(f"{count} {kind}" for kind, count in sorted(counts.items())))
    print(f"{100 * share:.1f} % of those that are not judged were killed")
    return share < arguments.least


if __name__ == "__main__":
    sys.exit(main())
