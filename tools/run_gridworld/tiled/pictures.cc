// SPDX-License-Identifier: MIT
#include "pictures.h"

#include "../failure.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>

namespace {

namespace fs = std::filesystem;

constexpr int any_angle = -1; // of a picture whose name has none

struct File {
    long number; // of the object; the order
    std::string object;
    int angle;
    fs::path path;
};

std::vector<fs::path> list_folder(const std::string &folder) {
    std::vector<fs::path> paths;
    std::error_code error;
    for (const fs::directory_entry &entry : fs::directory_iterator(folder, error)) {
        static const std::set<std::string> suffixes{".png", ".jpg", ".jpeg", ".bmp",
                                                    ".ppm", ".pgm", ".tif",  ".tiff"};
        std::string suffix = entry.path().extension().string();
        std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if (suffixes.count(suffix) && entry.path().filename().string().front() != '.') {
            paths.push_back(entry.path());
        }
    }
    if (error) {
        throw Failure("--images: cannot read '" + folder + "': " + error.message());
    }
    if (paths.empty()) {
        throw Failure("--images: there is no picture in '" + folder + "'");
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}

// COIL-100's names if any file has such a one: the others are then left alone.
std::vector<File> find_files(const std::string &folder) {
    std::vector<File> named, others;
    for (const fs::path &path : list_folder(folder)) {
        int number = 0, angle = 0, dot = 0;
        const std::string name = path.filename().string();
        if (std::sscanf(name.c_str(), "obj%6d__%3d%n", &number, &angle, &dot) == 2 &&
            number >= 0 && angle >= 0 && name[static_cast<std::size_t>(dot)] == '.') {
            named.push_back({number, "obj" + std::to_string(number), angle % 360, path});
        } else {
            others.push_back(
                {static_cast<long>(others.size()), path.stem().string(), any_angle, path});
        }
    }
    return named.empty() ? others : named;
}

cv::Mat read_picture(const fs::path &path) {
    cv::Mat picture;
    std::error_code error;
    if (fs::file_size(path, error) == 0 && !error) {
        throw Failure(path.string() + ": an empty file");
    }
    try {
        picture = cv::imread(path.string(), cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception &) {
        picture.release();
    }
    if (picture.empty()) {
        throw Failure(path.string() + ": not a picture that can be read");
    }
    if (picture.depth() != CV_8U) {
        throw Failure(path.string() + ": a picture of 8 bits a channel is wanted");
    }
    if (picture.channels() == 4) {
        cv::cvtColor(picture, picture, cv::COLOR_BGRA2BGR);
    } else if (picture.channels() != 1 && picture.channels() != 3) {
        throw Failure(path.string() + ": neither grey nor colour");
    }
    return picture;
}

std::set<int> wanted_angles(const TiledOptions &options) {
    std::set<int> angles(options.poses.begin(), options.poses.end());
    angles.insert(options.test_poses.begin(), options.test_poses.end());
    return angles;
}

// What all pictures have in common with the first: a picture of another size, or a grey one among
// colours, is a mistake that is better found here than in a poor policy.
void check_alike(const cv::Mat &first, const cv::Mat &picture, const fs::path &path) {
    if (picture.size() != first.size()) {
        throw Failure(path.string() + ": " + std::to_string(picture.cols) + " x " +
                      std::to_string(picture.rows) + " pixels among pictures of " +
                      std::to_string(first.cols) + " x " + std::to_string(first.rows));
    }
    if (picture.channels() != first.channels()) {
        throw Failure(path.string() + (first.channels() == 1 ? ": colour among grey pictures"
                                                             : ": grey among colour pictures"));
    }
}

std::vector<Object> read_objects(const TiledOptions &options) {
    const std::set<int> angles = wanted_angles(options);
    std::map<std::pair<long, std::string>, Object> all;
    const std::vector<File> files = find_files(options.images);
    if (files.front().angle == any_angle && angles != std::set<int>{0}) {
        throw Failure("--poses: files of '" + options.images +
                      "' are not named objN__ANGLE, so that there is only pose 0");
    }
    cv::Mat first;
    for (const File &file : files) {
        const int angle = file.angle == any_angle ? 0 : file.angle;
        if (angles.count(angle)) {
            const cv::Mat picture = read_picture(file.path);
            if (first.empty()) {
                first = picture;
            }
            check_alike(first, picture, file.path);
            Object &object = all[{file.number, file.object}];
            object.name = file.object;
            object.views[angle] = picture;
        }
    }
    std::vector<Object> objects;
    for (auto &one : all) {
        if (one.second.views.size() == angles.size()) {
            objects.push_back(std::move(one.second));
        }
    }
    return objects;
}

std::vector<Object> render_objects(const TiledOptions &options, uint32_t wanted) {
    std::vector<Object> objects(wanted);
    for (uint32_t i = 0; i < wanted; i++) {
        objects[i].name = "object" + std::to_string(i + 1);
        for (const int angle : wanted_angles(options)) {
            objects[i].views[angle] = render_object(i, angle);
        }
    }
    return objects;
}

} // namespace

std::vector<Object> find_objects(const TiledOptions &options, uint32_t wanted) {
    if (options.images.empty()) {
        return render_objects(options, wanted);
    }
    std::vector<Object> objects = read_objects(options);
    if (objects.size() < wanted) {
        throw Failure("--images: the maze has " + std::to_string(wanted) + " cells, and '" +
                      options.images + "' has only " + std::to_string(objects.size()) +
                      " objects that are there in all poses wanted");
    }
    return objects;
}

cv::Mat disturb(const cv::Mat &picture, const TiledOptions &options, std::mt19937 &random) {
    cv::Mat changed;
    std::uniform_real_distribution<double> light(1.0 - double{options.light},
                                                 1.0 + double{options.light});
    picture.convertTo(changed, CV_32F, options.light > 0.0f ? light(random) : 1.0);
    if (options.blur > 0.0f) {
        cv::GaussianBlur(changed, changed, cv::Size(), double{options.blur});
    }
    if (options.noise > 0.0f) {
        cv::Mat noise(changed.size(), changed.type());
        cv::RNG generator(random());
        generator.fill(noise, cv::RNG::NORMAL, 0.0, double{options.noise});
        changed += noise;
    }
    changed.convertTo(changed, CV_8U);
    if (options.jpeg > 0) {
        std::vector<uchar> bytes;
        cv::imencode(".jpg", changed, bytes,
                     {cv::IMWRITE_JPEG_QUALITY, static_cast<int>(options.jpeg)});
        changed = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
    }
    return changed;
}
