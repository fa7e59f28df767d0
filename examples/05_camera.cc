// SPDX-License-Identifier: MIT
// A camera learns what to do about what it sees, from rewards alone, and then does it.
//
//     05_camera learn MODEL SOURCE SOURCE ...    frames of source n, from 0, call for action n
//     05_camera run MODEL SOURCE [--overlay DIR] prints the class and the action of each frame
//
// A source is a folder of frames, a video file, or the number of a camera. Learning takes 200
// frames of a camera; running goes on until the user stops it. While learning, each frame is an
// episode of one interaction: the agent acts at random, and its reward is 1 if its action is the
// number of the source, 0 if not. It is never told the right action. The overlay shows the points
// of the frame and, in another colour, those that match the tests on the way to its class.
// MODEL.metric and MODEL.agent keep what was learnt.
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "opencv_picture.h"

#include "rlvc/descriptors.h"
#include "rlvc/rlvc.h"
#include "rlvc/snapshot.h"
#include "rlvc/vision.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

namespace {

namespace fs = std::filesystem;

constexpr int camera_frames = 200;
constexpr int rounds = 8; // how often each frame is shown while learning
constexpr float share = 0.1f;

void check(int status, const std::string &what) {
    if (status != 0) {
        throw std::runtime_error(
            what + (status > -100 ? rlvc_status_text(static_cast<rlvc_status>(status)) : ""));
    }
}

void check(rlvc_vision_status status, const rlvc_vision_error &error) {
    if (status != RLVC_VISION_OK) {
        throw std::runtime_error(error.text[0] ? error.text : rlvc_vision_status_text(status));
    }
}

// Frames, one after another.
class Source {
  public:
    explicit Source(const std::string &name) : name_(name) {
        if (fs::is_directory(name)) {
            for (const fs::directory_entry &entry : fs::directory_iterator(name)) {
                if (entry.is_regular_file()) {
                    files_.push_back(entry.path().string());
                }
            }
            std::sort(files_.begin(), files_.end());
            folder_ = true;
        } else if (name.find_first_not_of("0123456789") == std::string::npos) {
            camera_ = capture_.open(std::atoi(name.c_str()));
        } else {
            capture_.open(name);
        }
        if (folder_ ? files_.empty() : !capture_.isOpened()) {
            throw std::runtime_error(name + ": no frames there");
        }
    }

    bool next(cv::Mat &frame) {
        if (!folder_) {
            return capture_.read(frame);
        }
        if (at_ == files_.size()) {
            return false;
        }
        frame = cv::imread(files_[at_++], cv::IMREAD_COLOR);
        if (frame.empty()) {
            throw std::runtime_error(files_[at_ - 1] + ": not a picture that can be read");
        }
        return true;
    }

    bool camera() const {
        return camera_;
    }

  private:
    std::string name_;
    cv::VideoCapture capture_;
    std::vector<std::string> files_;
    std::size_t at_ = 0;
    bool folder_ = false, camera_ = false;
};

// From a frame to a percept, by a metric.
class Eye {
  public:
    explicit Eye(rlvc_metric *metric) : metric_(metric, rlvc_metric_destroy) {
        rlvc_vision_error error{};
        rlvc_metric_config(metric, &config_);
        config_.form = RLVC_FORM_INT8;
        rlvc_extractor *made = nullptr;
        check(rlvc_extractor_create(&config_, metric, &made, &error), error);
        extractor_.reset(made);
        check(rlvc_descriptors_default(&descriptors_, config_.points,
                                       rlvc_vision_dimensions(&config_), RLVC_DESCRIPTORS_INT8,
                                       rlvc_metric_tau(metric) / rlvc_extractor_step(made)),
              "");
        check(rlvc_descriptors_domain(&descriptors_, &domain_), "");
        points_.resize(config_.points);
        percept_.resize(domain_.percept_bytes / 4);
    }

    const void *look(const cv::Mat &frame) {
        rlvc_vision_error error{};
        const rlvc_picture picture = picture_of(frame);
        check(rlvc_extractor_extract(extractor_.get(), &picture, percept_.data(),
                                     domain_.percept_bytes, points_.data(), &error),
              error);
        return percept_.data();
    }

