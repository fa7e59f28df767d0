// SPDX-License-Identifier: MIT
// Made data: the same at each run.
#ifndef RLVC_BENCH_DATA_H
#define RLVC_BENCH_DATA_H

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bench {

// xorshift64*: fast enough to fill a gigabit in no time.
class Random {
  public:
    explicit Random(uint64_t seed) : state_(seed * 2 + 1) {
    }
    uint64_t operator()() {
        state_ ^= state_ >> 12;
        state_ ^= state_ << 25;
        state_ ^= state_ >> 27;
        return state_ * 0x2545f4914f6cdd1dU;
    }

  private:
    uint64_t state_;
};

// What a class looks like once its samples are sorted and detected: F columns and the cutpoints.
struct Prepared {
    uint32_t count;    // samples, N
    uint32_t features; // F
    uint32_t words;    // of a column
    std::vector<uint64_t> cuts;
    std::vector<uint64_t> columns;

    const uint64_t *column(uint32_t feature) const {
        return columns.data() + static_cast<size_t>(feature) * words;
    }
    size_t bytes() const {
        return columns.size() * sizeof(uint64_t);
    }
};

enum class Targets { distinct, few }; // every target another; or 16 of them
enum class Columns {
    noise,
    signal
}; // fair coins; or each 8th column leans at a cutpoint of its own

Prepared prepare(uint32_t count, uint32_t features, Targets targets, Columns columns);

// What comes before: targets as they come, and percepts of random bits.
struct Raw {
    uint32_t percept_bytes;
    std::vector<float> target;
    std::vector<unsigned char> percepts;
};

Raw make_raw(uint32_t count, uint32_t bits);

} // namespace bench

#endif
