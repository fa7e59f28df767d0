// SPDX-License-Identifier: MIT
// The inside of the core, for C++.
#ifndef RLVC_BENCH_CORE_H
#define RLVC_BENCH_CORE_H

extern "C" {
#include "aliasing.h"
#include "cutpoint.h"
#include "rlvc/rlvc.h"
#include "score.h"
#include "sort.h"
#include "solver.h"
#include "split.h"
#include "tree.h"
#include "values.h"
}

#endif
