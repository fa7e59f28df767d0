// SPDX-License-Identifier: MIT
// The only file of this folder that is built where the vision module is not.
#include "tiled.h"

#include "../cli/failure.h"

void run_tiled(int, char **) {
    throw Failure("tiled: this program was built without vision, which needs OpenCV: install "
                  "libopencv-dev and build again");
}
