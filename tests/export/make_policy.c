/* SPDX-License-Identifier: MIT */
/* make_policy CASE FILE: writes the exported policy of a case, and of one that takes long a
 * snapshot beside it (FILE.rlvc); or, where CASE is maze_agent, what the agent of the case maze
 * does at every percept, four actions to a byte. */
#include "cases.h"

#include <string.h>

static int put(void *ctx, const char *text, size_t bytes) {
    return fwrite(text, 1, bytes, ctx) != bytes;
}

/* 0, or 2 if the file cannot be written. */
static int save_beside(const learnt *made, const char *path) {
    char beside[1024];
    snprintf(beside, sizeof beside, "%s.rlvc", path);
    FILE *file = fopen(beside, "w+b");
    if (!file) {
        perror(beside);
        return 2;
    }
    save_case(made, file);
    return fclose(file) == 0 ? 0 : 2;
}

static int export_case(uint32_t i, const char *name, const char *path, FILE *file) {
    rlvc_export_info info;
    learnt made = make_case(i, NULL);
    if (rlvc_export_c(made.agent, name, put, file, &info) != RLVC_OK)
        return 2;
    printf("%s: %u leaves, %u left, %u bytes of constants\n", name, (unsigned)info.leaves,
           (unsigned)info.compact, (unsigned)info.bytes);
    return takes_long(i) ? save_beside(&made, path) : 0;
}

static int write_actions(FILE *file) {
    learnt made = make_case(0, NULL);
    fprintf(file, "static const unsigned char maze_agent[%u] = {", (1u << made.bits) / 4u);
    for (uint32_t value = 0, four = 0; value < 1u << made.bits; value++) {
        const unsigned char percept[3] = {(unsigned char)value, (unsigned char)(value >> 8),
                                          (unsigned char)(value >> 16)};
        uint32_t action;
        if (rlvc_predict(made.agent, percept, NULL, &action) != RLVC_OK)
            return 2;
        four = four >> 2 | action << 6;
        if (value % 4u == 3u)
            fprintf(file, value % 128u == 3u ? "\n%u," : "%u,", (unsigned)four);
    }
    fprintf(file, "};\n");
    return 0;
}

static int write_case(const char *name, const char *path, FILE *file) {
    static const char *const names[CASES] = CASE_NAMES;
    for (uint32_t i = 0; i < CASES; i++) {
        if (strcmp(name, names[i]) == 0)
            return export_case(i, name, path, file);
    }
    return strcmp(name, "maze_agent") == 0 ? write_actions(file) : 2;
}

int main(int argc, char **argv) {
    if (argc != 3) {
        fprintf(stderr, "usage: make_policy CASE FILE\n");
        return 2;
    }
    FILE *file = fopen(argv[2], "w");
    if (!file) {
        perror(argv[2]);
        return 2;
    }
    int failed = write_case(argv[1], argv[2], file);
    if (fclose(file) != 0 || failed) {
        fprintf(stderr, "%s: could not be written to %s\n", argv[1], argv[2]);
        return 2;
    }
    return 0;
}
