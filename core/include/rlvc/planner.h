/* SPDX-License-Identifier: MIT */
/* The planner: the method that learns a small tree on real numbers, by searching in a learnt model
 * of the world. Thresholds learn by it unless config.method says otherwise, and its agents are used
 * as all are (rlvc/agent.h); here is what is the planner's own.
 *
 * For robots, whose sensors give angles, speeds and distances, classes of percepts are a weak
 * guide. The planner fits a model of what each action changes to some hundred interactions,
 * searches in that model for a small tree of tests x[component] > cutpoint that earns much, and
 * lets it act for an episode. Real returns decide between the trees that were tried. It needs no
 * discount: it maximises the sum of the rewards of an episode, or of `horizon` interactions where
 * episodes are longer or never end.
 *
 * A step of rlvc_learn, if an episode ended since the last: fits the model if the data have grown
 * by a tenth, searches, and chooses the policy of the next episode. What it makes does not depend
 * on the budgets. Until it is done the best policy so far acts; interactions observed in between
 * wait for the next step, but that the search draws cutpoints from them. The unit of work is a
 * multiplication of floats, about.
 *
 * The learnt policy, which rlvc_predict follows and which is printed, exported and made a policy by
 * itself, is of the trees that were tried the one of the highest score, less half a standard error
 * and 0.2 % of the score for each leaf; action 0 while there is none.
 *
 * A percept is [components] numbers, each finite and within +-RLVC_PLANNER_NUMBER_MAX, else it is
 * refused with RLVC_E_PERCEPT. */
#ifndef RLVC_PLANNER_H
#define RLVC_PLANNER_H

#include "rlvc/policy.h"
#include "rlvc/snapshot.h"

#ifdef __cplusplus
extern "C" {
#endif

#define RLVC_PLANNER_COMPONENTS_MAX 64u /* of the domain of thresholds */
#define RLVC_PLANNER_ACTIONS_MAX 64u
#define RLVC_PLANNER_CAPACITY_MAX 100000000u
#define RLVC_PLANNER_MODEL_LEAVES_MAX 256u
#define RLVC_PLANNER_LEAVES_MAX 16u
#define RLVC_PLANNER_CANDIDATES_MAX 1000000u
#define RLVC_PLANNER_NUMBER_MAX 1e9f

/* At least rlvc_agent_size of a planner, for static arrays; each argument is looked at more than
 * once. */
#define RLVC_PLANNER_BYTES(components, actions, capacity, sample, model_leaves)                    \
    (8192u + (size_t)(capacity) * (4u * (components) + 6u) + 4u * (size_t)(sample) +               \
     (2u * (components) + 3u) * (size_t)(model_leaves) *                                           \
         (28u + 4u * (RLVC_PLANNER_TERMS(components, actions) + 3u)) +                             \
     48u * (model_leaves) + 200u * ((components) + 2u) +                                           \
     5u * 2u * (RLVC_PLANNER_TERMS(components, actions) + 1u) *                                    \
         (RLVC_PLANNER_TERMS(components, actions) + 2u) +                                          \
     16u * RLVC_PLANNER_TERMS(components, actions) + 16u * (320u + 196u) +                         \
     (size_t)(components) * (16u * 24u * 4u + 256u * 4u + 416u) +                                  \
     36u * ((size_t)(components) * ((components)-1u) / 2u + 1u))

/* Terms of a linear model of the dynamics: with products of components if they are at most 64. */
#define RLVC_PLANNER_TERMS(components, actions)                                                    \
    ((components) + (actions) + (components) * ((components) + 1u) / 2u <= 64u                     \
         ? (components) + (actions) + (components) * ((components) + 1u) / 2u                      \
         : (components) + (actions))

/* The size of a block in which a planner learns the same in half of the time or less: it remembers
 * where the rollouts of a policy passed, and does not make again what a candidate would repeat.
 * That takes 2,000 * leaves * components bytes beside rlvc_agent_size, about. A block
 * of rlvc_agent_init and rlvc_load that is so large is made use of. O(1).
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_CONFIG: *bytes is 0. */
RLVC_API rlvc_status rlvc_planner_ample_size(const rlvc_config *config, const rlvc_domain *domain,
                                             size_t *bytes);

/* The action at any percept, by the policy that acts in the next episode: for episodes in several
 * worlds at once, each of which is observed when it has ended, by rlvc_begin and rlvc_observe,
 * before the next step of learning. O(depth).
 * @return RLVC_OK; RLVC_E_PERCEPT; RLVC_E_MISMATCH: the agent is of classes. */
RLVC_API rlvc_status rlvc_planner_act_at(rlvc_agent *agent, const float *percept, uint32_t *action);

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
 * @return RLVC_OK; RLVC_E_RANGE: index; RLVC_E_MISMATCH: the agent is of classes. O(1). */
RLVC_API rlvc_status rlvc_planner_node(const rlvc_agent *agent, uint32_t index,
                                       rlvc_planner_test *node);

/* Enough for a policy, also where tests keep arrays apart. */
#define RLVC_PLANNER_POLICY_BYTES 2048u

/* Makes a policy of nodes that rlvc_planner_node gave: kept in a file, or as constants of a
 * controller that does not learn. O(leaves^2).
 * @param node [count] a tree as rlvc_planner_node gives it: a child comes after its parent
 * @param count [1, 2 * RLVC_PLANNER_LEAVES_MAX - 1], odd
 * @param actions [1, RLVC_PLANNER_ACTIONS_MAX]
 * @param thresholds of rlvc_thresholds_policy_domain or rlvc_thresholds_domain; copied, its ctx
 * must stay
 * @param memory aligned to RLVC_ALIGNMENT; `bytes` of it, RLVC_PLANNER_POLICY_BYTES or more
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

/* Numbers stay at 2^32 - 1 once they are there. */
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

/* @return RLVC_OK; RLVC_E_MISMATCH: the agent is of classes. O(1). */
RLVC_API rlvc_status rlvc_planner_stats(const rlvc_agent *agent,
                                        rlvc_planner_statistics *statistics);

/* Of its snapshots, beside RLVC_SNAPSHOT_VERSION, which is of classes. They hold the ring, the
 * model, the trees that were tried and their returns, and the episode under way, and are made
 * between two steps: rlvc_save returns RLVC_E_BUSY during one. Those of version 0x10001, which hold
 * fewer first percepts, are loaded, too. */
#define RLVC_PLANNER_SNAPSHOT_VERSION 0x10002u

#ifdef __cplusplus
}
#endif

#endif
