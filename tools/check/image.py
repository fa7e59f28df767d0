#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs an image, as a rule under an emulator, and keeps what it prints in NAME.out. Its exit status
must be 0. With --json, its output must end in JSON: that of EXPECTED/NAME.out, byte for byte. With
--lines, the output must be what the file TABLE holds from its first line of a table on. With --status, the
status is all that counts. An image that has passed is not run again while it, the emulator, and what it is
compared with are the same."""

import argparse
import hashlib
import json
import pathlib
import shutil
import subprocess
import sys

TABLE = pathlib.Path(__file__).resolve().parents[2] / "core/TIME.md"


def compare_table(path, output, write):
    """What stands before the table is not the image's."""
    committed = path.read_text(encoding="utf-8")
    head = committed[:committed.index("\n| ") + 1]
    if write:
        path.write_text(head + output, encoding="utf-8")
    elif committed != head + output:
        print(output + f"{path} is stale: run this again with --write", file=sys.stderr)
        return 1
    return 0


def json_part(text):
    """From the first line on that begins with a brace."""
    at = 0 if text.startswith(b"{") else text.find(b"\n{") + 1
    return text[at:] if text[at:at + 1] == b"{" else b""


def fingerprint(arguments):
    """Of all that decides whether the image passes."""
    output = f"{arguments.name}.out"
    files = [arguments.table if arguments.lines else "", output, __file__,
             pathlib.Path(arguments.expected, output) if arguments.expected else "",
             *(shutil.which(word) or word for word in arguments.command)]
    found = hashlib.sha256(repr(sys.argv[1:]).encode())
    for path in map(pathlib.Path, files):
        found.update(path.read_bytes() if path.is_file() else b"-")
    return found.hexdigest()


def run(arguments):
    """Runs the image and judges what it prints: the exit status."""
    done = subprocess.run(arguments.command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          check=False)
    output = done.stdout.replace(b"\r", b"")
    pathlib.Path(f"{arguments.name}.out").write_bytes(output)
    if done.returncode != 0:
        print(output.decode(errors="replace"), file=sys.stderr)
        print(f"exit status {done.returncode}: {' '.join(arguments.command)}", file=sys.stderr)
        return 1
    if arguments.status:
        sys.stdout.write(output.decode())
        return 0
    if arguments.lines:
        if not output.startswith(b"| "):
            print(f"no table: {' '.join(arguments.command)}", file=sys.stderr)
            return 1
        return compare_table(arguments.table, output.decode(), arguments.write)
    part = json_part(output)
    if arguments.json:
        json.loads(part)
    sys.stdout.write(output[:len(output) - len(part)].decode())
    if arguments.expected:
        expected = pathlib.Path(arguments.expected) / f"{arguments.name}.out"
        if json_part(expected.read_bytes()) != part:
            print(f"the JSON differs: {pathlib.Path.cwd()}/{arguments.name}.out and {expected}",
                  file=sys.stderr)
            return 1
        print(f"JSON: the {len(part)} bytes of {expected}")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="the output must end in JSON")
    parser.add_argument("--lines", action="store_true", help="the output must be a table")
    parser.add_argument("--status", action="store_true", help="the output does not matter")
    parser.add_argument("--table", type=pathlib.Path, default=TABLE, help="default: %(default)s")
    parser.add_argument("--write", action="store_true", help="write TABLE")
    parser.add_argument("--name", required=True)
    parser.add_argument("--expected", default="", help="a folder; default: nothing to compare with")
    parser.add_argument("command", nargs="+")
    arguments = parser.parse_args()
    passed = pathlib.Path(f"{arguments.name}.passed")
    if not arguments.write and passed.is_file() and passed.read_text() == fingerprint(arguments):
        print("the same image has passed")
        return 0
    status = run(arguments)
    if status == 0:
        passed.write_text(fingerprint(arguments))
    return status


if __name__ == "__main__":
    sys.exit(main())
