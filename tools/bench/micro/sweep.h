// SPDX-License-Identifier: MIT
// The two searches of prepared columns that are compared.
#ifndef RLVC_BENCH_SWEEP_H
#define RLVC_BENCH_SWEEP_H

#include "search_stages.h"

namespace bench {

// The core's search, column after column.
Winner search(const Prepared &data);

// The same by a plain sweep: the score of every cutpoint, from running counts.
Winner sweep(const Prepared &data);

} // namespace bench

#endif
