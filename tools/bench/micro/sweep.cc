// SPDX-License-Identifier: MIT
#include "sweep.h"

namespace bench {
namespace {

uint32_t count_ones(const uint64_t *column, uint32_t words) {
    uint32_t present = 0;
    for (uint32_t word = 0; word < words; word++)
        present += static_cast<uint32_t>(__builtin_popcountll(column[word]));
    return present;
}

void sweep_column(const Prepared &data, uint32_t feature, Winner &winner) {
    const uint64_t *column = data.column(feature);
    const uint32_t present = count_ones(column, data.words);
    const uint32_t absent = data.count - present;
    uint32_t x = 0; // samples with the feature below the cutpoint
    for (uint32_t word = 0; word < data.words; word++) {
        uint64_t bits = column[word];
        uint64_t cuts = data.cuts[word];
        for (uint32_t below = word * 64; cuts != 0; below++) {
            if (cuts & 1) {
                uint32_t y = below - x;
                float score = rlvc_score(x, y, present - x, absent - y);
                if (score > winner.cut.score)
                    winner = {{score, below, x, present}, feature};
            }
            x += bits & 1;
            bits >>= 1;
            cuts >>= 1;
        }
        x += static_cast<uint32_t>(__builtin_popcountll(bits));
    }
}

} // namespace

Winner sweep(const Prepared &data) {
    Winner winner = {};
    for (uint32_t feature = 0; feature < data.features; feature++)
        sweep_column(data, feature, winner);
    return winner;
}

Winner search(const Prepared &data) {
    Winner winner = {};
    for (uint32_t feature = 0; feature < data.features; feature++)
        scan(data.column(feature), data.cuts.data(), data.count, feature, winner);
    return winner;
}

} // namespace bench
