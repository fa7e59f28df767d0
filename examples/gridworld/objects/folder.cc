// SPDX-License-Identifier: MIT
#include "objects.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>
#include <stdexcept>

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
        throw std::runtime_error("cannot read '" + folder + "': " + error.message());
    }
    if (paths.empty()) {
        throw std::runtime_error("there is no picture in '" + folder + "'");
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
        if (std::sscanf(name.c_str(), "obj%6d__%3d%n", &number, &angle, &dot) == 2 && number >= 0 &&
            angle >= 0 && name[static_cast<std::size_t>(dot)] == '.') {
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
    if (!fs::is_regular_file(path, error)) {
        throw std::runtime_error(path.string() + ": not a regular file"); // a FIFO would wait
    }
    if (fs::file_size(path, error) == 0 && !error) {
        throw std::runtime_error(path.string() + ": an empty file");
    }
    try {
        picture = cv::imread(path.string(), cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception &) {
        picture.release();
    }
    if (picture.empty()) {
        throw std::runtime_error(path.string() + ": not a picture that can be read");
    }
    if (picture.depth() != CV_8U) {
        throw std::runtime_error(path.string() + ": a picture of 8 bits a channel is wanted");
    }
    if (picture.channels() == 4) {
        cv::cvtColor(picture, picture, cv::COLOR_BGRA2BGR);
    } else if (picture.channels() != 1 && picture.channels() != 3) {
        throw std::runtime_error(path.string() + ": neither grey nor colour");
    }
    return picture;
}

// What all pictures have in common with the first: a picture of another size, or a grey one among
// colours, is a mistake that is better found here than in a poor policy.
void check_alike(const cv::Mat &first, const cv::Mat &picture, const fs::path &path) {
    if (picture.size() != first.size()) {
        throw std::runtime_error(path.string() + ": " + std::to_string(picture.cols) + " x " +
                                 std::to_string(picture.rows) + " pixels among pictures of " +
                                 std::to_string(first.cols) + " x " + std::to_string(first.rows));
    }
    if (picture.channels() != first.channels()) {
        throw std::runtime_error(path.string() + (first.channels() == 1
                                                      ? ": colour among grey pictures"
                                                      : ": grey among colour pictures"));
    }
}

std::vector<Object> render_objects(const std::set<int> &angles, std::size_t count) {
    std::vector<Object> objects(count);
    for (std::size_t i = 0; i < count; i++) {
        objects[i].name = "object" + std::to_string(i + 1);
        for (const int angle : angles) {
            objects[i].views[angle] = render_object(static_cast<uint32_t>(i), angle);
        }
    }
    return objects;
}

std::vector<Object> read_objects(const std::string &folder, const std::set<int> &angles) {
    std::map<std::pair<long, std::string>, Object> all;
    const std::vector<File> files = find_files(folder);
    if (files.front().angle == any_angle && angles != std::set<int>{0}) {
        throw std::runtime_error("the files of '" + folder +
                                 "' are not named objN__ANGLE, so that there is only angle 0");
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

} // namespace

std::vector<Object> find_objects(const std::string &folder, const std::vector<int> &angles,
                                 std::size_t wanted) {
    const std::set<int> all(angles.begin(), angles.end());
    std::vector<Object> objects =
        folder.empty() ? render_objects(all, wanted) : read_objects(folder, all);
    if (objects.size() < wanted) {
        throw std::runtime_error(std::to_string(wanted) + " are wanted, and '" + folder +
                                 "' has only " + std::to_string(objects.size()) +
                                 " objects that are there from all sides wanted");
    }
    return objects;
}
