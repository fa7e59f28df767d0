/* SPDX-License-Identifier: MIT */
/* make_policy CASE FILE: writes the exported policy of a case. */
#include "cases.h"

#include <stdio.h>
#include <string.h>

static int put(void *ctx, const char *text, size_t bytes) {
    return fwrite(text, 1, bytes, ctx) != bytes;
}

static int export_case(uint32_t i, const char *name, const char *path) {
    rlvc_export_info info;
    learnt made = learn_case(i);
    FILE *file = fopen(path, "w");
    if (!file) {
        perror(path);
        return 2;
    }
    rlvc_status status = rlvc_export_c(made.agent, name, put, file, &info);
    if (fclose(file) != 0 || status != RLVC_OK) {
        fprintf(stderr, "%s: could not be written\n", path);
        return 2;
    }
    printf("%s: %u leaves, %u left, %u bytes of constants\n", name, (unsigned)info.leaves,
           (unsigned)info.compact, (unsigned)info.bytes);
    return 0;
}

int main(int argc, char **argv) {
    static const char *const names[CASES] = CASE_NAMES;
    for (uint32_t i = 0; argc == 3 && i < CASES; i++) {
        if (strcmp(argv[1], names[i]) == 0)
            return export_case(i, names[i], argv[2]);
    }
    fprintf(stderr, "usage: make_policy maze|single|bytes|wide|many|floats|int8s FILE\n");
    return 2;
}
