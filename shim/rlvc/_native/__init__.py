# SPDX-License-Identifier: MIT
"""The C library: declared in ``bindings``, loaded by ``library``."""

from .bindings import *  # noqa: F403
from .library import *  # noqa: F403
