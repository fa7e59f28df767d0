// SPDX-License-Identifier: MIT
// bench_search FILE BITS REPEATS: the whole search for a split, from unsorted samples to the best
// feature and cutpoint. FILE holds samples of a target (float32) and a percept (uint32, its lowest
// BITS bits are the features, the low byte first). Prints one JSON object: the median of the
// repeats in seconds of the processor, and the split.
#include "../micro/search_stages.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>

namespace {

struct Record {
    float target;
    unsigned char percept[4];
};

struct Samples {
    std::vector<float> target;
    std::vector<unsigned char> percepts;
};

Samples read(const char *path) {
    Samples samples;
    Record record;
    std::ifstream file(path, std::ios::binary);
    while (file.read(reinterpret_cast<char *>(&record), sizeof record)) {
        samples.target.push_back(record.target);
        samples.percepts.insert(samples.percepts.end(), record.percept, record.percept + 4);
    }
    if (samples.target.empty()) {
        std::fprintf(stderr, "bench_search: cannot read samples from %s\n", path);
        std::exit(2);
    }
    return samples;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

} // namespace

int main(int argc, char **argv) {
    const int bits = argc == 4 ? std::atoi(argv[2]) : 0;
    const int repeats = argc == 4 ? std::atoi(argv[3]) : 0;
    if (bits < 1 || bits > 32 || repeats < 1) {
        std::fprintf(stderr, "usage: bench_search FILE BITS(1..32) REPEATS\n");
        return 2;
    }
    const Samples samples = read(argv[1]);
    std::vector<double> seconds;
    bench::Winner winner = {};
    for (int repeat = 0; repeat < repeats; repeat++) {
        const std::clock_t start = std::clock();
        winner = bench::search(samples.target, samples.percepts, sizeof Record::percept,
                               static_cast<uint32_t>(bits));
        seconds.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    std::printf("{\"seconds\": %.6f, \"feature\": %u, \"below\": %u, \"gain\": %.9g}\n",
                median(seconds), winner.feature, winner.cut.below,
                static_cast<double>(winner.cut.score));
    return 0;
}
