// SPDX-License-Identifier: MIT
#include "stages.h"

#include <algorithm>

namespace bench {

std::vector<rlvc_sample> samples_of(const std::vector<float> &target) {
    std::vector<rlvc_sample> samples(target.size());
    for (size_t i = 0; i < samples.size(); i++)
        samples[i] = {rlvc_key_of_target(target[i]), static_cast<uint32_t>(i)};
    return samples;
}

void sort(std::vector<rlvc_sample> &samples) {
    alignas(8) unsigned char scratch[RLVC_SORT_SCRATCH_BYTES];
    rlvc_sort sort;
    rlvc_sort_begin(&sort, samples.data(), static_cast<uint32_t>(samples.size()), scratch);
    while (!sort.done)
        rlvc_sort_step(&sort, RLVC_BUDGET_UNBOUNDED);
}

void mark(const std::vector<rlvc_sample> &samples, std::vector<uint64_t> &cuts) {
    cuts.assign((samples.size() + 63) / 64, 0);
    for (size_t i = 1; i < samples.size(); i++)
        cuts[i / 64] |= uint64_t{samples[i - 1].key != samples[i].key} << i % 64;
}

uint32_t detect(const rlvc_domain &domain, const rlvc_samples &samples, uint32_t first,
                size_t stride, std::vector<uint64_t> &columns) {
    unsigned char block[RLVC_DETECT_FEATURES * RLVC_BITS_FEATURE_BYTES];
    uint32_t written;
    domain.candidates(domain.ctx, &samples, first, RLVC_DETECT_FEATURES, block, &written);
    columns.resize(stride * written);
    for (uint32_t at = 0; at < samples.count; at += RLVC_DETECT_SAMPLES) {
        uint64_t bits[RLVC_DETECT_FEATURES];
        uint32_t n = std::min(samples.count - at, RLVC_DETECT_SAMPLES);
        domain.detect(domain.ctx, &samples, at, n, block, written, bits);
        for (uint32_t j = 0; j < written; j++)
            columns[stride * j + at / 64] = bits[j];
    }
    return written;
}

void scan(const uint64_t *column, const uint64_t *cuts, uint32_t count, uint32_t feature,
          Winner &winner) {
    rlvc_scan scan;
    rlvc_scan_begin(&scan, column, cuts, count, RLVC_SCORE_GAIN, winner.cut.score);
    while (!scan.done)
        rlvc_scan_step(&scan, RLVC_BUDGET_UNBOUNDED);
    if (scan.best.score > winner.cut.score)
        winner = {scan.best, feature};
}

Winner search(const std::vector<float> &target, const std::vector<unsigned char> &percepts,
              uint32_t percept_bytes, uint32_t bits) {
    rlvc_domain domain;
    rlvc_bits_domain(bits, &domain);
    std::vector<rlvc_sample> samples = samples_of(target);
    const auto count = static_cast<uint32_t>(samples.size());
    const rlvc_samples view = {percepts.data(), samples.data(), percept_bytes, count};
    const size_t stride = (samples.size() + 63) / 64 | 1; // odd: columns on other lines of a cache
    std::vector<uint64_t> cuts;
    std::vector<uint64_t> columns;
    Winner winner = {};
    sort(samples);
    mark(samples, cuts);
    for (uint32_t first = 0; first < bits; first += RLVC_DETECT_FEATURES) {
        uint32_t written = detect(domain, view, first, stride, columns);
        for (uint32_t j = 0; j < written; j++)
            scan(&columns[stride * j], cuts.data(), count, first + j, winner);
    }
    return winner;
}

} // namespace bench
