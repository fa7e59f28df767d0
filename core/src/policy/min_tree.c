/* SPDX-License-Identifier: MIT */
/* The decision tree of the fewest leaves: see rlvc/min_tree.h.
 *
 * For a subset S of the rows let F(S) be the fewest leaves of a tree in which each ends well:
 *
 *     F(S) = 1                                        if all rows of S allow a common action, else
 *     F(S) = min over the features f that part S of F(S without f) + F(S with f)
 *
 * The same tests in another order lead to the same subset, so that each is solved but once and its
 * F(S) kept in a table. Its key is what all rows of S have in common, which features and with which
 * values: of the rows that some tests lead to no others have these.
 *
 * search() finds F(S) depth first, without recursion: a frame of a stack of our own tries one
 * feature after another, and waits for the frame above it, which solves one side of the parted
 * subset. There is at most one for each feature. The rows stand in an order in which each subset
 * under examination is a stretch, as in quicksort: it is parted in place, and what goes on in the
 * frames above moves rows only within its own part.
 *
 * Branch and bound: for a subset that is not solved yet the table keeps a lower bound of F(S),
 * which at first is the number of its rows that pairwise allow nothing in common (chosen greedily).
 * A feature is passed as soon as the bounds of its two sides add up to as much as the best one so
 * far, and a frame is asked only for a tree that would be better than that.
 *
 * grow() then puts the tree down from its root, as the table says; where that or the effort did not
 * suffice, by the feature that purifies best. */
#include "rlvc/float_rules.h"

#include "rlvc/min_tree.h"

#include "../base/arena.h"
#include <string.h>

#define NONE UINT32_MAX /* no feature: the entry's leaves are but a lower bound */

/* What the table keeps of a subset; unused while leaves is 0. */
typedef struct entry {
    uint32_t leaves;  /* F(S), or a lower bound of it */
    uint32_t feature; /* the root's of a tree of so many leaves, or NONE */
} entry;

/* What is known of a stretch at a bounds. */
typedef struct bounds {
    uint32_t leaves; /* F(S), or a lower bound of it */
    uint32_t slot;   /* its place in the table, used or not; of no meaning if one leaf is enough */
    uint8_t exact;   /* leaves is F(S) */
} bounds;

/* How far the search for the tree of a stretch has come. */
typedef struct frame {
    uint32_t begin, end; /* the stretch */
    uint32_t middle;     /* its rows with the feature under trial stand from here on */
    uint32_t slot;       /* its place in the table */
    uint32_t best;       /* leaves of the best tree so far; at first one more than are of use */
    uint32_t root;       /* the feature at its root, or NONE */
    uint32_t bound;      /* the least sum of both sides' bounds among the features passed */
    uint32_t feature;    /* under trial */
    bounds side[2];      /* without and with it; looked at if `parted` */
    uint8_t parted;
    uint8_t above; /* the side that the frame above solves, if `entered` */
    uint8_t entered;
} frame;

/* A stretch that still needs its part of the tree. */
typedef struct part {
    uint32_t begin, end, leaf;
} part;

typedef struct min_tree {
    const rlvc_min_tree_task *task;
    uint32_t words;
    uint32_t mask;              /* slots of the table - 1 */
    uint32_t used;              /* of them */
    uint32_t deep;              /* frames in use */
    uint32_t leaves;            /* of the tree so far */
    uint32_t actions;           /* the highest that a row allows, and 1 */
    uint64_t left;              /* of the effort of this search */
    uint8_t infeasible;         /* alike rows without a common action were met */
    entry *table;               /* [mask + 1] */
    uint64_t *keys;             /* [mask + 1][2 * words] features shared, their values */
    uint64_t *key;              /* [2 * words] that of the stretch last looked at */
    uint32_t *order;            /* [rows] */
    frame *frames;              /* [depth] */
    part *todo;                 /* [depth + 1] a stack, too */
    rlvc_min_tree_split *split; /* [rows - 1] */
    uint8_t *action;            /* [rows] */
} min_tree;

