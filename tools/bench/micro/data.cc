// SPDX-License-Identifier: MIT
#include "data.h"

#include "core.h"

#include <cmath>

namespace bench {
namespace {

constexpr uint32_t few_targets = 16;
constexpr uint32_t signal_every = 8;

void set(std::vector<uint64_t> &words, uint32_t bit) {
    words[bit / 64] |= uint64_t{1} << bit % 64;
}

std::vector<uint64_t> make_cuts(uint32_t count, uint32_t words, Targets targets) {
    std::vector<uint64_t> cuts(words, 0);
    if (targets == Targets::few)
        for (uint32_t i = 1; i < few_targets; i++)
            set(cuts, static_cast<uint32_t>(static_cast<uint64_t>(count) * i / few_targets));
    else
        for (uint32_t i = 1; i < count; i++)
            set(cuts, i);
    return cuts;
}

// 64 samples with the feature in 1/2 of them, or where it leans in 7/16 and 9/16.
uint64_t draw(Random &random, int lean) {
    uint64_t coins = random();
    if (lean == 0)
        return coins;
    uint64_t rare = random() & random() & random();
    return lean > 0 ? coins | rare : coins & ~rare;
}

} // namespace

Prepared prepare(uint32_t count, uint32_t features, Targets targets, Columns columns) {
    Random random(count + features);
    Prepared made;
    made.count = count;
    made.features = features;
    made.words = (count + 63) / 64;
    made.cuts = make_cuts(count, made.words, targets);
    made.columns.reserve(static_cast<size_t>(made.words) * features);
    for (uint32_t feature = 0; feature < features; feature++) {
        bool leans = columns == Columns::signal && feature % signal_every == signal_every - 1;
        uint32_t turn = made.words / 5 + static_cast<uint32_t>(random() % (made.words / 2));
        for (uint32_t word = 0; word < made.words; word++)
            made.columns.push_back(draw(random, !leans ? 0 : word < turn ? -1 : 1));
        if (count % 64 != 0)
            made.columns.back() &= (uint64_t{1} << count % 64) - 1;
    }
    return made;
}

Raw make_raw(uint32_t count, uint32_t bits) {
    Random random(count + bits);
    Raw made;
    made.percept_bytes = (RLVC_BITS_PERCEPT_BYTES(bits) + 3) / 4 * 4;
    made.target.resize(count);
    made.percepts.resize(static_cast<size_t>(count) * made.percept_bytes);
    for (float &target : made.target) {
        double sum = 0; // of 12 uniform numbers: nearly normal
        for (int i = 0; i < 12; i++)
            sum += std::ldexp(static_cast<double>(random() >> 11), -53);
        target = static_cast<float>(sum - 6);
    }
    for (unsigned char &byte : made.percepts)
        byte = static_cast<unsigned char>(random() >> 56);
    return made;
}

} // namespace bench
