/* SPDX-License-Identifier: MIT */
/* The planner: learns a small tree on real numbers, by searching in a learnt model of the world.
 *
 *     rlvc_planner_default, rlvc_planner_size, rlvc_planner_init   once
 *     rlvc_planner_begin                                           at the start of an episode
 *     rlvc_planner_act, rlvc_planner_observe                       at each interaction
 *     rlvc_planner_learn                                           after each episode, or in slices
 *     rlvc_planner_predict, rlvc_planner_node, rlvc_planner_stats  at any time
 *     rlvc_planner_save, rlvc_planner_load                         between two steps of learning
 *
 * For robots, whose sensors give angles, speeds and distances, classes of percepts are a weak
 * guide. The planner fits a model of what each action changes to some hundred interactions,
 * searches in that model for a small tree of tests x[component] > cutpoint that earns much, and
 * lets it act for an episode. Real returns decide between the trees that were tried. It needs no
 * discount: it maximises the sum of the rewards of an episode, or of `horizon` interactions where
 * episodes are longer or never end.
 *
 * It lives in one block of the caller's memory, and is used by one thread at a time. Every function
 * here returns RLVC_E_NULL for a null pointer; that is not repeated below. On error nothing
 * changes. */
#ifndef RLVC_PLANNER_H
#define RLVC_PLANNER_H

#include "rlvc/policy.h"
#include "rlvc/snapshot.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct rlvc_planner rlvc_planner;

#define RLVC_PLANNER_COMPONENTS_MAX 64u
#define RLVC_PLANNER_ACTIONS_MAX 64u
#define RLVC_PLANNER_CAPACITY_MAX 100000000u
#define RLVC_PLANNER_MODEL_LEAVES_MAX 256u
#define RLVC_PLANNER_LEAVES_MAX 16u
#define RLVC_PLANNER_CANDIDATES_MAX 1000000u
#define RLVC_PLANNER_NUMBER_MAX 1e9f

/* Chosen once, copied by rlvc_planner_init. Start from rlvc_planner_default. */
typedef struct rlvc_planner_config {
    uint32_t components; /* numbers of a percept, [1, RLVC_PLANNER_COMPONENTS_MAX]; no default */
    uint32_t actions;    /* [2, RLVC_PLANNER_ACTIONS_MAX]; no default */
    uint32_t capacity; /* percepts the ring holds, [64, RLVC_PLANNER_CAPACITY_MAX]; an episode of n
                          interactions has n + 1. When it is full the oldest leave. Default 2000 */
    uint32_t sample;   /* interactions that a model is fitted to at most, drawn from the ring,
                          [32, capacity]. Default 2000 */
    uint32_t model_leaves; /* of each tree of the model, [1, RLVC_PLANNER_MODEL_LEAVES_MAX]. Default
                              32 */
    uint32_t leaves;       /* of the policy at most, [2, RLVC_PLANNER_LEAVES_MAX]. Default 16 */
    uint32_t horizon; /* interactions after which an episode counts as one, although it goes on,
                         [1, RLVC_PLANNER_CAPACITY_MAX]. Default 500 */
    uint32_t random;  /* interactions at random before the first model, and then to the end of the
                         episode, [32, capacity / 2]. Default 200 */
    uint32_t candidates; /* trees that a search looks at, in no more than 2,500 steps of the model
                            for each, [1, RLVC_PLANNER_CANDIDATES_MAX]. Default 1000 */
    uint32_t patience;   /* trees without gain after which it ends, likewise. Default 300 */
    uint32_t seed;       /* any value. Default 1 */
} rlvc_planner_config;

/* Fills *config with the defaults. Nothing is checked. O(1).
 * @return RLVC_OK. */
RLVC_API rlvc_status rlvc_planner_default(rlvc_planner_config *config, uint32_t components,
                                          uint32_t actions);

/* The exact size of a planner's block on this target. O(1).
 * @return RLVC_OK; RLVC_E_CONFIG: a field is out of range, and *bytes is 0. */
RLVC_API rlvc_status rlvc_planner_size(const rlvc_planner_config *config, size_t *bytes);

