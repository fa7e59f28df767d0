# SPDX-License-Identifier: MIT
"""The reference of C has an anchor for each function that the package calls, and for each status."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import c_reference

from rlvc._native import bindings


def test_every_function_has_an_anchor(tmp_path):
    reference = c_reference.Reference()
    reference.write(tmp_path)
    names = [name for name in (*bindings.CORE, *bindings.VISION) if not name.startswith(("gridworld_", "rlvc_shim_"))]
    assert len(names) > 60
    for name in [*names, "RLVC_OK", "RLVC_E_PERCEPT", "RLVC_AGENT_BYTES"]:
        assert name in reference.page_of, f"{name} has no place in the reference of C"
        page = (tmp_path / f"{reference.page_of[name]}.md").read_text(encoding="utf-8")
        assert f"{{#{name}}}" in page or f'id="{name}"' in page
