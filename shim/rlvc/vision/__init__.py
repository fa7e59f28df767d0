# SPDX-License-Identifier: MIT
"""Pictures as percepts (sections 3 and 6.2): colour Harris points with local descriptors.

Needs the vision module, which is in the package if OpenCV was there when it was installed. A
picture is an array of uint8: [height, width] of grey, or [height, width, 3] of colour, red first
unless ``order`` says ``"bgr"``; in any layout, from 1 x 1 to 32767 x 32767 pixels. Source:
``vision/include/rlvc/vision.h``.
"""

from .config import DESCRIPTORS, VisionConfig
from .extractor import Extractor, Sight
from .eye import Eye
from .metric import METRICS, Metric

__all__ = ["DESCRIPTORS", "METRICS", "Extractor", "Eye", "Metric", "Sight", "VisionConfig"]
