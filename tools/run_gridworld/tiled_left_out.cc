// SPDX-License-Identifier: MIT
// In place of tiled/, where the vision module was left out.
#include "tiled.h"

#include "failure.h"

void run_tiled(int, char **) {
    throw Failure("tiled: this program was built without vision, which needs OpenCV: install "
                  "libopencv-dev and build anew");
}