/* At least the size of a planner's block, for static arrays; each argument is looked at more than
 * once. */
#define RLVC_PLANNER_BYTES(components, actions, capacity, sample, model_leaves)                    \
    (8192u + (size_t)(capacity) * (4u * (components) + 6u) + 4u * (size_t)(sample) +               \
     (2u * (components) + 3u) * (size_t)(model_leaves) *                                           \
         (28u + 4u * (RLVC_PLANNER_TERMS(components, actions) + 3u)) +                             \
     48u * (model_leaves) + 200u * ((components) + 2u) +                                           \
     5u * 2u * (RLVC_PLANNER_TERMS(components, actions) + 1u) *                                    \
         (RLVC_PLANNER_TERMS(components, actions) + 2u) +                                          \
     16u * RLVC_PLANNER_TERMS(components, actions) + 16u * (320u + 196u) +                         \
     (size_t)(components) * (16u * 24u * 4u + 64u * 4u + 220u) +                                   \
     36u * ((size_t)(components) * ((components)-1u) / 2u + 1u))

/* Terms of a linear model of the dynamics: with products of components if they are at most 64. */
#define RLVC_PLANNER_TERMS(components, actions)                                                    \
    ((components) + (actions) + (components) * ((components) + 1u) / 2u <= 64u                     \
         ? (components) + (actions) + (components) * ((components) + 1u) / 2u                      \
         : (components) + (actions))

/* Makes a new planner in the caller's block, which must not be moved. O(bytes).
 * @param memory aligned to RLVC_ALIGNMENT; `bytes` of it, rlvc_planner_size or more
 * @return RLVC_OK; RLVC_E_CONFIG; RLVC_E_MEMORY: the block is untouched. On error *planner is null.
 */
RLVC_API rlvc_status rlvc_planner_init(const rlvc_planner_config *config, void *memory,
                                       size_t bytes, rlvc_planner **planner);

/* Starts an episode at a percept, which is copied. One that was under way is cut off, and its
 * return does not count. O(components).
 * @param percept [components] finite, within +-RLVC_PLANNER_NUMBER_MAX
 * @return RLVC_OK; RLVC_E_RANGE: the percept; RLVC_E_BUSY: the ring is full of what a model is
 * being fitted to: go on with rlvc_planner_learn. */
RLVC_API rlvc_status rlvc_planner_begin(rlvc_planner *planner, const float *percept);

/* The action at the current percept, by the policy that acts in this episode. O(depth).
 * @return RLVC_OK; RLVC_E_ORDER: no current percept. */
RLVC_API rlvc_status rlvc_planner_act(rlvc_planner *planner, uint32_t *action);

/* The action at any percept, by the policy that acts in the next episode: for episodes in several
 * worlds at once, each of which is observed when it has ended, by rlvc_planner_begin and
 * rlvc_planner_observe, before the next step of learning. O(depth).
 * @return RLVC_OK; RLVC_E_RANGE: the percept. */
RLVC_API rlvc_status rlvc_planner_act_at(rlvc_planner *planner, const float *percept,
                                         uint32_t *action);

/* Stores what came of an action at the current percept. O(components), and O(components^2) in an
 * episode that explores.
 * @param next [components] s', copied; also where the episode is terminated
 * @param end  RLVC_GOES_ON, or RLVC_TERMINATED or RLVC_TRUNCATED: then call rlvc_planner_begin next
 * @return RLVC_OK; RLVC_E_ORDER: no current percept; RLVC_E_RANGE: action, next or end;
 * RLVC_E_REWARD; RLVC_E_BUSY: as of rlvc_planner_begin. */
RLVC_API rlvc_status rlvc_planner_observe(rlvc_planner *planner, uint32_t action, float reward,
                                          const float *next, uint8_t end);

/* One step of learning, if an episode ended since the last: fits the model if the data have grown
 * by a tenth, searches, and chooses the policy of the next episode. What it makes does not depend
 * on the budgets. Until it is done the best policy so far acts; interactions observed in between
 * wait for the next step, but that the search draws cutpoints from them.
 *
 * The unit of work is a multiplication of floats, about.
 * @param budget [rlvc_planner_budget_min, UINT32_MAX]
 * @return RLVC_OK, and progress->work is at most the budget; RLVC_E_RANGE: budget. */
