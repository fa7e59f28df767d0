// SPDX-License-Identifier: MIT
// The mean colours of a picture's quarters: what tells places apart where nothing has corners.
#ifndef RLVC_VISION_QUARTERS_H
#define RLVC_VISION_QUARTERS_H

#include "picture.h"

namespace rlvc {

// v [RLVC_DIMENSIONS_QUARTERS]: red, green and blue of the upper left quarter, the upper right, the
// lower left and the lower right. A side of an odd number of pixels is cut before its middle one;
// of a side of one pixel both halves are that pixel.
void quarters(const Picture &picture, float *v);

} // namespace rlvc

#endif
