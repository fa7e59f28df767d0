// SPDX-License-Identifier: MIT
#include "config.h"
#include "failure.h"
#include "metric.h"

#include <nlohmann/json.hpp>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace rlvc {
namespace {

using nlohmann::json;

constexpr int version = 1;
constexpr size_t text_max = size_t{1} << 24;

// In the order of RLVC_METRIC_*.
constexpr const char *kinds[] = {"plain", "covariance", "change", "discriminant"};

[[noreturn]] void refuse(const std::string &text) {
    throw Failure(RLVC_VISION_E_FORMAT, text);
}

const json &member(const json &object, const char *key) {
    const auto found = object.find(key);
    if (found == object.end())
        refuse(std::string("\"") + key + "\" is missing");
    return *found;
}

float real(const json &value, const char *key, float low, float high) {
    const double number = value.is_number() ? value.get<double>() : NAN;
    if (!(number >= static_cast<double>(low) && number <= static_cast<double>(high)))
        refuse(std::string("\"") + key + "\" is or holds " + value.dump().substr(0, 40) +
               ", which is not a number within its range");
    return static_cast<float>(number);
}

float real(const json &object, const char *key, float high) {
    return real(member(object, key), key, 0, high);
}

uint32_t whole(const json &object, const char *key) {
    const json &value = member(object, key);
    if (!value.is_number_unsigned() || value.get<uint64_t>() > UINT32_MAX)
        refuse(std::string("\"") + key + "\" is not a whole number within its range");
    return value.get<uint32_t>();
}

std::vector<float> reals(const json &object, const char *key, size_t count) {
    const json &list = member(object, key);
    if (!list.is_array() || list.size() != count)
        refuse(std::string("\"") + key + "\" is not a list of " + std::to_string(count) +
               " numbers");
    std::vector<float> numbers;
    for (const json &value : list)
        numbers.push_back(real(value, key, -metric_number_max, metric_number_max));
    return numbers;
}

json json_of(const rlvc_vision_config &config) {
    return {{"descriptor", rlvc_descriptor_name(config.descriptor)},
            {"points", config.points},
            {"radius", config.radius},
            {"form", config.form},
            {"normalise", config.normalise},
            {"axes", config.axes},
            {"places", config.places},
            {"sd", config.sd},
            {"si", config.si},
            {"k", config.k},
            {"threshold", config.threshold},
            {"sigma", config.sigma},
            {"noise", config.noise}};
}

uint8_t byte(const json &object, const char *key) {
    const uint32_t number = whole(object, key);
    if (number > UINT8_MAX)
        refuse(std::string("\"") + key + "\" is out of range");
    return static_cast<uint8_t>(number);
}

rlvc_vision_config config_of(const json &object) {
    const json &name = member(object, "descriptor");
    rlvc_vision_config config{};
    if (!name.is_string() || rlvc_descriptor_named(name.get_ref<const std::string &>().c_str(),
                                                   &config.descriptor) != RLVC_VISION_OK)
        refuse("\"descriptor\" is " + name.dump().substr(0, 40) + ", which is none that is known");
    config.points = whole(object, "points");
    config.radius = whole(object, "radius");
    config.form = byte(object, "form");
    config.normalise = byte(object, "normalise");
    config.axes = byte(object, "axes");
    config.places = object.contains("places") ? byte(object, "places") : 0; // of an older version
    constexpr float any = 1e6f;                                             // check() knows better
    config.sd = real(object, "sd", any);
    config.si = real(object, "si", any);
    config.k = real(object, "k", any);
    config.threshold = real(object, "threshold", any);
    config.sigma = real(object, "sigma", any);
    config.noise = object.contains("noise") ? real(object, "noise", any) : 0; // of an older version
    try {
        check(config);
    } catch (const Failure &failure) {
        refuse(failure.what());
    }
    return config;
}

uint32_t kind_of(const json &object) {
    const json &name = member(object, "kind");
    for (uint32_t kind = 0; kind < std::size(kinds); kind++)
        if (name == kinds[kind])
            return kind;
    refuse("\"kind\" is " + name.dump().substr(0, 40) + ", which is none that is known");
}

void check_kind(const rlvc_vision_config &config, uint32_t kind) {
    if (config.axes > 0 && kind != RLVC_METRIC_DISCRIMINANT)
        refuse("\"axes\" is not 0, but the metric is not discriminant");
}

[[noreturn]] void refuse_file(const char *doing, const char *path) {
    throw Failure(RLVC_VISION_E_FILE,
                  std::string("cannot ") + doing + " " + path + ": " + std::strerror(errno));
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE *)>;

[[noreturn]] void refuse_kind(const char *path) {
    throw Failure(RLVC_VISION_E_FILE, std::string(path) + " is no regular file");
}

// The name of the folder's entry has to last, too.
void sync_folder_of(const std::string &path) {
    const size_t slash = path.rfind('/');
    const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
    const int opened = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (opened < 0)
        return; // a folder that may be written to but not read
    fsync(opened);
    close(opened);
}

// Makes a file beside another: its name, which nobody can foresee, is put after the other's. It has
// the permissions of a new file; to ask for the process's mask would change it for other threads.
int create_beside(std::string &name) {
    std::random_device random;
    char ending[32];
    std::snprintf(ending, sizeof ending, ".%08x%08x", random(), random());
    name += ending;
    return open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
}

bool write_all(int file, const std::string &text) {
    size_t done = 0;
    while (done < text.size()) {
        const ssize_t n = write(file, text.data() + done, text.size() - done);
        if (n < 0 && errno != EINTR)
            return false;
        done += n > 0 ? static_cast<size_t>(n) : 0;
    }
    return true;
}

} // namespace