RLVC_API rlvc_status rlvc_planner_learn(rlvc_planner *planner, uint32_t budget,
                                        rlvc_progress *progress);

/* The least budget: what cannot be cut. O(1).
 * @return RLVC_OK. */
RLVC_API rlvc_status rlvc_planner_budget_min(const rlvc_planner *planner, uint32_t *budget);

/* The action of the learnt policy: of the trees that were tried the one of the highest score, less
 * half a standard error and 0.2 % of the score for each leaf; action 0 while there is none.
 * O(depth).
 * @return RLVC_OK; RLVC_E_RANGE: the percept. */
RLVC_API rlvc_status rlvc_planner_predict(const rlvc_planner *planner, const float *percept,
                                          uint32_t *action);

/* The config, as it was copied. O(1).
 * @return RLVC_OK. */
RLVC_API rlvc_status rlvc_planner_config_of(const rlvc_planner *planner,
                                            rlvc_planner_config *config);

#define RLVC_PLANNER_LEAF 0xffffu

/* A node of the learnt policy. Node 0 is the root. */
typedef struct rlvc_planner_test {
    float cutpoint;
    uint16_t component; /* x[component] > cutpoint leads to child + 1, else to child; of a leaf
                           RLVC_PLANNER_LEAF */
    uint8_t child;      /* the j-th test's is 2j + 1 */
    uint8_t action;     /* of a leaf */
} rlvc_planner_test;

/* @param index [0, 2 * leaves - 1)
 * @return RLVC_OK; RLVC_E_RANGE: index. O(1). */
RLVC_API rlvc_status rlvc_planner_node(const rlvc_planner *planner, uint32_t index,
                                       rlvc_planner_test *node);

/* Enough for a policy, also where tests keep arrays apart. */
#define RLVC_PLANNER_POLICY_BYTES 2048u

/* Makes a policy of what was learnt, to be printed, exported as C, and deployed without the planner
 * (see rlvc/policy.h). It is independent of the planner from then on. O(leaves^2).
 * @param thresholds a domain of rlvc_thresholds_domain for as many components; copied, its ctx must
 * stay
 * @param memory aligned to RLVC_ALIGNMENT; `bytes` of it, RLVC_PLANNER_POLICY_BYTES or more
 * @return RLVC_OK; RLVC_E_MISMATCH: another domain, or other components; RLVC_E_MEMORY. On error
 *         *policy is null. */
RLVC_API rlvc_status rlvc_planner_policy(const rlvc_planner *planner, const rlvc_domain *thresholds,
                                         void *memory, size_t bytes, rlvc_policy **policy);

/* Makes a policy of nodes that rlvc_planner_node gave: kept in a file, or as constants of a
 * controller that does not learn. As rlvc_planner_policy does. O(leaves^2).
 * @param node [count] a tree as rlvc_planner_node gives it: a child comes after its parent
 * @param count [1, 2 * RLVC_PLANNER_LEAVES_MAX - 1], odd
 * @param actions [1, RLVC_PLANNER_ACTIONS_MAX]
 * @return RLVC_OK; RLVC_E_MISMATCH: another domain; RLVC_E_RANGE: count, actions or a node;
 * RLVC_E_MEMORY. On error *policy is null. */
RLVC_API rlvc_status rlvc_planner_policy_of(const rlvc_planner_test *node, uint32_t count,
                                            uint32_t actions, const rlvc_domain *thresholds,
                                            void *memory, size_t bytes, rlvc_policy **policy);

/* statistics.acting: what acts in this episode. */
#define RLVC_PLANNER_RANDOM 0u  /* random actions */
#define RLVC_PLANNER_EXPLORE 1u /* a tree that promises to visit what is new */
#define RLVC_PLANNER_NEW 2u     /* a tree that was found in the model */
#define RLVC_PLANNER_AGAIN 3u   /* one of the best four again, as no search found a better one */

