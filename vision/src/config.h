// SPDX-License-Identifier: MIT
#ifndef RLVC_VISION_CONFIG_H
#define RLVC_VISION_CONFIG_H

#include "rlvc/vision.h"

namespace rlvc {

// Throws Failure(RLVC_VISION_E_CONFIG) that names the first field out of range.
void check(const rlvc_vision_config &config);

} // namespace rlvc

#endif