static void carve(min_tree *s, rlvc_arena *arena) {
    const rlvc_min_tree_task *task = s->task;
    uint32_t depth = (task->features < task->rows ? task->features : task->rows) + 1u;
    s->words = RLVC_MIN_TREE_WORDS(task->features);
    for (s->mask = 1; s->mask < task->entries / 2u;)
        s->mask = 2u * s->mask + 1u;
    s->split = rlvc_arena_carve(arena, task->rows, sizeof *s->split);
    s->action = rlvc_arena_carve(arena, task->rows, sizeof *s->action);
    s->order = rlvc_arena_carve(arena, task->rows, sizeof *s->order);
    s->frames = rlvc_arena_carve(arena, depth, sizeof *s->frames);
    s->todo = rlvc_arena_carve(arena, depth + 1u, sizeof *s->todo);
    s->key = rlvc_arena_carve(arena, 2u * s->words, sizeof *s->key);
    s->table = rlvc_arena_carve(arena, s->mask + 1u, sizeof *s->table);
    s->keys = rlvc_arena_carve(arena, s->mask + 1u, 2u * s->words * (uint32_t)sizeof *s->keys);
}

static const uint64_t *row_at(const min_tree *s, uint32_t at) {
    return s->task->row + (size_t)s->order[at] * s->words;
}

static uint64_t allowed_at(const min_tree *s, uint32_t at) {
    return s->task->allowed[s->order[at]];
}

static int exhibits(const min_tree *s, uint32_t at, uint32_t feature) {
    return (int)(row_at(s, at)[feature / 64u] >> feature % 64u & 1u);
}

static void spend(min_tree *s, uint64_t words) {
    s->left -= words < s->left ? words : s->left;
}

/* ------------------------------------------------------------------ the table */

/* Where the key stands in the table, or would. */
static uint32_t find(const min_tree *s) {
    uint64_t hash = 0;
    for (uint32_t w = 0; w < 2u * s->words; w++) {
        hash = (hash ^ s->key[w]) * 0x9E3779B97F4A7C15u;
        hash ^= hash >> 32;
    }
    uint32_t slot = (uint32_t)hash & s->mask;
    size_t bytes = 2u * s->words * sizeof *s->key;
    while (s->table[slot].leaves != 0 &&
           memcmp(s->keys + (size_t)slot * 2u * s->words, s->key, bytes) != 0)
        slot = (slot + 1u) & s->mask;
    return slot;
}

static void clear(min_tree *s) {
    memset(s->table, 0, ((size_t)s->mask + 1u) * sizeof *s->table);
    s->used = 0;
    s->deep = 0;
}

/* Makes the key of a stretch: the features that all its rows share, then their values.
 * @return whether there is a feature that parts it. */
static int make_key(min_tree *s, uint32_t begin, uint32_t end) {
    const uint32_t words = s->words;
    int parts = 0;
    for (uint32_t w = 0; w < words; w++) {
        uint64_t any = 0, all = UINT64_MAX;
        for (uint32_t at = begin; at < end; at++) {
            const uint64_t word = row_at(s, at)[w];
            any |= word;
            all &= word;
        }
        s->key[w] = ~(any ^ all); /* shared; bits beyond the features, which no row has, too */
        s->key[words + w] = all;
        parts |= any != all;
    }
    return parts;
}

/* The actions that all rows of a stretch allow. */
static uint64_t common(const min_tree *s, uint32_t begin, uint32_t end) {
    uint64_t actions = UINT64_MAX;
    for (uint32_t at = begin; at < end && actions != 0; at++)
        actions &= allowed_at(s, at);
    return actions;
}

/* A lower bound of F(S): rows that pairwise allow nothing in common need a leaf each. Once these
 * allow every action between them, there is no other. */
static uint32_t lower_bound(const min_tree *s, uint32_t begin, uint32_t end) {
    const uint64_t all = UINT64_MAX >> (64u - s->actions);
    uint64_t taken = 0;
    uint32_t count = 0;
    for (uint32_t at = begin; at < end && taken != all; at++) {
        if ((allowed_at(s, at) & taken) == 0) {
            taken |= allowed_at(s, at);
            count++;
        }
    }
    return count < 2 ? 2 : count;
}

/* Betters a bounds by what the table knows. */
static void recall(const min_tree *s, bounds *seen) {
    const entry *known = &s->table[seen->slot];
    if (known->leaves > seen->leaves)
        seen->leaves = known->leaves;
    seen->exact = known->leaves != 0 && known->feature != NONE;
}

