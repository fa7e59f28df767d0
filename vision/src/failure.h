// SPDX-License-Identifier: MIT
// How the inside reports that it cannot go on: a status and a sentence, thrown. The C ABI (api.cc)
// catches all.
#ifndef RLVC_VISION_FAILURE_H
#define RLVC_VISION_FAILURE_H

#include "rlvc/vision.h"

#include <stdexcept>
#include <string>

namespace rlvc {

class Failure : public std::runtime_error {
  public:
    Failure(rlvc_vision_status status, const std::string &text)
        : std::runtime_error(text), status_(status) {
    }
    rlvc_vision_status status() const {
        return status_;
    }

  private:
    rlvc_vision_status status_;
};

} // namespace rlvc

#endif