    rlvc_metric *metric() const {
        return metric_.get();
    }
    const rlvc_domain &domain() const {
        return domain_;
    }
    uint32_t count() const {
        return percept_[0];
    }
    cv::Point point(uint32_t i) const {
        return {cvRound(points_[i].x), cvRound(points_[i].y)};
    }
    uint32_t nearest(const void *feature) const {
        uint32_t at = 0;
        check(rlvc_descriptors_nearest(&descriptors_, percept_.data(), feature, &at, nullptr), "");
        return at;
    }

  private:
    std::unique_ptr<rlvc_metric, void (*)(rlvc_metric *)> metric_;
    std::unique_ptr<rlvc_extractor, void (*)(rlvc_extractor *)> extractor_{nullptr,
                                                                           rlvc_extractor_destroy};
    rlvc_vision_config config_{};
    rlvc_descriptors descriptors_{};
    rlvc_domain domain_{};
    std::vector<rlvc_point> points_;
    std::vector<uint32_t> percept_;
};

// Reads a file, and nothing else: a FIFO would make it wait.
std::string read_file(const std::string &name) {
    std::ifstream file;
    if (fs::is_regular_file(name)) {
        file.open(name, std::ios::binary);
    }
    if (!file.is_open()) {
        throw std::runtime_error(name + ": cannot be read");
    }
    return {std::istreambuf_iterator<char>(file), {}};
}

bool write_all(int file, const std::string &content) {
    size_t done = 0;
    for (ssize_t n = 1; n > 0 && done < content.size();) {
        n = write(file, content.data() + done, content.size() - done);
        done += n > 0 ? static_cast<size_t>(n) : 0;
    }
    return done == content.size();
}

// Writes a temporary file with an unpredictable name and renames it, so that there is always the
// old file or the new one. Links and devices are refused; permissions are kept.
void replace_file(const std::string &name, const std::string &content) {
    struct stat there;
    const bool exists = lstat(name.c_str(), &there) == 0;
    std::string beside = name + ".XXXXXX";
    const int file = exists && !S_ISREG(there.st_mode) ? -1 : mkstemp(beside.data());
    if (file < 0) {
        throw std::runtime_error(name + ": cannot be written");
    }
    const mode_t mode = exists ? there.st_mode & 07777 : 0644;
    const bool whole = write_all(file, content) && fchmod(file, mode) == 0 && fsync(file) == 0;
    if (close(file) != 0 || !whole || std::rename(beside.c_str(), name.c_str()) != 0) {
        std::remove(beside.c_str());
        throw std::runtime_error(name + ": cannot be written");
    }
}

// Room in memory for two snapshots.
class Snapshots {
  public:
    Snapshots(uint32_t slot_bytes, const std::string &first = "") : bytes_(first) {
        bytes_.resize(2 * static_cast<size_t>(slot_bytes));
        store_.ctx = bytes_.data();
        store_.slot_bytes = slot_bytes;
        store_.read = [](void *ctx, uint32_t offset, void *buffer, uint32_t bytes) {
            std::memcpy(buffer, static_cast<char *>(ctx) + offset, bytes);
            return 0;
        };
        store_.write = [](void *ctx, uint32_t offset, const void *buffer, uint32_t bytes) {
            std::memcpy(static_cast<char *>(ctx) + offset, buffer, bytes);
            return 0;
        };
    }

    const rlvc_store *store() const {
        return &store_;
    }

    std::string newest() const {
        rlvc_snapshot_info info;
        check(rlvc_snapshot_peek(&store_, &info), "");
        return bytes_.substr(static_cast<size_t>(info.slot) * store_.slot_bytes, info.bytes);
    }

  private:
    std::string bytes_;
    rlvc_store store_{};
};

struct Agent {
    std::unique_ptr<uint64_t[]> memory;
    std::size_t bytes = 0;
    rlvc_agent *agent = nullptr;

