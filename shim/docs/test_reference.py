# SPDX-License-Identifier: MIT
"""The reference of C has an anchor for each function that the package calls, and for each status; that of Python, as
tools/docs has built it, one for each public name, and no role of a docstring as it was written."""

import importlib
import pathlib
import pkgutil
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import c_reference

import rlvc
from rlvc._native import bindings

SITE = pathlib.Path(__file__).resolve().parents[2] / "build/docs/site"


def test_every_function_has_an_anchor(tmp_path):
    reference = c_reference.Reference()
    reference.write(tmp_path)
    names = [name for name in (*bindings.CORE, *bindings.VISION) if not name.startswith(("gridworld_", "rlvc_shim_"))]
    assert len(names) > 60
    for name in [*names, "RLVC_OK", "RLVC_E_PERCEPT", "RLVC_AGENT_BYTES"]:
        assert name in reference.page_of, f"{name} has no place in the reference of C"
        page = (tmp_path / f"{reference.page_of[name]}.md").read_text(encoding="utf-8")
        assert f"{{#{name}}}" in page or f'id="{name}"' in page


def resolve(path):
    """What a dotted name means, or None."""
    for cut in range(path.count("."), -1, -1):
        module, *names = [".".join(path.split(".")[: cut + 1]), *path.split(".")[cut + 1 :]]
        try:
            thing = importlib.import_module(module)
            for name in names:
                thing = getattr(thing, name)
        except (ImportError, AttributeError):
            continue
        return thing
    return None


def test_every_public_name_has_an_anchor():
    page = (SITE / "api.html").read_text(encoding="utf-8")
    shown = [resolve(name) for name in set(re.findall(r'id="(rlvc[\w.]*)"', page))]
    missing = []
    for module in pkgutil.walk_packages(rlvc.__path__, "rlvc."):
        if any(part.startswith("_") for part in module.name.split(".")):
            continue
        module = importlib.import_module(module.name)
        public = [name for name in getattr(module, "__all__", []) if not name.startswith("__")]
        missing += [f"{module.__name__}.{name}" for name in public
                    if not any(getattr(module, name) is thing for thing in shown)]  # fmt: skip
    assert missing == []
    assert not re.search(r":(?:class|func|meth|mod|attr|data|exc):", page)
