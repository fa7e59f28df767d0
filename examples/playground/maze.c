/* SPDX-License-Identifier: MIT */
/* The maze of the page: an agent learns it, as by run_gridworld binary, in slices.
 *
 *     maze_new                        a maze from the text at text_start(), and an agent
 *     maze_tick                       interactions, or a slice of a learning step
 *     maze_view, maze_classes, ...    numbers and cells to be drawn
 *     maze_tree, maze_policy, ...     write text
 *
 * The same maze, options and seed give the tree of run_gridworld, bit for bit. */
#include "maze_defaults.h"
#include "maze_values.h"
#include "page.h"

#include "rlvc/rlvc.h"

#define SLICE (1u << 18) /* of learning in a tick: about a millisecond */
#define DRAWS 16u        /* percepts of a cell that are looked at, with other distractors */
#define DISCOUNT 0.9f
#define SETTLED 1e-6
#define EQUAL 1e-4 /* actions whose values differ by less are equally good */
#define POLICY_EFFORT (UINT64_C(1) << 24)

/* What maze_new returns. */
enum { MADE, BAD_MAZE, BAD_OPTIONS, NO_MEMORY };

/* Read by the page as 32-bit numbers, in this order. */
struct view {
    uint32_t width, height, free_cells;
    uint32_t bits, x_bits, y_bits;
    uint32_t interactions;
    uint32_t schedule; /* interactions after which run_gridworld stops */
    uint32_t step;     /* learning steps finished */
    uint32_t classes, depth, refused;
    uint32_t cell; /* where the agent is */
    uint32_t learning;
    uint32_t optimal; /* cells in which the policy is optimal */
    uint32_t bytes;   /* of the agent's block */
    uint32_t episodes;
    float episode_return; /* sum of the rewards of the last episode */
    float mean;           /* value of the policy, discounted, over the free cells */
    float mean_optimal;
};

static struct {
    gridworld_maze maze;
    gridworld world;
    rlvc_domain domain;
    rlvc_agent *agent;
    gridworld_defaults defaults;
    gridworld_error error;
    int returns;
    float slip, sum;
    double *values, *optimal; /* [cells] of the policy, and of the best one */
    uint16_t *class_id;       /* [cells] 65535: a wall or an exit; 65534: percepts differ */
    unsigned char *action;    /* [cells] */
    unsigned char *percept;
    struct view view;
} lab;

#define CLASS_NONE 65535u
#define CLASS_MIXED 65534u

/* ------------------------------------------------------------------ making */

static void configure(rlvc_config *config, float epsilon, uint32_t seed) {
    const gridworld_defaults *defaults = &lab.defaults;
    (void)rlvc_config_default(config, &lab.domain, GRIDWORLD_ACTIONS);
    config->seed = seed;
    config->discount = DISCOUNT;
    config->alpha = defaults->alpha;
    config->alpha_known = defaults->alpha_known;
    config->successors = (uint8_t)defaults->successors;
    config->epsilon = epsilon < 0.0f ? defaults->epsilon : epsilon;
    config->classes = defaults->classes;
    config->capacity = defaults->interactions;
    if (lab.returns) {
        config->criterion = RLVC_CRITERION_RETURNS;
        config->continuing = 1;
        config->explore = RLVC_EXPLORE_UNIFORM;
    }
}

static int make_arrays(void) {
    const uint32_t cells = lab.maze.width * lab.maze.height;
    lab.values = memory_take(cells * sizeof *lab.values);
    lab.optimal = memory_take(cells * sizeof *lab.optimal);
    lab.class_id = memory_take(cells * sizeof *lab.class_id);
    lab.action = memory_take(cells);
    lab.percept = memory_take(GRIDWORLD_PERCEPT_BYTES(GRIDWORLD_BITS_MAX));
    return lab.values && lab.optimal && lab.class_id && lab.action && lab.percept;
}

static int make_agent(float epsilon, uint32_t seed) {
    rlvc_config config;
    size_t bytes = 0;
    void *block;
    configure(&config, epsilon, seed);
    if (rlvc_agent_size(&config, &lab.domain, &bytes) != RLVC_OK) {
        return BAD_OPTIONS;
    }
    block = memory_take(bytes);
    if (!block || rlvc_agent_init(&config, &lab.domain, block, bytes, &lab.agent) != RLVC_OK) {
        return NO_MEMORY;
    }
    lab.view.bytes = (uint32_t)bytes;
    return MADE;
}

static const void *see(void) {
    gridworld_percept(&lab.world, lab.percept);
    return lab.percept;
}

