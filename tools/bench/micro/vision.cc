// SPDX-License-Identifier: MIT
// How long it takes to see, on one thread: each part of the extraction beside OpenCV's own
// goodFeaturesToTrack (Harris, grey) and SIFT at as many points. The pictures are drawn here, and
// one is a photograph if RLVC_COIL100 names a folder of them. At the end the table of the same
// times as shares of goodFeaturesToTrack's. Each time is the least of several repetitions, in CPU
// time.
#include "eye.h"
#include "picture.h"

#include "opencv_picture.h"

#include "rlvc/vision.h"

#include <benchmark/benchmark.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr int repetitions = 7;
constexpr const char *reference = "goodFeaturesToTrack";

// Overlapping cards and discs of random colours on a shaded ground, slightly blurred, with noise.
cv::Mat drawn(cv::Size size) {
    cv::RNG random(7);
    cv::Mat image(size, CV_8UC3);
    for (int x = 0; x < size.width; x++)
        image.col(x).setTo(cv::Scalar::all(60 + 80 * x / size.width));
    const auto colour = [&random] {
        return cv::Scalar(random.uniform(0, 255), random.uniform(0, 255), random.uniform(0, 255));
    };
    for (int i = 0; i < size.area() / 400; i++) {
        const cv::Point centre(random.uniform(0, size.width), random.uniform(0, size.height));
        const int side = random.uniform(4, 24);
        if (i % 2 == 0)
            cv::circle(image, centre, side / 2, colour(), cv::FILLED);
        else
            cv::rectangle(image, centre, centre + cv::Point(side, side), colour(), cv::FILLED);
    }
    cv::GaussianBlur(image, image, cv::Size(3, 3), 0.8);
    cv::Mat noise(size, CV_8UC3);
    random.fill(noise, cv::RNG::UNIFORM, 0, 6);
    return image + noise;
}

// The first photograph of the folder, side by side until the size is filled.
cv::Mat photographed(const std::string &folder, cv::Size size) {
    std::vector<std::string> paths;
    for (const auto &entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".png")
            paths.push_back(entry.path());
    if (paths.empty())
        throw std::runtime_error("no .png in " + folder);
    const cv::Mat one = cv::imread(*std::min_element(paths.begin(), paths.end()));
    if (one.empty())
        throw std::runtime_error("not a picture: the first .png of " + folder);
    cv::Mat all;
    cv::repeat(one, size.height / one.rows + 1, size.width / one.cols + 1, all);
    return all(cv::Rect(cv::Point(), size)).clone();
}

rlvc_vision_config config_of(uint32_t descriptor, bool normalise) {
    rlvc_vision_config config;
    rlvc_vision_config_default(descriptor, &config);
    config.normalise = normalise;
    return config;
}

// ---------------------------------------------------------------------------- OpenCV's own

void good_features(benchmark::State &state, const cv::Mat &image) {
    const rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_INVARIANTS, false);
    cv::Mat grey;
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
    std::vector<cv::Point2f> points;
    for (auto _ : state)
        cv::goodFeaturesToTrack(grey, points, static_cast<int>(config.points),
                                static_cast<double>(config.threshold), config.radius, cv::noArray(),
                                3, true, static_cast<double>(config.k));
}

void sift(benchmark::State &state, const cv::Mat &image) {
    const rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_SIFT, false);
    cv::Mat grey, vectors;
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
    std::vector<cv::KeyPoint> points;
    const cv::Ptr<cv::SIFT> own = cv::SIFT::create(static_cast<int>(config.points));
    for (auto _ : state)
        own->detectAndCompute(grey, cv::noArray(), points, vectors);
}

// ---------------------------------------------------------------------------- ours

void light(benchmark::State &state, const cv::Mat &image) {
    const rlvc::Picture picture = rlvc::checked(picture_of(image), "picture");
    for (auto _ : state)
        benchmark::DoNotOptimize(rlvc::light_of(picture, true));
}

void points(benchmark::State &state, const cv::Mat &image) {
    const rlvc::Picture picture = rlvc::checked(picture_of(image), "picture");
    rlvc::Harris harris(config_of(RLVC_DESCRIPTOR_INVARIANTS, false));
    const float gain[3] = {1, 1, 1};
    size_t count = 0;
    for (auto _ : state)
        count = harris.find(picture, gain).size();
    state.counters["points"] = static_cast<double>(count);
}

