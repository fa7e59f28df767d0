# SPDX-License-Identifier: MIT
"""tools/test leaves a stage out if, and only if, nothing has changed since it passed. In a project that has nothing
but this script, and whose cmake passes unless there is a file `broken`."""

import os
import pathlib
import shutil
import subprocess

import pytest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "tools/test"


def make_program(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    path.chmod(0o755)


@pytest.fixture
def project(tmp_path):
    project = tmp_path / "project"
    make_program(project / "tools/setup", "#!/bin/sh\n")
    make_program(tmp_path / "bin/cmake", "#!/bin/sh\nrm -f disturb\n[ ! -e broken ]\n")
    shutil.copy(SCRIPT, project / "tools/test")
    (project / "source.c").write_text("int a;\n", encoding="utf-8")
    return project


def run(project, *arguments, **variables):
    """The last line that it prints, and its exit status."""
    path = f"{project.parent / 'bin'}:{os.environ['PATH']}"
    done = subprocess.run([project / "tools/test", *arguments], env={**os.environ, "PATH": path, **variables},
                          capture_output=True, text=True, check=False)
    return done.stdout.splitlines()[-1], done.returncode


RAN = ("stages: 1 passed, 0 failed, 0 left out (--again runs them)", 0)
LEFT_OUT = ("stages: 0 passed, 0 failed, 1 left out (--again runs them)", 0)
FAILED = ("stages: 0 passed, 1 failed, 0 left out (--again runs them)", 1)


def test_left_out_until_something_changes(project):
    assert run(project, "dev") == RAN
    assert run(project, "dev") == LEFT_OUT
    assert run(project, "asan-ubsan") == RAN, "another stage"
    assert run(project, "dev", "--again") == RAN
    assert run(project, "dev", "asan-ubsan") == ("stages: 0 passed, 0 failed, 2 left out (--again runs them)", 0)
    assert run(project, "dev", RLVC_MODEL_RUNS="3") == RAN, "a variable that tests read"
    assert run(project, "dev") == RAN, "it is gone again"
    (project / "source.c").write_text("int b;\n", encoding="utf-8")
    assert run(project, "dev") == RAN, "a changed file"
    (project / "source.c").rename(project / "other.c")
    assert run(project, "dev") == RAN, "a file of another name"
    (project / "other.c").unlink()
    assert run(project, "dev") == RAN, "a file that is gone"
    assert run(project, "dev") == LEFT_OUT


def test_photographs_are_inputs(project, tmp_path):
    photographs = tmp_path / "photographs"
    photographs.mkdir()
    (photographs / "1.png").write_bytes(b"1")
    assert run(project, "dev", RLVC_COIL100=str(photographs)) == RAN
    assert run(project, "dev", RLVC_COIL100=str(photographs)) == LEFT_OUT
    (photographs / "1.png").write_bytes(b"2")
    assert run(project, "dev", RLVC_COIL100=str(photographs)) == RAN


def test_what_a_stage_exports_is_not_an_input(project):
    script = (project / "tools/test").read_text(encoding="utf-8")
    (project / "tools/test").write_text(script.replace("\nclang() {\n", "\nclang() {\n    export RLVC_OWN=1; return\n"),
                                        encoding="utf-8")
    assert run(project, "clang") == RAN
    assert run(project, "clang") == LEFT_OUT


def test_what_failed_runs_again(project):
    assert run(project, "dev") == RAN
    (project / "broken").touch()
    assert run(project, "dev") == FAILED
    assert run(project, "dev") == FAILED
    (project / "broken").unlink()
    assert run(project, "dev") == RAN


def test_files_that_change_while_a_stage_runs(project):
    assert run(project, "dev") == RAN
    (project / "disturb").touch()
    assert run(project, "dev") == RAN
    assert run(project, "dev") == RAN, "it passed from other files than there are now"
    assert run(project, "dev") == LEFT_OUT