static void begin_view(uint32_t distractors) {
    const struct view empty = {0};
    const uint32_t bytes = lab.view.bytes;
    lab.view = empty;
    lab.view.bytes = bytes;
    lab.view.width = lab.maze.width;
    lab.view.height = lab.maze.height;
    lab.view.free_cells = lab.maze.free_cells;
    lab.view.bits = gridworld_bits(&lab.maze, distractors);
    lab.view.x_bits = gridworld_x_bits(&lab.maze);
    lab.view.y_bits = gridworld_y_bits(&lab.maze);
    lab.view.schedule = lab.defaults.interactions * (lab.returns ? lab.defaults.steps : 1u);
}

static float mean_of(const double *v) {
    const uint32_t cells = lab.maze.width * lab.maze.height;
    double sum = 0.0;
    uint32_t i;
    for (i = 0; i < cells; i++) {
        sum += v[i];
    }
    return (float)(sum / lab.maze.free_cells);
}

static void look(void);

/* Makes a maze of the text, and an agent that knows nothing; what there was before is gone.
 * @param epsilon negative: the default
 * @return MADE, ...; after BAD_MAZE maze_fault() says what is wrong. */
EXPORT(maze_new)
int maze_new(int returns, uint32_t distractors, float slip, float epsilon, uint32_t seed) {
    const gridworld_learner learner = {returns, 0, 0};
    unsigned char *cells;
    int made;
    memory_release(0);
    lab.agent = NULL;
    cells = memory_take(text_bytes());
    if (!cells || gridworld_parse(&lab.maze, (const char *)text_start(), text_bytes(), cells,
                                  text_bytes(), &lab.error) != 0) {
        return cells ? BAD_MAZE : NO_MEMORY;
    }
    lab.returns = returns;
    lab.slip = slip;
    lab.sum = 0.0f;
    lab.defaults = gridworld_defaults_for(&learner);
    if (gridworld_init(&lab.world, &lab.maze, distractors, slip, seed) != 0 ||
        rlvc_bits_domain(gridworld_bits(&lab.maze, distractors), &lab.domain) != RLVC_OK) {
        return BAD_OPTIONS;
    }
    made = make_arrays() ? make_agent(epsilon, seed) : NO_MEMORY;
    if (made != MADE) {
        return made;
    }
    begin_view(distractors);
    (void)gridworld_values(&lab.maze, NULL, DISCOUNT, slip, SETTLED, lab.optimal);
    lab.view.mean_optimal = mean_of(lab.optimal);
    (void)rlvc_begin(lab.agent, see());
    look();
    return MADE;
}

/* Writes what is wrong with the maze, and returns the line (0: all of it). */
EXPORT(maze_fault) uint32_t maze_fault(void) {
    text_begin();
    if (lab.error.what) {
        (void)text_write(NULL, lab.error.what, __builtin_strlen(lab.error.what));
    }
    return lab.error.line;
}

EXPORT(maze_fault_column) uint32_t maze_fault_column(void) {
    return lab.error.column;
}

/* ------------------------------------------------------------------ learning */

/* Interactions before the end of learning step k, as run_gridworld counts them. */
static uint32_t interactions_until(uint32_t k) {
    const uint64_t all = (uint64_t)lab.defaults.interactions * (k + 1u);
    return (uint32_t)(lab.returns ? all : all / lab.defaults.steps);
}

static int interact(void) {
    rlvc_choice choice;
    float reward = 0.0f;
    (void)rlvc_act(lab.agent, &choice);
    lab.view.interactions++;
    if (gridworld_step(&lab.world, choice.action, &reward) != 1) {
        lab.sum += reward;
        (void)rlvc_observe(lab.agent, choice, reward, see(), RLVC_GOES_ON);
        return TICK_ON;
    }
    (void)rlvc_observe(lab.agent, choice, reward, NULL, RLVC_TERMINATED);
    lab.view.episode_return = lab.sum + reward;
    lab.view.episodes++;
    lab.sum = 0.0f;
    gridworld_reset(&lab.world);
    (void)rlvc_begin(lab.agent, see());
    return TICK_EPISODE_OVER;
}

static int learn(void) {
    rlvc_progress progress;
    rlvc_statistics statistics;
    (void)rlvc_learn(lab.agent, SLICE, &progress);
    lab.view.learning = !progress.done;
    if (!progress.done) {
        return TICK_ON;
    }
    (void)rlvc_stats(lab.agent, &statistics);
    lab.view.step = statistics.step;
    lab.view.classes = statistics.classes;
    lab.view.depth = statistics.depth;
    lab.view.refused = statistics.refused;
    look();
    return TICK_LEARNT;
}

/* Does at most so many interactions, and stops where an episode ends or a learning step begins; or
 * does a slice of one. TICK_FAILED: there is no agent, as maze_new failed or was not called. */
EXPORT(maze_tick) int maze_tick(uint32_t count) {
    if (!lab.agent) {
        return TICK_FAILED;
    }
    while (!lab.view.learning && count-- > 0) {
        const int over = interact();
        lab.view.learning = lab.view.interactions >= interactions_until(lab.view.step);
        if (over == TICK_EPISODE_OVER) {
            return over;
        }
    }
    return lab.view.learning ? learn() : TICK_ON;
}