std::string text_of(const rlvc_metric &metric) {
    json object = json_of(metric.config);
    object["rlvc_metric"] = version;
    object["kind"] = kinds[metric.kind];
    object["tau"] = metric.tau;
    object["step"] = metric.step;
    if (metric.kind != RLVC_METRIC_PLAIN) {
        object["mean"] = metric.mean;
        object["matrix"] = metric.matrix;
    }
    return object.dump() + "\n";
}

rlvc_metric metric_of(const char *text, size_t bytes) {
    if (bytes > text_max)
        refuse("the text is longer than any metric's");
    const json object = json::parse(text, text + bytes, nullptr, false);
    if (!object.is_object())
        refuse("the text is no JSON object");
    if (whole(object, "rlvc_metric") != version)
        refuse("the metric is of version " + member(object, "rlvc_metric").dump() +
               ", but only 1 is known");
    rlvc_metric metric{};
    metric.config = config_of(object);
    metric.kind = kind_of(object);
    check_kind(metric.config, metric.kind);
    metric.tau = real(member(object, "tau"), "tau", 1e-12f, metric_number_max);
    metric.step = real(member(object, "step"), "step", 1e-12f, metric_number_max);
    if (metric.kind != RLVC_METRIC_PLAIN) {
        const size_t n = rlvc_descriptor_dimensions(metric.config.descriptor);
        metric.mean = reals(object, "mean", n);
        metric.matrix = reals(object, "matrix", rlvc_vision_dimensions(&metric.config) * n);
    }
    return metric;
}

std::string read_file(const char *path) {
    struct stat there;
    if (stat(path, &there) != 0)
        refuse_file("open", path);
    if (!S_ISREG(there.st_mode))
        refuse_kind(path); // opening a FIFO would wait
    const File file(std::fopen(path, "rb"), std::fclose);
    if (file == nullptr)
        refuse_file("open", path);
    std::string text;
    char part[4096];
    // One byte past the limit is enough to see that the file is too long.
    while (text.size() <= text_max) {
        const size_t got = std::fread(part, 1, sizeof part, file.get());
        if (got == 0)
            break;
        text.append(part, got);
    }
    if (std::ferror(file.get()) != 0)
        refuse_file("read", path);
    return text;
}

void replace_file(const char *path, const std::string &text) {
    struct stat there;
    const bool exists = lstat(path, &there) == 0;
    if (exists && !S_ISREG(there.st_mode))
        refuse_kind(path);
    if (exists && access(path, W_OK) != 0)
        refuse_file("write", path);
    std::string beside = path;
    const int file = create_beside(beside);
    if (file < 0)
        refuse_file("write", path);
    const bool written = write_all(file, text) &&
                         (!exists || fchmod(file, there.st_mode & 07777) == 0) && fsync(file) == 0;
    const bool closed = close(file) == 0;
    if (!written || !closed || std::rename(beside.c_str(), path) != 0) {
        const int cause = errno;
        std::remove(beside.c_str());
        errno = cause;
        refuse_file("write", path);
    }
    sync_folder_of(path);
}

} // namespace rlvc
