# SPDX-License-Identifier: MIT
"""Runs the code of the pages as a reader would copy it: pytest shim/docs

The blocks of a page run in their order, in an empty folder: ```python in one interpreter, ```sh in a shell. The
commands of the front page take longer: test_start.py runs them."""

import os
import pathlib
import subprocess
import sys
import tempfile

from sybil import Sybil
from sybil.parsers.markdown import CodeBlockParser, PythonCodeBlockParser


def run_shell(example):
    """`python` is the interpreter that runs the tests."""
    folder = pathlib.Path(sys.executable).parent
    environment = {**os.environ, "PATH": f"{folder}{os.pathsep}{os.environ['PATH']}"}
    subprocess.run(["bash", "-euc", example.parsed], check=True, env=environment)


def enter_folder(namespace):
    namespace["_folder"] = tempfile.TemporaryDirectory()
    namespace["_before"] = os.getcwd()
    os.chdir(namespace["_folder"].name)


def leave_folder(namespace):
    os.chdir(namespace["_before"])
    namespace["_folder"].cleanup()


pytest_collect_file = Sybil(
    parsers=[PythonCodeBlockParser(), CodeBlockParser(language="sh", evaluator=run_shell)],
    patterns=["*.md", "tutorials/*.md"],
    excludes=["index.md", "api.md"],
    setup=enter_folder,
    teardown=leave_folder,
).pytest()
