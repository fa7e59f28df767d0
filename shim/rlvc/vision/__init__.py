# SPDX-License-Identifier: MIT
"""Percepts from pictures (sections 3 and 6.2): colour Harris points with local descriptors.

Needs the vision module, which is in the package if OpenCV was present when it was built. A picture
is an array of uint8: grey [height, width], or colour [height, width, 3] with red first
(``order="bgr"``: blue first). It may have any memory layout, and from 1 x 1 to 32767 x 32767
pixels. Source: ``vision/include/rlvc/vision.h``.
"""

from .config import DESCRIPTORS, VisionConfig
from .extractor import Extractor, Sight
from .eye import Eye
from .joined import Joined
from .metric import METRICS, Metric

__all__ = [
    "DESCRIPTORS",
    "METRICS",
    "Extractor",
    "Eye",
    "Joined",
    "Metric",
    "Sight",
    "VisionConfig",
]
