// SPDX-License-Identifier: MIT
// The stages of a search for the best split of a class (section 4.2.3), one after the other.
#ifndef RLVC_BENCH_SEARCH_STAGES_H
#define RLVC_BENCH_SEARCH_STAGES_H

#include "core.h"
#include "data.h"

namespace bench {

struct Winner {
    rlvc_cutpoint cut;
    uint32_t feature;
};

// Keys in the order of time, as the agent finds them in its ring.
std::vector<rlvc_sample> samples_of(const std::vector<float> &target);

// By ascending target.
void sort(std::vector<rlvc_sample> &samples);

// A cutpoint between every two samples of distinct targets.
void mark(const std::vector<rlvc_sample> &samples, std::vector<uint64_t> &cuts);

// Columns of features [first, first + 64) or as many as there are, `stride` words apart. Returns
// how many.
uint32_t detect(const rlvc_domain &domain, const rlvc_samples &samples, uint32_t first,
                size_t stride, std::vector<uint64_t> &columns);

// Looks for a better cutpoint than the winner's in one column.
void scan(const uint64_t *column, const uint64_t *cuts, uint32_t count, uint32_t feature,
          Winner &winner);

// All of it, on percepts of bits, by the core's own search. Of the winner's cut only the score and
// `below` are known.
Winner search(const std::vector<float> &target, const std::vector<unsigned char> &percepts,
              uint32_t percept_bytes, uint32_t bits);

} // namespace bench

#endif
