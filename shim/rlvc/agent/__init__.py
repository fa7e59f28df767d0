# SPDX-License-Identifier: MIT
"""The agent and its policies."""
