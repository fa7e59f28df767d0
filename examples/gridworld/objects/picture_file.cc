// SPDX-License-Identifier: MIT
#include "picture_file.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path &path, const std::string &why) {
    throw std::runtime_error(path.string() + ": " + why);
}

std::string read_bytes(const fs::path &path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) {
        refuse(path, "not a regular file"); // a FIFO would wait
    }
    std::ifstream file(path, std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (!file.eof() && file.fail()) {
        refuse(path, "cannot be read");
    }
    if (bytes.empty()) {
        refuse(path, "an empty file");
    }
    return bytes;
}

// The four bytes from `at` on as a number, low byte first; 0 if they are not there.
std::size_t number_at(const std::string &bytes, std::size_t at) {
    std::size_t number = 0;
    for (std::size_t i = 0; i < 4 && at + 4 <= bytes.size(); i++) {
        number |= static_cast<std::size_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    }
    return number;
}

// Decoders make grey of what is missing of a file. So its end is looked for here: a JPEG's behind
// the last scan (a preview in it has an end of its own).
bool is_cut_short(const std::string &bytes) {
    const auto begins = [&bytes](const std::string &magic) {
        return bytes.compare(0, magic.size(), magic) == 0;
    };
    if (begins("\xFF\xD8")) {
        const std::size_t scan = bytes.rfind("\xFF\xDA"), end = bytes.rfind("\xFF\xD9");
        return scan == std::string::npos || end == std::string::npos || end < scan;
    }
    if (begins("\x89PNG")) {
        return bytes.rfind("IEND") == std::string::npos;
    }
    if (begins("RIFF")) {
        return number_at(bytes, 4) + 8 > bytes.size();
    }
    return begins("BM") && number_at(bytes, 2) > bytes.size();
}

cv::Mat decode(const std::string &bytes) {
    const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8U,
                          const_cast<char *>(bytes.data()));
    try {
        return cv::imdecode(encoded, cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR);
    } catch (const cv::Exception &) {
        return {};
    }
}

} // namespace

bool is_picture_name(const fs::path &path) {
    static const std::set<std::string> suffixes{".png", ".jpg", ".jpeg", ".bmp", ".ppm",
                                                ".pgm", ".tif", ".tiff", ".webp"};
    std::string suffix = path.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return suffixes.count(suffix) > 0 && path.filename().string().front() != '.';
}

cv::Mat read_picture(const fs::path &path, const Reading &reading) {
    const std::string bytes = read_bytes(path);
    if (is_cut_short(bytes)) {
        refuse(path, "cut short: the end of the file is missing");
    }
    cv::Mat picture = decode(bytes);
    if (picture.empty()) {
        refuse(path, "not a picture that can be read");
    }
    if (picture.depth() == CV_16U && reading.scale_depth) {
        picture.convertTo(picture, CV_8U, 1.0 / 257.0);
    }
    if (picture.depth() != CV_8U) {
        refuse(path, "not 8 bits a channel; 16 are scaled if scale-depth is set");
    }
    if (picture.channels() != 1 && picture.channels() != 3) {
        refuse(path, "neither grey nor colour");
    }
    if (reading.width > 0) {
        cv::resize(picture, picture, cv::Size(reading.width, reading.height), 0, 0, cv::INTER_AREA);
    }
    return picture;
}