/* Looks at a stretch that is not empty, and unless one leaf is enough makes its key. */
static bounds inspect(min_tree *s, uint32_t begin, uint32_t end) {
    bounds seen = {1, 0, 1};
    spend(s, (uint64_t)(end - begin) * (s->words + 1u));
    if (common(s, begin, end) != 0)
        return seen;
    if (!make_key(s, begin, end))
        s->infeasible = 1;
    seen.leaves = lower_bound(s, begin, end);
    seen.slot = find(s);
    recall(s, &seen);
    return seen;
}

/* ------------------------------------------------------------------ the search */

/* Brings the rows of a stretch that lack a feature before those that have it. Returns where these
 * begin. */
static uint32_t partition(min_tree *s, uint32_t begin, uint32_t end, uint32_t feature) {
    spend(s, end - begin);
    while (begin < end) { /* without a branch by the feature, which none could foresee */
        const uint32_t first = s->order[begin], last = s->order[end - 1u];
        const uint32_t has = (uint32_t)exhibits(s, begin, feature);
        const uint32_t exchanged = (first ^ last) & (0u - has);
        s->order[begin] = first ^ exchanged;
        s->order[end - 1u] = last ^ exchanged;
        begin += 1u - has;
        end -= has;
    }
    return begin;
}

/* Begins to search for a tree of at most `limit` leaves of a stretch, which was the last looked at,
 * so that the key is its own.
 * @return 0: the table is full, or the effort is spent. */
static int enter(min_tree *s, uint32_t begin, uint32_t end, const bounds *seen, uint32_t limit) {
    const frame fresh = {.begin = begin,
                         .end = end,
                         .middle = begin,
                         .slot = seen->slot,
                         .best = limit + 1u,
                         .root = NONE,
                         .bound = NONE};
    entry *known = &s->table[seen->slot];
    if (known->leaves == 0) {
        if (s->used >= s->mask - s->mask / 8u)
            return 0;
        s->used++;
        memcpy(s->keys + (size_t)seen->slot * 2u * s->words, s->key,
               2u * s->words * sizeof *s->key);
        known->leaves = seen->leaves;
        known->feature = NONE;
    }
    s->frames[s->deep++] = fresh;
    return s->left > 0;
}

/* Ends the search of the frame on top. If it found no tree within its limit, all features were
 * passed, and the least of their bounds is one of F(S). */
static void leave(min_tree *s) {
    const frame *f = &s->frames[--s->deep];
    entry *known = &s->table[f->slot];
    if (f->root != NONE) {
        known->leaves = f->best;
        known->feature = f->root;
    } else {
        known->leaves = f->bound;
    }
}

/* Parts the stretch by the feature under trial and looks at both sides.
 * @return 0: one of them is empty. */
static int inspect_sides(min_tree *s, frame *f) {
    f->middle = partition(s, f->begin, f->end, f->feature);
    if (f->middle == f->begin || f->middle == f->end)
        return 0;
    f->side[0] = inspect(s, f->begin, f->middle);
    f->side[1] = inspect(s, f->middle, f->end);
    f->parted = 1;
    return 1;
}

/* Goes on to the next feature. What is known to need so many leaves cannot be better. */
static void next_feature(min_tree *s, frame *f) {
    const int cannot_improve = f->root != NONE && f->best == s->table[f->slot].leaves;
    f->parted = 0;
    f->feature = cannot_improve ? s->task->features : f->feature + 1u;
}

/* Goes one step further in the frame on top.
 * @return 0: the table is full, or the effort is spent. */
static int step(min_tree *s) {
    frame *f = &s->frames[s->deep - 1u];
    if (f->feature == s->task->features) {
        leave(s);
        return 1;
    }
    if (f->entered)
        recall(s, &f->side[f->above]);
    f->entered = 0;
    if (!f->parted && !inspect_sides(s, f)) {
        next_feature(s, f);
        return 1;
    }
    const uint32_t sum = f->side[0].leaves + f->side[1].leaves;
    const uint8_t side = f->side[0].exact; /* to be solved: the one without, then the one with it */
    if (sum >= f->best || f->side[side].exact) {
        f->bound = sum < f->bound ? sum : f->bound;
        if (sum < f->best) {
            f->best = sum;
            f->root = f->feature;
        }
        next_feature(s, f);
        return 1;
    }
    const uint32_t begin = side ? f->middle : f->begin, end = side ? f->end : f->middle;
    f->side[side] = inspect(s, begin, end); /* for its key, and as its place may have been taken */
    f->above = side;
    f->entered = 1;
    return enter(s, begin, end, &f->side[side], f->best - 1u - f->side[1u - side].leaves);
}

