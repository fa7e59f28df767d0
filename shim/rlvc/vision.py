# SPDX-License-Identifier: MIT
"""Pictures as percepts: needs the vision module, which is made where OpenCV is."""

from __future__ import annotations

import sys

from . import _lib

_PATH = _lib.PATH.with_name(f"{_lib._PREFIX}rlvc-vision{_lib._SUFFIX}")

if not _PATH.exists():
    raise ImportError(
        f"rlvc.vision needs {_PATH.name}, which is not in this installation of rlvc "
        f"({_PATH.parent}). It is made where OpenCV's headers are found: on Debian 12, apt-get install "
        f"libopencv-dev, then install rlvc from its sources again ({sys.executable} -m pip install .)"
    )
