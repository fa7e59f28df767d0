#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Builds the playground: the core and the worlds as WebAssembly, in a page that needs no network.

    build.py FOLDER [MODULE]

Needs clang and lld (on Debian: clang lld). Writes into the folder the files of page/, rlvc.wasm, and
wasm.js, which holds the same as text: so the page also opens from a file, without a server. MODULE is an
rlvc.wasm that was built before, to be taken instead of compiling it again."""

import base64
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
# The sources that firmware links, and what the page adds to them.
SOURCES = [
    *sorted((ROOT / "core/src").glob("*/*.c")),
    *sorted((ROOT / "core/domains").glob("*.c")),
    *sorted((ROOT / "examples/gridworld").glob("*.c")),
    *(ROOT / "examples/balance" / name for name in ("cart_pole.c", "controller.c")),
    *sorted(HERE.glob("*.c")),
    *sorted((HERE / "freestanding").glob("*.c")),
]
INCLUDES = [HERE / "freestanding", HERE, ROOT / "core/include",
            *(ROOT / "examples" / name for name in ("gridworld", "balance", "firmware"))]
# As everywhere the results must be the same bits: no contraction. The rest is for a small module.
FLAGS = ["--target=wasm32", "-std=c99", "-Oz", "-flto", "-mbulk-memory", "-nostdlib",
         "-ffp-contract=off", "-Wall", "-Wextra", "-Werror"]
LINK = [f"-Wl,{option}" for option in
        ("--no-entry", "--gc-sections", "--strip-all", "--lto-O2", "-z,stack-size=65536")]


def compile_module(module):
    command = ["clang", *FLAGS, *(f"-I{folder}" for folder in INCLUDES), *LINK, "-o", module, *SOURCES]
    if subprocess.run(command).returncode != 0:
        sys.exit("build.py: clang failed; it and lld are needed (on Debian: clang lld)")


def main():
    folder = pathlib.Path(sys.argv[1])
    shutil.copytree(HERE / "page", folder, dirs_exist_ok=True)
    if sys.argv[2:]:
        shutil.copy(sys.argv[2], folder / "rlvc.wasm")
    else:
        compile_module(folder / "rlvc.wasm")
    text = base64.b64encode((folder / "rlvc.wasm").read_bytes()).decode()
    (folder / "wasm.js").write_text(f'const WASM = "{text}";\n', encoding="utf-8")


if __name__ == "__main__":
    main()
