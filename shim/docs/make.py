#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the pages that mkdocs builds the site from: make.py FOLDER

copies the pages, the pictures and the notebooks, builds the playground, writes a page for each header of C, and one of
the results. RLVC_PLAYGROUND_MODULE names an rlvc.wasm of the same sources, if one was built already."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

import c_reference
import results_page

import rlvc

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
COPIED = ("*.md", "*.css", "pictures/*.svg", "tutorials/*.md", "notebooks/*.ipynb")


def copy(folder):
    for pattern in COPIED:
        for file in HERE.glob(pattern):
            target = folder / file.relative_to(HERE)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(file, target)


def front_page(folder):
    """The front page gets the whole width, for the playground. Forges would show this as a table."""
    page = folder / "index.md"
    page.write_text("---\nhide: [navigation, toc]\n---\n" + page.read_text(encoding="utf-8"), encoding="utf-8")


def check_api():
    """Each public name of the package must be in its reference, by itself or with its module."""
    listed = set(re.findall(r"^::: (\S+)", (HERE / "api.md").read_text(encoding="utf-8"), re.MULTILINE))
    public = {name: getattr(rlvc, name) for name in rlvc.__all__ if not name.startswith("__")}
    missing = []
    for name, thing in public.items():
        module = getattr(thing, "__module__", "")
        if not {f"rlvc.{name}", module, f"{module}.{name}", getattr(thing, "__name__", "")} & listed:
            missing.append(name)
    if missing:
        sys.exit(f"shim/docs/api.md: not in the reference: {', '.join(missing)}")


def main():
    folder = pathlib.Path(sys.argv[1])
    check_api()
    copy(folder)
    front_page(folder)
    results_page.write(folder)
    c_reference.Reference().write(folder / "c")
    built = [name for name in [os.environ.get("RLVC_PLAYGROUND_MODULE")] if name]
    subprocess.run([sys.executable, ROOT / "examples/playground/build.py", folder / "playground", *built], check=True)


if __name__ == "__main__":
    main()
