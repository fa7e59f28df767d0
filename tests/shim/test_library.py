# SPDX-License-Identifier: MIT
"""The declarations are those of the headers, and a library that is another one is refused."""

import ctypes
import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT

from rlvc import _native, errors
from rlvc.agent import config

HEADERS = [*(ROOT / "core/include/rlvc").glob("*.h"), ROOT / "shim/native/shim.h"]


def test_bindings_are_those_of_the_headers():
    done = subprocess.run(
        [sys.executable, "-B", ROOT / "tools/check/bindings.py"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("kind", ["CORE", "VISION", "OBJECTS"])
def test_every_exported_function_is_declared(kind):
    name = {"CORE": "python", "VISION": "vision", "OBJECTS": "objects"}[kind]
    library = _native.PATH.with_name(f"librlvc-{name}.so")
    if not library.exists():
        pytest.skip("the package has no vision module")
    said = subprocess.run(
        ["nm", "--dynamic", "--defined-only", library], capture_output=True, text=True, check=True
    ).stdout
    assert set(re.findall(r" T (rlvc_\w+)", said)) == set(getattr(_native, kind))


def test_every_function_has_its_types_set():
    for library in (_native.call, _native.long_call):
        for name, (_, arguments) in _native.CORE.items():
            assert getattr(library, name).argtypes == arguments


def test_choices_of_the_config_are_the_constants():
    for field, names in config.CHOICES.items():
        constants = [name for name in vars(_native) if name.startswith(field.upper() + "_")]
        assert [f"{field}_{name}".upper() for name in names] == constants


def test_defaults_of_the_config_are_the_librarys():
    domain, native = _native.Domain(), _native.Config()
    _native.call.rlvc_bits_domain(100, ctypes.byref(domain))
    _native.call.rlvc_config_default(ctypes.byref(native), ctypes.byref(domain), 3)
    assert bytes(config.to_native(config.Config(3), domain)) == bytes(native)


@pytest.mark.parametrize("version", ["0.0.9", "9.9.9", ""])
def test_another_version_is_refused(version):
    with pytest.raises(errors.LibraryError, match="version"):
        _native.check_version(version, _native.PATH)


def test_another_layout_is_refused():
    entries = _native.layout_of(_native.call)
    _native.check_layout(entries, _native.PATH)
    for key in entries:
        with pytest.raises(errors.LibraryError, match=re.escape(key)):
            _native.check_layout({**entries, key: entries[key] + 1}, _native.PATH)
        with pytest.raises(errors.LibraryError, match=re.escape(key)):
            _native.check_layout({k: v for k, v in entries.items() if k != key}, _native.PATH)
    with pytest.raises(errors.LibraryError, match=r"rlvc_config\.more"):
        _native.check_layout({**entries, "rlvc_config.more": 1}, _native.PATH)


KINDS = """
#include "rlvc/rlvc.h"
#include "rlvc/vision.h"
#include "gridworld.h"
#include "shim.h"
#include <stdio.h>
#define KIND(x) \\
    _Generic((x), float: "float", uint8_t: "unsigned", uint16_t: "unsigned", uint32_t: "unsigned", \\
             uint64_t: "unsigned", int32_t: "signed", int64_t: "signed", default: "other")
#define SHOW(type, field) \\
    printf("%s.%s %s %zu\\n", #type, #field, KIND(((type *)0)->field), sizeof ((type *)0)->field);
"""


def test_fields_are_of_the_types_of_c(tmp_path):
    """Import compares sizes and offsets; a float for a number of 32 bits would have both."""
    kinds = {"f": "float", **dict.fromkeys("BHIL", "unsigned"), **dict.fromkeys("il", "signed")}
    fields = {
        (name, field): (kinds.get(getattr(kind, "_type_", None), "other"), ctypes.sizeof(kind))
        for name, struct in _native.STRUCTS.items()
        for field, kind in struct._fields_
    }
    lines = [KINDS, "int main(void) {", *(f"SHOW({name}, {f})" for name, f in fields), "}\n"]
    (tmp_path / "kinds.c").write_text("\n".join(lines), encoding="utf-8")
    folders = ["core/include", "vision/include", "examples/gridworld", "shim/native"]
    include = [f"-I{ROOT / folder}" for folder in folders]
    program = tmp_path / "kinds"
    subprocess.run(["gcc", "-std=c11", *include, "-o", program, tmp_path / "kinds.c"], check=True)
    said = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()
    names, kinds_of_c, sizes = said[::3], said[1::3], map(int, said[2::3])
    in_c = dict(zip(names, zip(kinds_of_c, sizes, strict=True), strict=True))
    assert in_c == {f"{name}.{field}": what for (name, field), what in fields.items()}


@pytest.mark.parametrize("content", [None, b"no library"])
def test_a_missing_or_foreign_library_is_said_to_be_so(tmp_path, content):
    path = tmp_path / "librlvc-python.so"
    if content is not None:
        path.write_bytes(content)
    done = subprocess.run(
        [sys.executable, "-c", "import rlvc"], capture_output=True, text=True,
        env={"RLVC_PYTHON_LIBRARY": str(path), "PYTHONPATH": ":".join(sys.path)},
    )  # fmt: skip
    assert done.returncode == 1
    assert "LibraryError" in done.stderr
    assert str(path) in done.stderr


def said_by_vision(folder):
    """What ``import rlvc.vision`` says where the libraries are those of a folder."""
    done = subprocess.run(
        [sys.executable, "-c", "import rlvc\nimport rlvc.vision"], capture_output=True, text=True,
        env={"RLVC_PYTHON_LIBRARY": str(folder / _native.PATH.name), "PYTHONPATH": ":".join(sys.path)},
    )  # fmt: skip
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1].startswith("ImportError: ")
    return done.stderr.splitlines()[-1]


def test_vision_says_what_to_install(tmp_path):
    """Of a package that was made without it, and of one whose OpenCV is gone."""
    shutil.copy(_native.PATH, tmp_path)
    said = said_by_vision(tmp_path)
    assert "libopencv-dev" in said
    assert "pip install" in said
    for name, rest in (
        ("gone", []),
        ("rlvc-vision", [f"-L{tmp_path}", "-Wl,--no-as-needed", "-lgone"]),
    ):
        subprocess.run(
            ["gcc", "-shared", "-o", tmp_path / f"lib{name}.so", "-x", "c", "/dev/null", *rest], check=True
        )  # fmt: skip
    (tmp_path / "libgone.so").unlink()
    said = said_by_vision(tmp_path)
    assert "libgone.so" in said
    assert "libopencv-dev" in said
