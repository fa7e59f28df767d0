// SPDX-License-Identifier: MIT
#include "objects.h"

#include "objects/objects.h"
#include "objects/picture_file.h"

#include <opencv2/imgproc.hpp>

#include <cstdio>
#include <exception>

struct rlvc_shim_objects {
    std::vector<Object> list;
};

namespace {

Reading reading_of(uint32_t side, uint32_t scale_depth) {
    Reading reading;
    reading.width = reading.height = static_cast<int>(side);
    reading.scale_depth = scale_depth != 0;
    return reading;
}

} // namespace

int rlvc_shim_objects_find(const char *folder, const int32_t *angles, uint32_t count,
                           uint32_t wanted, uint32_t side, uint32_t scale_depth,
                           rlvc_shim_objects **objects, char *text, size_t room) try {
    *objects = new rlvc_shim_objects{find_objects(folder, std::vector<int>(angles, angles + count),
                                                  wanted, reading_of(side, scale_depth))};
    return 0;
} catch (const std::exception &error) {
    std::snprintf(text, room, "%s", error.what());
    return -1;
}

int rlvc_shim_objects_read(const char *path, uint32_t side, uint32_t scale_depth,
                           rlvc_shim_objects **objects, char *text, size_t room) try {
    const cv::Mat picture = read_picture(path, reading_of(side, scale_depth));
    *objects = new rlvc_shim_objects{{{path, {{0, picture}}}}};
    return 0;
} catch (const std::exception &error) {
    std::snprintf(text, room, "%s", error.what());
    return -1;
}

void rlvc_shim_objects_size(const rlvc_shim_objects *objects, uint32_t *count, uint32_t *height,
                            uint32_t *width) {
    *count = static_cast<uint32_t>(objects->list.size());
    *height = *width = 0;
    if (*count > 0) {
        const cv::Mat &first = objects->list.front().views.begin()->second;
        *height = static_cast<uint32_t>(first.rows);
        *width = static_cast<uint32_t>(first.cols);
    }
}

const char *rlvc_shim_objects_name(const rlvc_shim_objects *objects, uint32_t index) {
    return objects->list[index].name.c_str();
}

void rlvc_shim_objects_copy(const rlvc_shim_objects *objects, uint32_t index, int32_t angle,
                            uint8_t *pixels) {
    const cv::Mat &view = objects->list[index].views.at(angle);
    cv::Mat copy(view.rows, view.cols, CV_8UC3, pixels);
    cv::cvtColor(view, copy, view.channels() == 1 ? cv::COLOR_GRAY2RGB : cv::COLOR_BGR2RGB);
}

void rlvc_shim_objects_free(rlvc_shim_objects *objects) {
    delete objects;
}
