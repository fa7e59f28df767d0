// SPDX-License-Identifier: MIT
#include "objects.h"

#include "picture_file.h"

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

// The pictures in a folder and below it, in the order of their paths.
std::vector<fs::path> list_folder(const std::string &folder) {
    std::vector<fs::path> paths;
    std::error_code error, broken_link;
    for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end;
         at.increment(error)) {
        const bool is_folder = at->is_directory(broken_link);
        if (is_folder && at->path().filename().string().front() == '.') {
            at.disable_recursion_pending();
        } else if (!is_folder && is_picture_name(at->path())) {
            paths.push_back(at->path());
        }
    }
    if (error) {
        throw std::runtime_error("cannot read '" + folder + "': " + error.message());
    }
    if (paths.empty()) {
        throw std::runtime_error("there is no picture in '" + folder +
                                 "'; read are BMP, JPEG, PGM, PNG, PPM, TIFF and WebP");
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}

// Each folder an object, its pictures numbered in order.
std::vector<File> number_files(const std::vector<fs::path> &paths) {
    std::vector<File> files;
    long number = -1;
    int angle = 0;
    for (const fs::path &path : paths) {
        const bool next = files.empty() || files.back().path.parent_path() != path.parent_path();
        number += next;
        angle = next ? 0 : angle + 1;
        files.push_back({number, path.parent_path().filename().string(), angle, path});
    }
    return files;
}

// COIL-100's names if any file has such a one, else the files of the folder itself, else those of
// the folders in it: the others are then left alone.
std::vector<File> find_files(const std::string &folder) {
    const std::vector<fs::path> paths = list_folder(folder);
    std::vector<File> named, own;
    for (const fs::path &path : paths) {
        int number = 0, angle = 0, dot = 0;
        const std::string name = path.filename().string();
        if (std::sscanf(name.c_str(), "obj%6d__%3d%n", &number, &angle, &dot) == 2 && number >= 0 &&
            angle >= 0 && name[static_cast<std::size_t>(dot)] == '.') {
            named.push_back({number, "obj" + std::to_string(number), angle % 360, path});
        } else if (fs::path(folder) / name == path) {
            own.push_back({static_cast<long>(own.size()), path.stem().string(), any_angle, path});
        }
    }
    return !named.empty() ? named : !own.empty() ? own : number_files(paths);
}

// What all pictures have in common with the first: a picture of another size, or a grey one among
// colours, is a mistake that is better found here than in a poor policy.
void check_alike(const cv::Mat &first, const cv::Mat &picture, const fs::path &path) {
    if (picture.size() != first.size()) {
        throw std::runtime_error(path.string() + ": " + std::to_string(picture.cols) + " x " +
                                 std::to_string(picture.rows) + " pixels among pictures of " +
                                 std::to_string(first.cols) + " x " + std::to_string(first.rows) +
                                 "; resize scales all alike");
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

std::vector<Object> read_objects(const std::string &folder, const std::set<int> &angles,
                                 const Reading &reading) {
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
            const cv::Mat picture = read_picture(file.path, reading);
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
                                 std::size_t wanted, const Reading &reading) {
    const std::set<int> all(angles.begin(), angles.end());
    std::vector<Object> objects =
        folder.empty() ? render_objects(all, wanted) : read_objects(folder, all, reading);
    if (objects.size() < wanted) {
        throw std::runtime_error(std::to_string(wanted) + " are wanted, and '" + folder +
                                 "' has only " + std::to_string(objects.size()) +
                                 " objects that are there from all sides wanted");
    }
    return objects;
}

std::vector<cv::Mat> find_pictures(const std::string &folder) {
    std::vector<cv::Mat> pictures;
    for (const fs::path &path : list_folder(folder)) {
        pictures.push_back(read_picture(path, {}));
    }
    return pictures;
}
