/* SPDX-License-Identifier: MIT */
/* The report: see report.h. */
#include "report.h"

#include <stdio.h>

#define DRAWS 16u /* percepts of each cell */

static const gridworld_maze *const maze = &gridworld_sutton;

static int is_free(uint32_t cell) {
    return maze->cells[cell] == GRIDWORLD_FREE;
}

/* ------------------------------------------------------------------ the policy */

/* Moves to the exit from each cell: sweeps until nothing changes. */
static void find_distances(uint8_t distance[CELLS]) {
    int changed = 1;
    for (uint32_t cell = 0; cell < CELLS; cell++) {
        distance[cell] = maze->cells[cell] == GRIDWORLD_EXIT ? 0 : CELLS;
    }
    while (changed) {
        changed = 0;
        for (uint32_t cell = 0; cell < CELLS; cell++) {
            for (uint32_t d = 0; d < GRIDWORLD_ACTIONS && is_free(cell); d++) {
                uint8_t over = (uint8_t)(distance[gridworld_neighbour(maze, cell, d)] + 1u);
                if (over < distance[cell]) {
                    distance[cell] = over;
                    changed = 1;
                }
            }
        }
    }
}

static int look_up(struct robot *robot, uint32_t cell, const uint8_t distance[CELLS],
                   gridworld_random *random, struct policy *policy) {
    policy->optimal[cell] = 1;
    for (uint32_t i = 0; i < DRAWS; i++) {
        unsigned char percept[PERCEPT_BYTES];
        uint32_t class_id, action;
        gridworld_encode(maze, DISTRACTORS, cell, random, percept);
        if (rlvc_predict(robot->agent, percept, &class_id, &action) != RLVC_OK) {
            return -1;
        }
        uint32_t next = gridworld_neighbour(maze, cell, action);
        policy->optimal[cell] &= distance[next] < distance[cell];
        if (i == 0) {
            policy->class_id[cell] = (uint16_t)class_id;
            policy->action[cell] = (uint16_t)action;
        }
        if (policy->class_id[cell] != class_id) {
            policy->class_id[cell] = UNCLEAR;
        }
        if (policy->action[cell] != action) {
            policy->action[cell] = UNCLEAR;
        }
    }
    policy->optimal_cells += policy->optimal[cell];
    return 0;
}

int report_policy(struct robot *robot, struct policy *policy) {
    uint8_t distance[CELLS];
    gridworld_random random; /* not the world's: looking must not change what happens */
    gridworld_random_seed(&random, 0);
    find_distances(distance);
    policy->optimal_cells = 0;
    for (uint32_t cell = 0; cell < CELLS; cell++) {
        if (is_free(cell) && look_up(robot, cell, distance, &random, policy) != 0) {
            return -1;
        }
    }
    return 0;
}

/* Which bits the tree tests: bit i of the answer is 1 if it tests bit i. */
static uint32_t bits_used(const struct robot *robot, uint32_t classes) {
    uint32_t bits = 0;
    for (uint32_t i = 0; i + 1u < classes; i++) {
        unsigned char feature[RLVC_BITS_FEATURE_BYTES];
        if (rlvc_split_at(robot->agent, i, NULL, feature) == RLVC_OK) {
            bits |= 1u << rlvc_bits_feature(feature);
        }
    }
    return bits;
}

/* ------------------------------------------------------------------ text */

void report_task(void) {
    printf("Maze      Sutton's, %u x %u, %u free cells\n", (unsigned)maze->width,
           (unsigned)maze->height, (unsigned)maze->free_cells);
    printf("Percepts  %u bits: x 0-3, random 4-14, y 15-17\n", PERCEPT_BITS);
    printf("Learning  %s criterion, %u steps of %u interactions, %u units of work a tick\n",
           CRITERION_NAME, STEPS, STEP_INTERACTIONS, SLICE);
    printf("Memory    %u interactions, %u classes\n", CAPACITY, CLASSES);
    printf("\n   k  interactions  splits  classes  optimal cells\n");
}

void report_step(const struct robot *robot, const struct policy *policy) {
    rlvc_statistics statistics;
    if (rlvc_stats(robot->agent, &statistics) != RLVC_OK) {
        return;
    }
    printf("%4u  %12u  %6u  %7u  %6u of %u\n", (unsigned)(robot->steps - 1u),
           (unsigned)robot->interactions, (unsigned)robot->splits, (unsigned)statistics.classes,
           (unsigned)policy->optimal_cells, (unsigned)maze->free_cells);
}

static void draw_row(uint32_t y, const uint16_t *entries, int width, const char *signs) {
    for (uint32_t cell = y * maze->width; cell < (y + 1u) * maze->width; cell++) {
        uint32_t entry = entries[cell];
        if (maze->cells[cell] == GRIDWORLD_WALL) {
            printf("%.*s", width, "###");
        } else if (!is_free(cell)) {
            printf("%*c", width, '*');
        } else if (entry == UNCLEAR) {
            printf("%*c", width, '?');
        } else if (signs) {
            printf("%*c", width, signs[entry]);
        } else {
            printf("%*u", width, (unsigned)entry);
        }
    }
}