/* ------------------------------------------------------------------ looking */

EXPORT(maze_view) const struct view *maze_view(void) {
    lab.view.cell = lab.world.cell;
    return &lab.view;
}

EXPORT(maze_classes) const uint16_t *maze_classes(void) {
    return lab.class_id;
}

EXPORT(maze_actions) const unsigned char *maze_actions(void) {
    return lab.action;
}

EXPORT(maze_values) const double *maze_values(void) {
    return lab.values;
}

static int optimal(uint32_t cell, uint32_t action) {
    double q[GRIDWORLD_ACTIONS];
    gridworld_backup(&lab.maze, lab.optimal, cell, DISCOUNT, lab.slip, q);
    return q[action] >= lab.optimal[cell] - EQUAL;
}

/* The class and the action in a cell. Returns whether the action is optimal, at every draw. */
static uint32_t look_at(uint32_t cell, gridworld_random *random) {
    uint32_t i, class_id, action, good = 1;
    for (i = 0; i < DRAWS; i++) {
        gridworld_encode(&lab.maze, lab.world.distractors, cell, random, lab.percept);
        (void)rlvc_predict(lab.agent, lab.percept, &class_id, &action);
        good = good && optimal(cell, action);
        if (i == 0) {
            lab.class_id[cell] = (uint16_t)class_id;
            lab.action[cell] = (unsigned char)action;
        } else if (lab.class_id[cell] != class_id) {
            lab.class_id[cell] = CLASS_MIXED;
        }
    }
    return good;
}

/* Looks up classes and actions of all cells, and what the policy is worth. */
static void look(void) {
    const uint32_t cells = lab.maze.width * lab.maze.height;
    gridworld_random random; /* not the world's: looking changes nothing */
    uint32_t cell;
    gridworld_random_seed(&random, 0);
    lab.view.optimal = 0;
    for (cell = 0; cell < cells; cell++) {
        lab.class_id[cell] = CLASS_NONE;
        if (lab.maze.cells[cell] == GRIDWORLD_FREE) {
            lab.view.optimal += look_at(cell, &random);
        }
    }
    (void)gridworld_values(&lab.maze, lab.action, DISCOUNT, lab.slip, SETTLED, lab.values);
    lab.view.mean = mean_of(lab.values);
}

/* A percept of a cell, of view.bits bits; other distractors for another draw. Null if there is no
 * such cell. */
EXPORT(maze_percept) const unsigned char *maze_percept(uint32_t cell, uint32_t draw) {
    gridworld_random random;
    if (!lab.agent || cell >= lab.maze.width * lab.maze.height) {
        return NULL;
    }
    gridworld_random_seed(&random, draw);
    gridworld_encode(&lab.maze, lab.world.distractors, cell, &random, lab.percept);
    return lab.percept;
}

/* ------------------------------------------------------------------ text */

/* Writes the learnt tree as JSON. Returns whether it had room; likewise below. */
EXPORT(maze_tree) uint32_t maze_tree(void) {
    text_begin();
    return rlvc_print(lab.agent, RLVC_PRINT_JSON, text_write, NULL) == RLVC_OK;
}

/* The smallest tree that acts likewise: made in memory that is free again afterwards. */
static rlvc_policy *make_policy(void) {
    rlvc_policy_config config;
    rlvc_policy *policy = NULL;
    size_t bytes = 0;
    void *block;
    text_begin();
    if (rlvc_policy_default(lab.agent, &config) != RLVC_OK) {
        return NULL; /* there is no agent */
    }
    config.effort = POLICY_EFFORT;
    (void)rlvc_policy_size(lab.agent, &config, &bytes);
    block = memory_take(bytes);
    if (block) {
        (void)rlvc_policy_make(lab.agent, &config, block, bytes, &policy, NULL);
    }
    return policy;
}

/* Writes its tree as JSON. */
EXPORT(maze_policy) uint32_t maze_policy(void) {
    const size_t mark = memory_mark();
    rlvc_policy *policy = make_policy();
    const uint32_t done =
        policy && rlvc_policy_print(policy, RLVC_PRINT_JSON, text_write, NULL) == RLVC_OK;
    memory_release(mark);
    return done;
}

/* Writes it as C. */
EXPORT(maze_policy_c) uint32_t maze_policy_c(void) {
    const size_t mark = memory_mark();
    rlvc_policy *policy = make_policy();
    const uint32_t done =
        policy && rlvc_policy_export_c(policy, "maze", text_write, NULL, NULL) == RLVC_OK;
    memory_release(mark);
    return done;
}

EXPORT(version) void version(void) {
    text_begin();
    (void)text_write(NULL, rlvc_version(), __builtin_strlen(rlvc_version()));
}