/* Looks for the best tree of a stretch.
 * @return whether the table has it now. */
static int search(min_tree *s, uint32_t begin, uint32_t end) {
    const uint32_t rows = end - begin;
    clear(s);
    s->left = s->task->effort * rows / s->task->rows + rows;
    bounds seen = inspect(s, begin, end);
    int goes_on = enter(s, begin, end, &seen, rows);
    while (goes_on && s->deep > 0 && !s->infeasible)
        goes_on = step(s);
    return goes_on && !s->infeasible;
}

/* ------------------------------------------------------------------ the greedy way */

/* Counts, for each action, the rows of a stretch that allow it. */
static void count_allowed(const min_tree *s, uint32_t begin, uint32_t end,
                          uint32_t count[RLVC_MIN_TREE_ACTIONS_MAX]) {
    memset(count, 0, RLVC_MIN_TREE_ACTIONS_MAX * sizeof *count);
    for (uint32_t at = begin; at < end; at++) {
        for (uint32_t a = 0; a < s->actions; a++)
            count[a] += (uint32_t)(allowed_at(s, at) >> a & 1u);
    }
}

/* Of the actions that a row allows the one that most do. */
static uint32_t favourite(const min_tree *s, uint64_t allowed,
                          const uint32_t count[RLVC_MIN_TREE_ACTIONS_MAX]) {
    uint32_t best = s->actions;
    for (uint32_t a = 0; a < s->actions; a++) {
        if ((allowed >> a & 1u) && (best == s->actions || count[a] > count[best]))
            best = a;
    }
    return best;
}

/* The sum over the sides of sum_a n_a^2 / n: the greater, the purer (Gini). 0 if one is empty. */
static float purity(const min_tree *s, uint32_t begin, uint32_t end, uint32_t feature,
                    const uint32_t count[RLVC_MIN_TREE_ACTIONS_MAX]) {
    uint32_t favours[2][RLVC_MIN_TREE_ACTIONS_MAX], rows[2] = {0, 0};
    float sum = 0.0f;
    memset(favours, 0, sizeof favours);
    for (uint32_t at = begin; at < end; at++) {
        const int side = exhibits(s, at, feature);
        favours[side][favourite(s, allowed_at(s, at), count)]++;
        rows[side]++;
    }
    if (rows[0] == 0 || rows[1] == 0)
        return 0.0f;
    for (uint32_t side = 0; side < 2; side++) {
        for (uint32_t a = 0; a < s->actions; a++)
            sum += (float)favours[side][a] * (float)favours[side][a] / (float)rows[side];
    }
    return sum;
}

/* The feature that purifies a stretch best; of equals the lowest. */
static uint32_t purest(const min_tree *s, uint32_t begin, uint32_t end) {
    uint32_t count[RLVC_MIN_TREE_ACTIONS_MAX], best = 0;
    float most = 0.0f;
    count_allowed(s, begin, end, count);
    for (uint32_t feature = 0; feature < s->task->features; feature++) {
        const float now = purity(s, begin, end, feature, count);
        if (now > most) {
            most = now;
            best = feature;
        }
    }
    return best;
}

/* ------------------------------------------------------------------ the tree */

static uint8_t lowest(uint64_t actions) {
    uint8_t a = 0;
    while (!(actions >> a & 1u))
        a++;
    return a;
}

/* The feature at the root of a stretch's tree. */
static uint32_t root_of(min_tree *s, uint32_t begin, uint32_t end, const bounds *seen,
                        uint8_t *exact) {
    if (seen->exact)
        return s->table[seen->slot].feature;
    if (search(s, begin, end)) {
        bounds solved = inspect(s, begin, end);
        return s->table[solved.slot].feature;
    }
    *exact = 0;
    clear(s);
    return s->infeasible ? 0 : purest(s, begin, end);
}

/* Puts the tree down from its root, absent before present. A subset of one whose tree is in the
 * table is there, too. */
