# SPDX-License-Identifier: MIT
"""The C library: declared, found, loaded and checked."""

from .library import *  # noqa: F403
