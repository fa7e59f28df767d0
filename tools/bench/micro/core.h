// SPDX-License-Identifier: MIT
// The inside of the core, for C++.
#ifndef RLVC_BENCH_CORE_H
#define RLVC_BENCH_CORE_H

extern "C" {
#include "samples/targets.h"
#include "split/cutpoint.h"
#include "rlvc/rlvc.h"
#include "stats/score.h"
#include "samples/sort.h"
#include "solve/value_iteration.h"
#include "split/split_search.h"
#include "tree/tree.h"
#include "tree/values.h"
}

#endif
