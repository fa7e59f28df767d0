# SPDX-License-Identifier: MIT
"""Finds, loads and checks the C library.

The library is loaded twice, which costs nothing: ``call`` keeps the interpreter's lock, for calls
that take less than a microsecond; ``long_call`` releases it, for the others.
"""

from __future__ import annotations

import ctypes as c
import os
import sys
from pathlib import Path
from typing import Any

from .._version import __version__
from ..errors import LibraryError
from .bindings import CORE, STRUCTS, Functions

_SUFFIX = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")
_PREFIX = "" if sys.platform == "win32" else "lib"


def library_path() -> Path:
    """Return the library's path: in the package, or the value of ``RLVC_PYTHON_LIBRARY``."""
    named = os.environ.get("RLVC_PYTHON_LIBRARY")
    if named:
        return Path(named)
    return Path(__file__).with_name(f"{_PREFIX}rlvc-python{_SUFFIX}")


def _load(path: Path, kind: type[c.CDLL]) -> Any:
    if not path.exists():
        raise LibraryError(
            f"{path}: no such library. Installing the package builds it: pip install ."
        )
    try:
        return _declare(kind(str(path)), CORE)
    except (OSError, AttributeError) as error:
        raise LibraryError(f"{path}: cannot be used: {error}") from error


def _declare(library: Any, functions: Functions) -> Any:
    for name, (result, arguments) in functions.items():
        function = getattr(library, name)
        function.restype = result
        function.argtypes = arguments
    return library


def load_optional(name: str, functions: Functions) -> Any:
    """Load one of the libraries that need OpenCV.

    Parameters
    ----------
    name : str
        ``rlvc-vision`` or ``rlvc-objects``.
    functions : dict
        Its functions.

    Returns
    -------
    ctypes.CDLL

    Raises
    ------
    ImportError
        The package was built without the library, or OpenCV is missing. The message says what to
        install.
    """
    path = PATH.with_name(f"{_PREFIX}{name}{_SUFFIX}")
    if not path.exists():
        raise ImportError(
            f"pictures need {path.name}, which this installation of rlvc lacks ({path.parent}): it was "
            "built without OpenCV. On Debian 12: apt-get install libopencv-dev nlohmann-json3-dev, then "
            "install rlvc from source again: "
            f"{sys.executable} -m pip install ."
        )
    try:
        return _declare(c.CDLL(str(path)), functions)
    except (OSError, AttributeError) as error:
        raise ImportError(
            f"{path}: cannot be loaded: {error}. It needs the version of OpenCV that it was built "
            "with. On Debian 12: apt-get install libopencv-dev"
        ) from error


def check_version(found: str, path: Path) -> None:
    """Raise LibraryError if the library and the package have different versions."""
    if found != __version__:
        raise LibraryError(
            f"{path}: has version {found}, but the package has version {__version__}"
        )


def check_layout(entries: dict[str, int], path: Path) -> None:
    """Raise LibraryError if a struct of the library has another layout than in ``bindings``."""
    for name, struct in STRUCTS.items():
        expected = {name: c.sizeof(struct)}
        for field in struct._fields_:
            expected[f"{name}.{field[0]}"] = getattr(struct, field[0]).offset
        for key, value in expected.items():
            if entries.get(key) != value:
                raise LibraryError(
                    f"{path}: {key}: size or offset {entries.get(key)}, expected {value}"
                )
    known = set(STRUCTS)
    for key in entries:
        owner, _, field_name = key.partition(".")
        if owner not in known or (field_name and not hasattr(STRUCTS[owner], field_name)):
            raise LibraryError(f"{path}: {key}: not declared in rlvc._native.bindings")


def layout_of(library: Any) -> dict[str, int]:
    table = library.rlvc_shim_layout()
    entries = {}
    index = 0
    while table[index].name is not None:
        entries[table[index].name.decode()] = table[index].value
        index += 1
    return entries


PATH = library_path()
long_call: Any = _load(PATH, c.CDLL)
check_version(long_call.rlvc_version().decode(), PATH)
check_layout(layout_of(long_call), PATH)
call: Any = _load(PATH, c.PyDLL)
call.rlvc_shim_python_init(
    c.pythonapi.PyGILState_Ensure,
    c.pythonapi.PyGILState_Release,
    c.pythonapi.PyObject_CallFunction,
    c.pythonapi.PyLong_AsLongLong,
    c.pythonapi.PyErr_Fetch,
    c.pythonapi.PyErr_Restore,
    c.pythonapi.Py_DecRef,
)


METHOD_CLASSES: int = c.addressof(c.c_char.in_dll(long_call, "rlvc_method_classes"))
METHOD_PLANNER: int = c.addressof(c.c_char.in_dll(long_call, "rlvc_method_planner"))


def status_text(status: int) -> str:
    """Return the library's description of a status."""
    return str(call.rlvc_status_text(status).decode())
