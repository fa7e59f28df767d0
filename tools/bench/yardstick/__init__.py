# SPDX-License-Identifier: MIT
"""The yardstick: what is learnt from how many interactions, on tasks whose optimum is known."""