static uint8_t grow(min_tree *s) {
    uint32_t parts = 1;
    uint8_t exact = 1;
    const part all = {0, s->task->rows, 0};
    s->todo[0] = all;
    s->leaves = 1;
    while (parts > 0 && !s->infeasible) {
        const part now = s->todo[--parts];
        const bounds seen = inspect(s, now.begin, now.end);
        if (seen.leaves == 1) {
            s->action[now.leaf] = lowest(common(s, now.begin, now.end));
        } else if (!s->infeasible) {
            const uint32_t feature = root_of(s, now.begin, now.end, &seen, &exact);
            const uint32_t middle = partition(s, now.begin, now.end, feature);
            const rlvc_min_tree_split split = {now.leaf, feature};
            const part present = {middle, now.end, s->leaves},
                       absent = {now.begin, middle, now.leaf};
            s->split[s->leaves++ - 1u] = split;
            s->todo[parts++] = present;
            s->todo[parts++] = absent;
        }
    }
    return exact;
}

/* ------------------------------------------------------------------ for the caller */

static int task_is_sound(const rlvc_min_tree_task *task) {
    return task->rows >= 1 && task->rows <= RLVC_MIN_TREE_ROWS_MAX &&
           task->features <= RLVC_MIN_TREE_FEATURES_MAX && task->entries >= 2 &&
           task->entries <= RLVC_MIN_TREE_ENTRIES_MAX && task->reserved == 0 && task->effort >= 1 &&
           task->effort <= RLVC_MIN_TREE_EFFORT_MAX;
}

static int has_rows(const rlvc_min_tree_task *task) {
    return task && task->allowed && (task->row || task->features == 0);
}

/* Is no row without an action, and none with a bit beyond its features? */
static int rows_are_sound(const rlvc_min_tree_task *task) {
    const uint32_t words = RLVC_MIN_TREE_WORDS(task->features), rest = task->features % 64u;
    for (uint32_t i = 0; i < task->rows; i++) {
        if (task->allowed[i] == 0 ||
            (rest != 0 && task->row[(size_t)(i + 1u) * words - 1u] >> rest != 0))
            return 0;
    }
    return 1;
}

/* Puts the rows in order, and counts the actions. */
static void number_rows(min_tree *s) {
    for (uint32_t i = 0; i < s->task->rows; i++) {
        s->order[i] = i;
        while (s->actions < RLVC_MIN_TREE_ACTIONS_MAX && s->task->allowed[i] >> s->actions != 0)
            s->actions++;
    }
}

rlvc_status rlvc_min_tree_size(const rlvc_min_tree_task *task, size_t *bytes) {
    if (!task || !bytes)
        return RLVC_E_NULL;
    *bytes = 0;
    if (!task_is_sound(task))
        return RLVC_E_RANGE;
    rlvc_arena arena = {NULL, 0};
    min_tree s;
    s.task = task;
    carve(&s, &arena);
    if (arena.used > SIZE_MAX)
        return RLVC_E_MEMORY;
    *bytes = (size_t)arena.used;
    return RLVC_OK;
}

rlvc_status rlvc_min_tree(const rlvc_min_tree_task *task, void *memory, size_t bytes,
                          rlvc_min_tree_result *tree) {
    size_t needed = 0;
    if (!tree || !memory || !has_rows(task))
        return RLVC_E_NULL;
    rlvc_status status = rlvc_min_tree_size(task, &needed);
    if (status == RLVC_OK && !rows_are_sound(task))
        status = RLVC_E_RANGE;
    if (status == RLVC_OK)
        status = rlvc_arena_check(memory, bytes, needed);
    if (status != RLVC_OK)
        return status;
    rlvc_arena arena = {(unsigned char *)memory, 0};
    const rlvc_min_tree_task copied = *task; /* it may lie in the block */
    min_tree s;
    memset(&s, 0, sizeof s);
    s.task = &copied;
    carve(&s, &arena);
    clear(&s);
    number_rows(&s);
    const uint8_t exact = grow(&s);
    if (s.infeasible)
        return RLVC_E_RANGE;
    memset(tree, 0, sizeof *tree);
    tree->split = s.split;
    tree->action = s.action;
    tree->leaves = s.leaves;
    tree->exact = exact;
    return RLVC_OK;
}
