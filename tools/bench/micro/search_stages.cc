// SPDX-License-Identifier: MIT
#include "search_stages.h"

#include <algorithm>

namespace bench {

std::vector<rlvc_sample> samples_of(const std::vector<float> &target) {
    std::vector<rlvc_sample> samples(target.size());
    for (size_t i = 0; i < samples.size(); i++)
        samples[i] = {rlvc_target_key(target[i]), static_cast<uint32_t>(i)};
    return samples;
}

void sort(std::vector<rlvc_sample> &samples) {
    alignas(8) unsigned char scratch[RLVC_SORT_SCRATCH_BYTES];
    rlvc_sort_cursor sort;
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
    rlvc_cutpoint_cursor scan;
    rlvc_cutpoint_begin(&scan, column, cuts, count, 0, winner.cut.score);
    while (!scan.done)
        rlvc_cutpoint_step(&scan, RLVC_BUDGET_UNBOUNDED);
    if (scan.best.score > winner.cut.score)
        winner = {scan.best, feature};
}

Winner search(const std::vector<float> &target, const std::vector<unsigned char> &percepts,
              uint32_t percept_bytes, uint32_t bits) {
    rlvc_domain domain;
    rlvc_config config;
    rlvc_bits_domain(bits, &domain);
    rlvc_config_default(&config, &domain, 1);
    config.capacity = static_cast<uint32_t>(target.size());

    rlvc_workspace space;
    rlvc_arena arena = {nullptr, 0};
    rlvc_workspace_carve(&space, &arena, &config, domain.feature_bytes);
    std::vector<uint64_t> block(arena.used / sizeof(uint64_t));
    arena = {reinterpret_cast<unsigned char *>(block.data()), 0};
    rlvc_workspace_carve(&space, &arena, &config, domain.feature_bytes);
    for (uint32_t i = 0; i < config.capacity; i++)
        space.rows.sample[i] = {rlvc_target_key(target[i]), i};

    rlvc_replay replay = {};
    replay.percept = const_cast<unsigned char *>(percepts.data());
    replay.percept_bytes = percept_bytes;
    rlvc_target_input aliasing = {};
    const rlvc_split_input input = {&space,
                                    &replay,
                                    &aliasing,
                                    &domain,
                                    config.min_samples,
                                    config.smallest_effect,
                                    config.score == RLVC_SCORE_RANKS};
    const uint32_t first[2] = {0, config.capacity};
    rlvc_split_cursor search;
    rlvc_split_search_begin(&search, &input, first);
    for (uint32_t used; !search.done;)
        rlvc_split_search_step(&search, &input, RLVC_BUDGET_UNBOUNDED, &used);
    rlvc_split about;
    const void *feature = rlvc_split_search_result(&search, &space, &about);
    Winner winner = {};
    if (feature) {
        const rlvc_table &table = search.evidence.per_action.table;
        const auto count = [](rlvc_count n) { return static_cast<uint32_t>(n); };
        winner = {{about.score, count(table.a + table.b), count(table.a), count(table.a + table.c)},
                  rlvc_bits_feature(feature)};
    }
    return winner;
}

} // namespace bench
