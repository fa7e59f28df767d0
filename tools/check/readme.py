#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that the C program in README.md is the example that the tests compile and run; with
--write, puts it there."""

import argparse
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLE = "examples/01_learn.c"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="bring README.md up to date")
    arguments = parser.parse_args()
    readme = ROOT / "README.md"
    text = readme.read_text(encoding="utf-8")
    # The example without its head: the licence and the comment on what the file is.
    example = (ROOT / EXAMPLE).read_text(encoding="utf-8")
    program = example[example.index("#include"):]
    match = re.search(r"^```c\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    if match is None:
        print("README.md has no C program", file=sys.stderr)
        return 1
    if match.group(1) == program:
        return 0
    if arguments.write:
        readme.write_text(text[:match.start(1)] + program + text[match.end(1):], encoding="utf-8")
        return 0
    print(f"The C program in README.md is not {EXAMPLE}: run tools/check/readme.py --write",
          file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