void report_pictures(const struct policy *policy) {
    static const char edges[] = "+---------------------------+    +------------------+\n";
    printf("\n%-29s    Policy\n%s", "Classes", edges);
    for (uint32_t y = 0; y < maze->height; y++) {
        putchar('|');
        draw_row(y, policy->class_id, 3, NULL);
        printf("|    |");
        draw_row(y, policy->action, 2, "^>v<");
        printf("|\n");
    }
    printf("%s\n", edges);
}

void report_summary(struct robot *robot, const struct policy *policy,
                    const struct milestones *reached) {
    rlvc_statistics statistics;
    if (rlvc_stats(robot->agent, &statistics) != RLVC_OK) {
        return;
    }
    printf("  optimal       %u of %u cells", (unsigned)policy->optimal_cells,
           (unsigned)maze->free_cells);
    if (reached->since > 0) {
        printf(", from %u interactions on", (unsigned)reached->since);
    }
    printf("\n  bits used    ");
    uint32_t bits = bits_used(robot, statistics.classes);
    for (uint32_t bit = 0; bit < PERCEPT_BITS; bit++) {
        if (bits >> bit & 1u) {
            printf(" %u", (unsigned)bit);
        }
    }
    printf("\n  classes       %u, depth %u, last split at step k = %u\n",
           (unsigned)statistics.classes, (unsigned)statistics.depth,
           (unsigned)statistics.last_split);
    printf("  interactions  %u\n", (unsigned)robot->interactions);
    printf("  patrols       %u ticks while learning, %u times at the exit\n",
           (unsigned)robot->patrols, (unsigned)robot->arrivals);
}

/* ------------------------------------------------------------------ JSON */

static void json_by_cell(const char *name, const uint16_t *entries, const char *const *names) {
    printf("\"%s\":[", name);
    for (uint32_t cell = 0; cell < CELLS; cell++) {
        uint32_t entry = entries[cell];
        printf("%s", cell == 0 ? "[" : cell % maze->width == 0 ? "],[" : ",");
        if (!is_free(cell) || entry == UNCLEAR) {
            printf("null");
        } else if (names) {
            printf("\"%s\"", names[entry]);
        } else {
            printf("%u", (unsigned)entry);
        }
    }
    printf("]],");
}

static void json_number_or_null(const char *name, uint32_t number) {
    if (number > 0) {
        printf("\"%s\":%u,", name, (unsigned)number);
    } else {
        printf("\"%s\":null,", name);
    }
}

static void json_bits(uint32_t bits) {
    uint32_t random = 0;
    const char *comma = "";
    printf("\"bits_used\":[");
    for (uint32_t bit = 0; bit < PERCEPT_BITS; bit++) {
        if (bits >> bit & 1u) {
            printf("%s%u", comma, (unsigned)bit);
            random += bit >= 4u && bit < 4u + DISTRACTORS;
            comma = ",";
        }
    }
    printf("],\"distractors_used\":%u,", (unsigned)random);
}

static int write_text(void *file, const char *text, size_t bytes) {
    return fwrite(text, 1, bytes, (FILE *)file) != bytes;
}

int report_json(struct robot *robot, const struct policy *policy,
                const struct milestones *reached) {
    static const char *const names[GRIDWORLD_ACTIONS] = {"up", "right", "down", "left"};
    rlvc_statistics statistics;
    if (rlvc_stats(robot->agent, &statistics) != RLVC_OK) {
        return -1;
    }
    printf("{\"version\":1,\"kind\":\"firmware\",\"program\":\"firmware %s\",", rlvc_version());
    printf("\"loop\":{\"slice\":%u,\"ticks\":%u,\"patrols\":%u,\"arrivals\":%u},", SLICE,
           (unsigned)(robot->interactions + robot->patrols), (unsigned)robot->patrols,
           (unsigned)robot->arrivals);
    printf("\"options\":{\"criterion\":\"%s\",\"interactions\":%u,\"steps\":%u,\"seed\":%u,"
           "\"distractors\":%u,\"classes\":%u,\"capacity\":%u},",
           CRITERION_NAME, STEP_INTERACTIONS * (CRITERION == RLVC_CRITERION_RETURNS ? 1u : STEPS),
           STEPS, SEED, DISTRACTORS, CLASSES, CAPACITY);
    printf("\"cells\":%u,\"optimal_cells\":%u,\"interactions\":%u,", (unsigned)maze->free_cells,
           (unsigned)policy->optimal_cells, (unsigned)robot->interactions);
    json_number_or_null("interactions_to_optimal", reached->since);
    json_number_or_null("interactions_to_first_optimal", reached->first);
    printf("\"classes\":%u,\"depth\":%u,\"last_split_step\":%u,", (unsigned)statistics.classes,
           (unsigned)statistics.depth, (unsigned)statistics.last_split);
    json_bits(bits_used(robot, statistics.classes));
    json_by_cell("cell_classes", policy->class_id, NULL);
    json_by_cell("cell_actions", policy->action, names);
    printf("\"tree\":");
    if (rlvc_print(robot->agent, RLVC_PRINT_JSON, write_text, stdout) != RLVC_OK) {
        return -1;
    }
    printf("}\n");
    return ferror(stdout) ? -1 : 0;
}
