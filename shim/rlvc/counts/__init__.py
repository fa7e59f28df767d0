# SPDX-License-Identifier: MIT
"""Learning from counts of interactions instead of the interactions (``core/include/rlvc/counts.h``)."""