void vectors(benchmark::State &state, const cv::Mat &image, uint32_t descriptor) {
    const rlvc::Picture picture = rlvc::checked(picture_of(image), "picture");
    rlvc::Eye eye(config_of(descriptor, false));
    eye.look(picture);
    const std::vector<rlvc_point> found = eye.points();
    for (auto _ : state)
        eye.look_at(picture, found);
}

// All of it, through the C ABI.
void percept(benchmark::State &state, const cv::Mat &image, uint32_t descriptor, bool normalise) {
    const rlvc_vision_config config = config_of(descriptor, normalise);
    const rlvc_picture picture = picture_of(image);
    std::vector<float> record(rlvc_vision_percept_bytes(&config) / 4);
    rlvc_extractor *extractor = nullptr;
    rlvc_vision_error error;
    if (rlvc_extractor_create(&config, nullptr, &extractor, &error) != RLVC_VISION_OK)
        state.SkipWithError(error.text);
    for (auto _ : state)
        if (rlvc_extractor_extract(extractor, &picture, record.data(), 4 * record.size(), nullptr,
                                   &error) != RLVC_VISION_OK)
            state.SkipWithError(error.text);
    rlvc_extractor_destroy(extractor);
}

// ---------------------------------------------------------------------------- the table

template <class Run> void add(const std::string &name, Run run) {
    benchmark::RegisterBenchmark(name.c_str(), run)
        ->Unit(benchmark::kMicrosecond)
        ->Repetitions(repetitions)
        ->MinTime(0.1);
}

void add_all(const std::string &name, const cv::Mat &image) {
    add(name + "/" + reference, [image](benchmark::State &s) { good_features(s, image); });
    add(name + "/OpenCV's SIFT", [image](benchmark::State &s) { sift(s, image); });
    add(name + "/light", [image](benchmark::State &s) { light(s, image); });
    add(name + "/points", [image](benchmark::State &s) { points(s, image); });
    for (uint32_t d = 0; d < RLVC_DESCRIPTORS; d++) {
        const std::string of = rlvc_descriptor_name(d);
        add(name + "/vectors: " + of, [image, d](benchmark::State &s) { vectors(s, image, d); });
        add(name + "/percept: " + of,
            [image, d](benchmark::State &s) { percept(s, image, d, false); });
    }
    add(name + "/percept: sqrt-invariants, light",
        [image](benchmark::State &s) { percept(s, image, RLVC_DESCRIPTOR_SQRT_INVARIANTS, true); });
}

class Table : public benchmark::ConsoleReporter {
  public:
    void ReportRuns(const std::vector<Run> &runs) override {
        for (const Run &run : runs) {
            if (run.run_type != Run::RT_Iteration || run.error_occurred)
                continue;
            const std::string &name = run.run_name.function_name;
            const double time = run.GetAdjustedCPUTime();
            const auto known = least_.find(name);
            if (known == least_.end())
                order_.push_back(name);
            least_[name] = known == least_.end() ? time : std::min(known->second, time);
        }
    }
    void Finalize() override {
        std::ostream &out = GetOutputStream();
        char line[160];
        for (const std::string &name : order_) {
            const auto beside = least_.find(name.substr(0, name.find('/') + 1) + reference);
            std::snprintf(line, sizeof line, "%-58s %9.1f us", name.c_str(), least_[name]);
            out << line;
            if (beside != least_.end()) {
                std::snprintf(line, sizeof line, "  %6.2f x %s", least_[name] / beside->second,
                              reference);
                out << line;
            }
            out << "\n";
        }
    }

  private:
    std::map<std::string, double> least_;
    std::vector<std::string> order_;
};

} // namespace

int main(int argc, char **argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv))
        return 1;
    cv::setNumThreads(1);
    const char *folder = std::getenv("RLVC_COIL100");
    try {
        for (const cv::Size size : {cv::Size(128, 128), cv::Size(640, 480)}) {
            const std::string sides =
                std::to_string(size.width) + " x " + std::to_string(size.height);
            add_all("drawn, " + sides, drawn(size));
            if (folder != nullptr && *folder != '\0')
                add_all("photograph, " + sides, photographed(folder, size));
        }
    } catch (const std::exception &exception) {
        std::fprintf(stderr, "bench_vision: %s\n", exception.what());
        return 1;
    }
    Table table;
    benchmark::RunSpecifiedBenchmarks(&table);
    return 0;
}
