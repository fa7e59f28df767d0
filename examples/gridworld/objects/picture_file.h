// SPDX-License-Identifier: MIT
// A file with a picture, as people have them.
#ifndef GRIDWORLD_PICTURE_FILE_H
#define GRIDWORLD_PICTURE_FILE_H

#include "objects.h"

#include <filesystem>

// Is it by its name a picture, not a hidden file?
bool is_picture_name(const std::filesystem::path &path);

// BGR or grey, 8 bits, upright as its EXIF orientation says; without transparency. Throws
// std::runtime_error that names the file: it is none that can be read, or its end is missing.
cv::Mat read_picture(const std::filesystem::path &path, const Reading &reading);

#endif
