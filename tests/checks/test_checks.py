# SPDX-License-Identifier: MIT
"""The checks of tools/check can fail: each rule is broken once, in a core of a few lines."""

import json
import pathlib
import shutil
import subprocess
import sys

import pytest

CHECKS = pathlib.Path(__file__).resolve().parents[2] / "tools/check"
LICENCE = "/* SPDX-License-Identifier: MIT */\n"


class Tree:
    """A project with a core of its own and copies of the checks."""

    def __init__(self, folder):
        self.folder = folder
        shutil.copytree(CHECKS, folder / "tools/check")
        for name in ("core/include/rlvc", "core/src/base", "core/domains"):
            (folder / name).mkdir(parents=True)
        self.write("core/include/rlvc/rng.h", "RLVC_API int rlvc_next(int n);\n")
        self.write("core/src/base/rng.c", "int rlvc_next(int n) { return n + 1; }\n")

    def write(self, name, text):
        (self.folder / name).write_text(LICENCE + text, encoding="utf-8")

    def check(self, name, *arguments):
        """(exit status, all that it printed)"""
        done = subprocess.run([sys.executable, "-B", self.folder / f"tools/check/{name}.py",
                               *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
        return done.returncode, done.stdout

    def rooms(self, *rooms):
        path = self.folder / "tools/check/sources.py"
        text = path.read_text(encoding="utf-8")
        begin = text.index("ROOMS = (")
        end = text.index(")", begin) + 1
        path.write_text(f"{text[:begin]}ROOMS = {rooms!r}{text[end:]}", encoding="utf-8")

    def archive(self):
        objects = []
        for source in (self.folder / "core/src").rglob("*.c"):
            objects.append(str(source.with_suffix(".o")))
            subprocess.run(["gcc", "-O2", "-c", source, "-o", objects[-1]], check=True)
        subprocess.run(["ar", "rcs", self.folder / "core.a", *objects], check=True)
        return self.folder / "core.a"


@pytest.fixture
def tree(tmp_path):
    return Tree(tmp_path)


@pytest.mark.parametrize("header, text, fault", [
    ("base/mean.h", '#include "rng.h"\n', None),
    ("tree/tree.h", '#include "../base/rng.h"\n', None),
    ("base/rng.h", '#include "../tree/tree.h"\n', 'base/rng.h:2: room base includes "../tree/tree.h"'),
    ("base/rng.h", '#include "none.h"\n', "does not exist"),
    ("base/rng.c", '#include "rng.h"\n', "does not include rlvc/float_rules.h first"),
    ("base/rng.h", '#include "rlvc/rng.h"\n#include <stdint.h>\n', None),
    ("base/rng.h", '#include "rlvc/none.h"\n', "is no public header"),
    ("base/rng.h", "#include <stdlib.h>\n", "rng.h:2: includes <stdlib.h>"),
    ("base/rng.h", "/* a double */\n", None),
    ("base/rng.h", "double a;\n", "rng.h:2: a double: double"),
    ("base/rng.h", "static const float a = 1.5f, b = 0x1.8p+1f, c = 1e-3f, d = .5f;\n", None),
    ("base/rng.h", "static const unsigned a = 0x1e3u;\n", None),
    ("base/rng.h", "static const float a = 1.5;\n", "rng.h:2: a double: 1.5"),
    ("base/rng.h", "static const float a = 1e-3;\n", "rng.h:2: a double: 1e-3"),
    ("base/rng.h", "static const float a = 0x1.8p3;\n", "rng.h:2: a double: 0x1.8p3"),
    ("other.h", "int a;\n", "lies in no room"),
    ("other/other.h", "int a;\n", "lies in no room"),
])
def test_sources(tree, header, text, fault):
    tree.rooms("base", "tree")
    for folder in ("tree", "other"):
        (tree.folder / "core/src" / folder).mkdir()
    for name in ("base/rng.h", "tree/tree.h"):
        tree.write(f"core/src/{name}", "int a;\n")
    tree.write(f"core/src/{header}", text)
    status, output = tree.check("sources")
    assert status == (1 if fault else 0), output
    assert (fault or " 0 faults") in output


def test_sources_misses_a_licence_and_a_room(tree):
    tree.rooms("base", "gone")
    (tree.folder / "core/src/base/rng.c").write_text("\n", encoding="utf-8")
    status, output = tree.check("sources")
    assert status == 1
    assert "rng.c:1: does not begin with its licence" in output
    assert "core/src/gone: listed" in output


@pytest.mark.parametrize("name, text, fault", [
    ("maze/maze.h", '#include "../cli/cli.h"\n#include "rlvc/rlvc.h"\n', None),
    ("main.cc", '#include "maze/maze.h"\n', None),
    ("cli/more.cc", '#include "../maze/maze.h"\n', 'more.cc:2: room cli includes "../maze/maze.h"'),
    ("other/other.h", "", "lies in no room"),
])
def test_sources_of_run_gridworld(tree, name, text, fault):
    tree.rooms("base")
    for file in ("cli/cli.h", "maze/maze.h", "other/readme"):
        (tree.folder / "tools/run_gridworld" / file).parent.mkdir(parents=True)
        tree.write(f"tools/run_gridworld/{file}", "")
    tree.write(f"tools/run_gridworld/{name}", text)
    status, output = tree.check("sources")
    assert status == (1 if fault else 0), output
    assert (fault or " 0 faults") in output


@pytest.mark.parametrize("text, fault", [
    ("const int rlvc_table[2] = {1, 2};", None),
    ("int rlvc_f(void); int (*const rlvc_table[1])(void) = {rlvc_f};", "needs rlvc_f"),
    ("int rlvc_count;", "rlvc_count, in .bss"),
    ("int rlvc_f(void) { static int count = 3; return count++; }", "count.0, in .data"),
    ("void *malloc(unsigned long); void *rlvc_f(void) { return malloc(3); }", "needs malloc"),
    ("int next(void) { return 1; }", "next is not named rlvc_*"),
])
def test_symbols(tree, text, fault):
    tree.write("core/src/more.c", text)
    status, output = tree.check("symbols", tree.archive())
    assert status == (1 if fault else 0), output
    assert (fault or "needs nothing") in output


@pytest.mark.parametrize("text, fault", [
    ("static int f(int n) { return n < 2 ? n : f(n - 1); }\n"
     "int rlvc_next(int n) { return f(n); }", "f is recursive"),
    ("int rlvc_other(int n);\nint rlvc_next(int n) { return n ? rlvc_other(n) : 0; }\n"
     "int rlvc_other(int n) { return rlvc_next(n - 1); }", "rlvc_next is recursive"),
    ("int rlvc_next(int n) { volatile char a[n]; a[0] = 1; return a[n - 1]; }",
     "rlvc_next has a frame of variable size"),
    ("void *malloc(unsigned long);\nint rlvc_next(int n) { return malloc(8) != 0 ? n : 1; }",
     "malloc is called"),
    ("struct d { int (*shout)(int); } d;\nint rlvc_next(int n) { return d.shout(n); }",
     "calls through a pointer that is no callback"),
    ("int rlvc_other(int n) { return n; }", "rlvc_next is declared in a public header"),
])
def test_stack_faults(tree, text, fault):
    tree.write("core/src/base/rng.c", text)
    status, output = tree.check("stack", "--write")
    assert status == 1
    assert fault in output


def test_stack_goes_stale(tree):
    tree.write("core/src/base/rng.c", "struct d { int (*exhibits)(int); };\n"
               "int rlvc_next(int n) { volatile char a[64] = {1}; return n + a[n]; }\n")
    assert tree.check("stack")[0] == 1
    assert tree.check("stack", "--write") == (0, "")
    assert tree.check("stack") == (0, "")
    # The bytes of a larger array, and a callback, show.
    tree.write("core/src/base/rng.c", "struct d { int (*exhibits)(int); } *d;\n"
               "int rlvc_next(int n) { volatile char a[1024] = {1};\n"
               "    return d->exhibits(n) + a[n]; }\n")
    assert tree.check("stack")[0] == 1
    tree.check("stack", "--write")
    row = next(line for line in (tree.folder / "core/STACK.md").read_text().splitlines()
               if line.startswith("| `rlvc_next`"))
    _, _, bytes_, callback, names, _ = row.split("|")
    assert 1024 < int(bytes_) < 1200 and int(callback) == int(bytes_)
    assert names.strip() == "exhibits"


def test_version(tree):
    tree.write("CMakeLists.txt", "project(rlvc VERSION 1.2.3 LANGUAGES C)\n")
    tree.write("core/include/rlvc/rlvc.h", '#define RLVC_VERSION_MAJOR 1\n'
               '#define RLVC_VERSION_MINOR 2\n#define RLVC_VERSION_PATCH 3\n'
               '#define RLVC_VERSION "1.2.3"\n')
    (tree.folder / "shim/rlvc").mkdir(parents=True)
    tree.write("shim/rlvc/_version.py", '__version__ = "1.2.3"\n')
    tree.write("CHANGELOG.md", "## [1.2.3] - unreleased\n")
    for folder in ("tools/packages/arduino", "tools/packages/esp_idf", "tools/packages/vcpkg"):
        (tree.folder / folder).mkdir(parents=True)
    tree.write("library.json", '{\n    "version": "1.2.3"\n}\n')
    tree.write("tools/packages/arduino/library.properties", "version=1.2.3\n")
    tree.write("tools/packages/vcpkg/vcpkg.json", '{\n  "version": "1.2.3"\n}\n')
    tree.write("tools/packages/esp_idf/idf_component.yml", 'version: "1.2.3"\n')
    assert tree.check("version", "--project", "1.2.3")[0] == 0
    assert tree.check("version", "--project", "1.2.4")[0] == 1
    tree.write("CHANGELOG.md", "## [1.3.0] - unreleased\n")
    assert tree.check("version")[0] == 1
    tree.write("CHANGELOG.md", "## [1.2.3] - unreleased\n")
    tree.write("tools/packages/arduino/library.properties", "version=1.2.2\n")
    assert tree.check("version")[0] == 1


def test_readme(tree):
    (tree.folder / "examples").mkdir()
    tree.write("examples/01_learn.c", "#include <a.h>\nint main(void) { return 0; }\n")
    tree.write("README.md", "Text\n\n```c\n#include <b.h>\n```\n\nText\n")
    assert tree.check("readme")[0] == 1
    assert tree.check("readme", "--write")[0] == 0
    assert tree.check("readme")[0] == 0
    assert "#include <a.h>\nint main(void) { return 0; }\n```\n\nText\n" in \
        (tree.folder / "README.md").read_text()


def test_bits(tree):
    """Programs that differ in a digit are told apart, programs that differ in time are not."""
    for name, value, seconds in [("one", "0.1", 1), ("two", "0.1", 2), ("three", "0.10000001", 1)]:
        program = tree.folder / name
        program.write_text("#!/bin/sh\nfor path; do :; done\n"  # the last argument
                           f"echo '{{\"runs\": [{{\"value\": {value}, \"seconds\": {seconds}}}]}}'"
                           ' >"$path"\n', encoding="utf-8")
        program.chmod(0o755)
    one, two, three = (tree.folder / name for name in ("one", "two", "three"))
    assert tree.check("bits", "--seeds", "1", one, two)[0] == 0
    status, output = tree.check("bits", "--seeds", "1", one, three)
    assert status == 1 and "--seed 1" in output


def test_coverage(tree):
    """What is missed is a fault, unless it is excused; so is an excuse for what is covered or gone."""
    check = tree.folder / "tools/check/coverage.py"
    text = check.read_text(encoding="utf-8")
    begin = text.index("UNREACHABLE = [")
    end = text.index("]", text.index("\n]", begin)) + 1

    def run(missed, excuses):
        check.write_text(f"{text[:begin]}UNREACHABLE = [{excuses}]{text[end:]}", encoding="utf-8")
        summary = {measure: {"count": 9, "covered": 9 - missed.get(measure, 0)}
                   for measure in ("functions", "lines", "branches", "mcdc")}
        file = {"filename": str(tree.folder / "core/src/base/rng.c"), "summary": summary,
                "branches": [[1, 5, 1, 9, 3, 0, 0, 0, 4]],
                "mcdc_records": [[2, 5, 2, 9, 0, 5, [True, False]]]}
        (tree.folder / "all.json").write_text(json.dumps({"data": [{"files": [file]}]}), encoding="utf-8")
        lines = "".join(f"DA:{i},{int(i >= missed.get('lines', 0))}\n" for i in range(9))
        (tree.folder / "all.lcov").write_text(f"SF:{file['filename']}\n{lines}end_of_record\n", encoding="utf-8")
        return tree.check("coverage", tree.folder / "all.json", tree.folder / "all.lcov")

    excuse = 'Unreachable("core/src/base/rng.c", "return n + 1;", {"branches": 1}, "")'
    assert run({}, "")[0] == 0
    status, printed = run({"branches": 1, "mcdc": 1}, "")
    assert status == 1 and ":1:5: never false" in printed and ":2:5: not shown to decide: condition 2" in printed
    assert run({"branches": 1}, excuse)[0] == 0
    assert run({"lines": 1}, "")[0] == 1
    assert run({"branches": 2}, excuse)[0] == 1
    assert run({}, excuse)[0] == 1
    assert run({"branches": 1}, excuse.replace("n + 1", "n + 2"))[0] == 1


def test_an_image_that_has_passed_is_not_run_again(tmp_path):
    image = tmp_path / "image"

    def run(program, status=0):
        image.write_text(f"#!/bin/sh\necho run >> runs\n{program}\n", encoding="utf-8")
        image.chmod(0o755)
        done = subprocess.run([sys.executable, "-B", CHECKS / "image.py", "--status", "--name",
                               "image", "--", image], cwd=tmp_path, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL)
        assert done.returncode == status
        return len((tmp_path / "runs").read_text(encoding="utf-8").splitlines())

    assert [run("exit 3", 1), run("exit 3", 1)] == [1, 2]
    assert [run("exit 0"), run("exit 0")] == [3, 3]
    assert [run("echo 1"), run("echo 1"), run("exit 3", 1)] == [4, 4, 5]


def test_promises(tree):
    """A command that names what does not exist is a fault, and so is a row without one."""
    shutil.copytree(CHECKS.parents[1] / "tests", tree.folder / "tests", ignore=shutil.ignore_patterns("corpus"))
    shutil.copy(CHECKS.parents[1] / "CMakePresets.json", tree.folder)
    for name in ("test", "fuzz", "targets"):
        shutil.copy(CHECKS.parent / name, tree.folder / "tools")

    def faults(command):
        tree.write("core/PROMISES.md", f"| promise | checked by | command | figure |\n|---|\n| a | b | {command} | 0 |\n")
        return tree.check("promises")[0]

    for right in ("`tools/test bits`", "`tools/fuzz 60 log calls`", "`ctest --preset dev -R core.test_rng`",
                  "`RLVC_KILLS=9 python -m pytest -s tests/shim/test_files.py -k kill`", "`tools/targets cortex-m3`"):
        assert faults(right) == 0, right
    for wrong in ("", "tools/test", "`tools/test other`", "`tools/none`", "`tools/fuzz 60 none`", "`make`",
                  "`ctest --preset dev -R core.test_none`", "`ctest --preset none -R core.test_rng`", "`ctest`",
                  "`python -m pytest tests/shim/test_files.py -k none`", "`python -m pytest tests/none.py`",
                  "`tools/targets z80`"):
        assert faults(wrong) == 1, wrong