    Agent(const rlvc_config &config, const rlvc_domain &domain) {
        check(rlvc_agent_size(&config, &domain, &bytes), "");
        memory.reset(new uint64_t[bytes / 8 + 1]);
    }
};

rlvc_config config_for(const rlvc_domain &domain, uint32_t actions, uint32_t interactions) {
    rlvc_config config;
    check(rlvc_config_default(&config, &domain, actions), "");
    config.capacity = interactions;
    config.epsilon = 1.0f;
    return config;
}

uint32_t slot_bytes(const rlvc_config &config, const rlvc_domain &domain) {
    uint32_t bytes = 0;
    check(rlvc_snapshot_size(&config, &domain, &bytes), "");
    return bytes;
}

struct Lesson {
    cv::Mat frame;
    uint32_t action;
};

std::vector<Lesson> read_lessons(const std::vector<std::string> &sources) {
    std::vector<Lesson> lessons;
    for (uint32_t action = 0; action < sources.size(); action++) {
        Source source(sources[action]);
        cv::Mat frame;
        for (int i = 0; (!source.camera() || i < camera_frames) && source.next(frame); i++) {
            lessons.push_back({frame.clone(), action});
        }
    }
    return lessons;
}

rlvc_metric *fit(const std::vector<Lesson> &lessons) {
    rlvc_vision_error error{};
    rlvc_vision_config config;
    rlvc_fitter *fitter = nullptr;
    rlvc_metric *metric = nullptr;
    check(rlvc_vision_config_default(RLVC_DESCRIPTOR_SIFT_UPRIGHT, &config), error);
    config.sigma = 4.0f;
    config.form = RLVC_FORM_INT8;
    check(rlvc_fitter_create(&config, &fitter, &error), error);
    const std::unique_ptr<rlvc_fitter, void (*)(rlvc_fitter *)> owner(fitter, rlvc_fitter_destroy);
    for (const Lesson &lesson : lessons) {
        const rlvc_picture picture = picture_of(lesson.frame);
        check(rlvc_fitter_add(fitter, &picture, lesson.action, &error), error);
    }
    check(rlvc_fitter_fit(fitter, RLVC_METRIC_PLAIN, share, &metric, &error), error);
    return metric;
}

void learn(const std::string &model, const std::vector<std::string> &sources) {
    const std::vector<Lesson> lessons = read_lessons(sources);
    Eye eye(fit(lessons));
    const uint32_t actions = static_cast<uint32_t>(sources.size());
    const uint32_t interactions = static_cast<uint32_t>(lessons.size()) * rounds;
    const rlvc_config config = config_for(eye.domain(), actions, interactions);
    Agent mind(config, eye.domain());
    check(rlvc_agent_init(&config, &eye.domain(), mind.memory.get(), mind.bytes, &mind.agent), "");
    for (int round = 0; round < rounds; round++) {
        for (const Lesson &lesson : lessons) {
            rlvc_choice choice;
            check(rlvc_begin(mind.agent, eye.look(lesson.frame)), "");
            check(rlvc_act(mind.agent, &choice), "");
            const float reward = choice.action == lesson.action ? 1.0f : 0.0f;
            check(rlvc_observe(mind.agent, choice, reward, nullptr, RLVC_TERMINATED), "");
        }
    }
    rlvc_progress progress;
    check(rlvc_learn(mind.agent, RLVC_BUDGET_UNBOUNDED, &progress), "");
    rlvc_vision_error error{};
    check(rlvc_metric_save(eye.metric(), (model + ".metric").c_str(), &error), error);
    const Snapshots snapshots(slot_bytes(config, eye.domain()));
    check(rlvc_save(mind.agent, snapshots.store()), "");
    // The config must be known to make sense of a snapshot, so its numbers stand before it.
    replace_file(model + ".agent", std::to_string(actions) + " " + std::to_string(interactions) +
                                       "\n" + snapshots.newest());
    rlvc_statistics statistics;
    check(rlvc_stats(mind.agent, &statistics), "");
    std::printf("%u frames, %u interactions, %u classes\n", static_cast<unsigned>(lessons.size()),
                interactions, statistics.classes);
}

// Walks down the tree as the agent does, marking where its tests found their features. Split j of
// class c leaves what lacks the feature in c, and gives what has it the new class j + 1.
void draw(cv::Mat &frame, const Eye &eye, const rlvc_agent *agent, const void *percept,
          const std::string &text) {
    const rlvc_domain &domain = eye.domain();
    std::vector<unsigned char> feature(domain.feature_bytes);
    rlvc_statistics statistics;
    rlvc_split split;
    uint32_t class_id = 0;
    for (uint32_t i = 0; i < eye.count(); i++) {
        cv::circle(frame, eye.point(i), 3, {0, 255, 255}, 1, cv::LINE_AA);
    }
    check(rlvc_stats(agent, &statistics), "");
    for (uint32_t j = 0; j + 1 < statistics.classes; j++) {
        uint8_t present = 0;
        check(rlvc_split_at(agent, j, &split, feature.data()), "");
        if (split.class_id == class_id &&
            domain.exhibits(domain.ctx, percept, feature.data(), &present) == 0 && present) {
            class_id = j + 1;
            cv::circle(frame, eye.point(eye.nearest(feature.data())), 6, {0, 0, 255}, 2,
                       cv::LINE_AA);
        }
    }
    cv::putText(frame, text, {4, frame.rows - 6}, cv::FONT_HERSHEY_SIMPLEX, 0.4, {255, 255, 255});
}

void run(const std::string &model, const std::string &name, const std::string &overlay) {
    rlvc_vision_error error{};
    rlvc_metric *metric = nullptr;
    check(rlvc_metric_load((model + ".metric").c_str(), &metric, &error), error);
    Eye eye(metric);
    const std::string file = model + ".agent", content = read_file(file);
    const size_t line = content.find('\n');
    unsigned actions = 0, interactions = 0;
    if (line == std::string::npos ||
        std::sscanf(content.c_str(), "%9u %9u\n", &actions, &interactions) != 2) {
        throw std::runtime_error(file + ": is no agent of this program");
    }
    const rlvc_config config = config_for(eye.domain(), actions, interactions);
    Agent mind(config, eye.domain());
    const uint32_t bytes = slot_bytes(config, eye.domain());
    const Snapshots snapshots(bytes, content.substr(line + 1, bytes));
    check(rlvc_load(&config, &eye.domain(), mind.memory.get(), mind.bytes, snapshots.store(),
                    &mind.agent),
          file + ": ");
    Source source(name);
    cv::Mat frame;
    for (int i = 0; source.next(frame); i++) {
        uint32_t class_id = 0, action = 0;
        const void *percept = eye.look(frame);
        check(rlvc_predict(mind.agent, percept, &class_id, &action), "");
        const std::string text = "frame " + std::to_string(i) + " class " +
                                 std::to_string(class_id) + " action " + std::to_string(action);
        std::printf("%s\n", text.c_str());
        if (!overlay.empty()) {
            char number[32];
            std::snprintf(number, sizeof number, "/%06d.png", i);
            draw(frame, eye, mind.agent, percept, text);
            if (!cv::imwrite(overlay + number, frame)) {
                throw std::runtime_error(overlay + number + ": cannot be written");
            }
        }
    }
}

} // namespace

int main(int argc, char **argv) {
    std::signal(SIGXFSZ, SIG_IGN); // at a limit of a file's size the write fails, and says so
    const std::vector<std::string> words(argv + 1, argv + argc);
    try {
        if (words.size() >= 4 && words[0] == "learn") {
            learn(words[1], {words.begin() + 2, words.end()});
        } else if (words.size() == 3 && words[0] == "run") {
            run(words[1], words[2], "");
        } else if (words.size() == 5 && words[0] == "run" && words[3] == "--overlay") {
            run(words[1], words[2], words[4]);
        } else {
            std::fprintf(stderr, "usage: 05_camera learn MODEL SOURCE SOURCE ...\n"
                                 "       05_camera run MODEL SOURCE [--overlay DIR]\n");
            return 2;
        }
        return 0;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "05_camera: %s\n", error.what());
        return 2;
    }
}
