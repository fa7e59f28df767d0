# SPDX-License-Identifier: MIT
"""The world as the learner sees it (section 5): percepts, features, detector and refining oracle."""