/* statistics.verdict: was anything learnt, and if not, why? */
#define RLVC_PLANNER_LEARNT 0u
#define RLVC_PLANNER_NO_EPISODE 1u    /* no episode ended yet */
#define RLVC_PLANNER_NO_DIFFERENCE 2u /* all episodes earned the same */
#define RLVC_PLANNER_NO_MODEL                                                                      \
    3u /* there is no policy yet, or the model does not predict what one earns, and the best is    \
          held to earn no more than four deviations above the worst episode */

typedef struct rlvc_planner_statistics {
    uint32_t interactions; /* observed since init */
    uint32_t episodes;     /* that ended */
    uint32_t explored;     /* interactions of episodes that explored */
    uint32_t fits;         /* of the model */
    uint32_t searches;
    uint32_t candidates; /* trees that the searches looked at */
    uint32_t leaves;     /* of the learnt policy */
    uint32_t tried;      /* episodes that it acted in */
    float score;         /* what it is held to earn in an episode */
    float beta;          /* how far the model is trusted: [0.05, 1] */
    float deviation;     /* of an episode's return from what its policy earns */
    uint8_t acting;      /* RLVC_PLANNER_RANDOM, ... */
    uint8_t verdict;     /* RLVC_PLANNER_LEARNT, ... */
    uint8_t reserved[2];
} rlvc_planner_statistics;

/* @return RLVC_OK. O(1). */
RLVC_API rlvc_status rlvc_planner_stats(const rlvc_planner *planner,
                                        rlvc_planner_statistics *statistics);

/* ------------------------------------------------------------------ snapshots */

/* Beside RLVC_SNAPSHOT_VERSION, which is of agents. */
#define RLVC_PLANNER_SNAPSHOT_VERSION 0x10001u

/* The most bytes that a snapshot of a planner can take: what slot_bytes of its store must be (see
 * rlvc/snapshot.h). A multiple of RLVC_STORE_UNIT. O(1).
 * @return RLVC_OK; RLVC_E_CONFIG, or RLVC_E_MEMORY if it is above RLVC_SLOT_BYTES_MAX: *bytes is 0.
 */
RLVC_API rlvc_status rlvc_planner_snapshot_size(const rlvc_planner_config *config, uint32_t *bytes);

/* Writes a snapshot of all that is known: the ring, the model, the trees that were tried and their
 * returns, and the episode under way. The planner is not changed. Stack and memory are bounded, but
 * the time is what the store takes for all the bytes. O(bytes).
 * @return RLVC_OK; RLVC_E_BUSY: a step of learning is under way, go on with rlvc_planner_learn;
 * RLVC_E_RANGE: slot_bytes; RLVC_E_STORE: the last whole snapshot is still there. */
RLVC_API rlvc_status rlvc_planner_save(rlvc_planner *planner, const rlvc_store *store);

/* Makes a planner in the caller's block, as rlvc_planner_init does, out of the newest whole
 * snapshot of a store. It goes on bit for bit as if it had never stopped. The config must be the
 * one it was saved with, in every field. O(bytes).
 * @return RLVC_OK; RLVC_E_CONFIG; RLVC_E_MEMORY; RLVC_E_RANGE: slot_bytes; RLVC_E_STORE;
 * RLVC_E_EMPTY; RLVC_E_DAMAGED; RLVC_E_VERSION: also if an agent was saved; RLVC_E_MISMATCH.
 * Unless it is RLVC_OK, *planner is null and the block holds nothing of use. */
RLVC_API rlvc_status rlvc_planner_load(const rlvc_planner_config *config, void *memory,
                                       size_t bytes, const rlvc_store *store,
                                       rlvc_planner **planner);

/* Reads the config of the newest whole snapshot of a store. Only checks that the snapshot is whole.
 * O(bytes).
 * @return RLVC_OK; RLVC_E_RANGE: slot_bytes; RLVC_E_STORE; RLVC_E_EMPTY; RLVC_E_DAMAGED;
 * RLVC_E_VERSION. On error *config is zeros. */
RLVC_API rlvc_status rlvc_planner_snapshot_peek(const rlvc_store *store,
                                                rlvc_planner_config *config);

#ifdef __cplusplus
}
#endif

#endif
