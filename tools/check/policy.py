#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What the exported policy of the maze takes on a Cortex-M0, by -Os: the bytes of an image that holds nothing
else than the policy, the start-up code and the table of interrupts; and the policy's stack. Both must be
within their limits, and the policy must need no memory beside the stack and no function of others."""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

import cross
from committed import ROOT

FLASH_MAX = 600
STACK_MAX = 64
MAIN = """
unsigned maze_policy(const unsigned char *percept);
int main(void) { return (int)maze_policy((const unsigned char *)0x20000000); }
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path, help="where maze.h is")
    arguments = parser.parse_args()
    target = cross.TARGETS["M0"]
    prefix = target.compiler.removesuffix("gcc")
    gcc = [target.compiler, *target.options, *cross.FLAGS, "-Os", f"-I{arguments.folder}"]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "main.c").write_text(MAIN, encoding="utf-8")
        cross.run(*gcc, "-fstack-usage", "-c", ROOT / "tests/targets/maze_policy.c", "-o", folder / "policy.o")
        cross.run(*gcc, *cross.BARE, "-Wl,--gc-sections", folder / "main.c", folder / "policy.o", "-o",
                  folder / "image.elf")
        needed = cross.run(prefix + "nm", "-u", folder / "policy.o").split()
        policy = cross.sections("M0", folder / "policy.o")
        image = sum(cross.sections("M0", folder / "image.elf")[kind] for kind in cross.IN_FLASH)
        memory = sum(policy[kind] for kind in cross.IN_RAM)
        stack = int((folder / "policy.su").read_text(encoding="utf-8").split("\t")[1])
    print(f"the policy: {policy['text']} bytes of code, {policy['rodata']} of constants, {stack} of stack; "
          f"the image: {image}")
    if needed or memory > 0 or image > FLASH_MAX or stack > STACK_MAX:
        print(f"too much: the limits are {FLASH_MAX} bytes of flash and {STACK_MAX} of stack; of memory "
              f"{memory} are needed, and the functions {needed}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
