# SPDX-License-Identifier: MIT
"""The command ``python -m rlvc``."""
