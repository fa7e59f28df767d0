/* SPDX-License-Identifier: MIT */
/* Extracts the percept of one picture from the vision module, as the package's test does from
 * Python.
 *
 *     seer DESCRIPTOR FORM WIDTH HEIGHT FORMAT METRIC|- < pixels > percept, then its points */
#include <rlvc/vision.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv) {
    rlvc_vision_config config;
    rlvc_vision_error error;
    rlvc_metric *metric = NULL;
    rlvc_extractor *extractor;
    rlvc_picture picture;
    uint32_t descriptor;
    if (argc != 7 || rlvc_descriptor_named(argv[1], &descriptor) ||
        rlvc_vision_config_default(descriptor, &config))
        return 2;
    config.form = (uint8_t)atoi(argv[2]);
    picture.width = (uint32_t)atoi(argv[3]);
    picture.height = (uint32_t)atoi(argv[4]);
    picture.format = (uint32_t)atoi(argv[5]);
    picture.stride = (ptrdiff_t)picture.width * (picture.format == RLVC_PICTURE_GREY ? 1 : 3);
    size_t bytes = (size_t)picture.stride * picture.height;
    uint8_t *pixels = malloc(bytes);
    uint32_t *percept = malloc(rlvc_vision_percept_bytes(&config));
    rlvc_point points[RLVC_POINTS_MAX];
    picture.pixels = pixels;
    if (!pixels || !percept || fread(pixels, 1, bytes, stdin) != bytes)
        return 3;
    if ((strcmp(argv[6], "-") && rlvc_metric_load(argv[6], &metric, &error)) ||
        rlvc_extractor_create(&config, metric, &extractor, &error) ||
        rlvc_extractor_extract(extractor, &picture, percept, rlvc_vision_percept_bytes(&config),
                               points, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    fwrite(percept, 1, rlvc_vision_percept_bytes(&config), stdout);
    fwrite(points, sizeof *points, percept[0], stdout);
    rlvc_extractor_destroy(extractor);
    rlvc_metric_destroy(metric);
    free(percept);
    free(pixels);
    return 0;
}
