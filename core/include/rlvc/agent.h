/* SPDX-License-Identifier: MIT */
/* The agent: learns to act from rewards, in one block of the caller's memory.
 *
 *     rlvc_config_default, rlvc_agent_size, rlvc_agent_init      once
 *     rlvc_begin                                                 at the start of an episode
 *     rlvc_act, rlvc_observe                                     at each interaction
 *     rlvc_learn                                                 now and then, in slices if need be
 *     rlvc_predict, rlvc_print, ...                              at any time
 *
 * It learns by one of two methods, config.method, and these calls serve both: reinforcement
 * learning of classes (section 4.2.1), which is described here, and small trees in a learnt model
 * of the world, which rlvc/planner.h describes and thresholds learn by unless they are told not to.
 * A function that is of classes alone returns RLVC_E_MISMATCH for an agent of the other method.
 *
 * An agent is used by one thread at a time; distinct agents are independent. Every function here
 * returns RLVC_E_NULL for a null pointer that is not marked optional, and RLVC_E_REENTERED when a
 * callback of the agent's own domain calls it. These two are not repeated below. */
#ifndef RLVC_AGENT_H
#define RLVC_AGENT_H

#include "rlvc/domain.h"
#include "rlvc/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct rlvc_agent rlvc_agent;

/* What a block must be aligned to, as every array of uint64_t is: to 8, or to what its target
 * aligns to at most (an AVR: to 1). */
#if defined(__BIGGEST_ALIGNMENT__) && __BIGGEST_ALIGNMENT__ < 8
#define RLVC_ALIGNMENT ((unsigned)__BIGGEST_ALIGNMENT__)
#else
#define RLVC_ALIGNMENT 8u
#endif

#define RLVC_REWARD_MAX 1e12f

/* config.criterion: which classes are aliased (section 4.2.2). */
/* Truncated discounted returns under exploitation (definitions 1 and 2), as published. Each step k
 * needs a fresh database. */
#define RLVC_CRITERION_RETURNS 0u
/* One-step returns r + discount * V(class of s') per class and action, on one growing database.
 * Needs far fewer interactions. */
#define RLVC_CRITERION_RESIDUAL 1u

/* config.score: how well a feature explains a partition (section 4.2.3). */
#define RLVC_SCORE_GAIN 0u /* information gain */
/* Rank-sum test of the targets with the feature against those without it (Wilcoxon 1945, Mann and
 * Whitney 1947). One test per feature instead of one per cutpoint. It only detects targets that are
 * shifted. Not for a domain with its own oracle; capacity must be below 2^21. */
#define RLVC_SCORE_RANKS 3u

/* config.solver: where the values of the classes come from (sections 2.3 and 7). */
#define RLVC_SOLVER_VALUE_ITERATION 0u  /* batch, over the stored interactions */
#define RLVC_SOLVER_POLICY_ITERATION 1u /* batch, likewise */
/* incremental: rlvc_observe updates Q, rlvc_learn only splits */
#define RLVC_SOLVER_Q_LEARNING 2u
#define RLVC_SOLVER_SARSA 3u /* likewise, on-policy */

/* config.explore: which action is tried when the greedy one is not taken. */
#define RLVC_EXPLORE_UNIFORM 0u /* every action with the same probability, as published */
/* Every other exploring action leads to the nearest class-action pair that was little tried, if
 * there is one. The others are drawn, with a preference for actions that were seldom tried in the
 * class and for the previous action (SPEC.md). */
#define RLVC_EXPLORE_DIRECTED 1u

/* Options of an agent, copied by rlvc_agent_init. Start from rlvc_config_default. A method looks
 * at no field that is of the other one. */
typedef struct rlvc_config {
    /* How is learnt, &rlvc_method_classes or &rlvc_method_planner. Default as the domain says. */
    const rlvc_method *method;

    /* Number of actions, [1, 255]; of the planner [2, 64]. No default. */
    uint32_t actions;

    /* Interactions that the ring holds, [1, 2^31 - 1]. When it is full, the oldest one is dropped.
     * Between two episodes it may hold one more; a truncated or interrupted episode takes the room
     * of one more. Of the planner: the percepts that it holds, [64, 10^8]; an episode of n
     * interactions has n + 1. Default 2000. */
    uint32_t capacity;

    /* Classes that the tree may grow to, [1, 65535]. Default 64. */
    uint32_t classes;

    /* Candidate features whose bit columns are in memory at the same time, [1, 64]. Fewer take more
     * time. Default 64, or the domain's features_max if that is known and less. */
    uint32_t features_at_once;

    /* A class with fewer samples (of the actions whose targets differ) is not tested for a split,
     * [2, 2^31 - 1]. Default 8. */
    uint32_t min_samples;

    /* Sweeps after which a batch solver stops without having converged, [1, 2^31 - 1]. Default
     * 10,000. */
    uint32_t max_sweeps;

    /* Seed of all random numbers, any value. Default 1. */
    uint32_t seed;

    uint8_t criterion; /* RLVC_CRITERION_*. Default RLVC_CRITERION_RESIDUAL */
    uint8_t score;     /* RLVC_SCORE_*. Default RLVC_SCORE_GAIN */
    uint8_t solver;    /* RLVC_SOLVER_*. Default RLVC_SOLVER_VALUE_ITERATION */

    /* 1: the window of definition 1 continues through a terminated interaction into the next
     * episode, as in the paper's teleporting maze. 0: it ends there. Default 0. */
    uint8_t continuing;

    /* 1: a class is also aliased if a feature that the agent influences lasts in it, even while all
     * rewards are equal: what s' exhibits depends on the action, and, after the same action, on
     * what s exhibits. So does one that tells where an action ends the episode, as the destination
     * of a taxi. At most features_at_once such features are followed. Needs the residual
     * criterion and a domain with features_max and without an oracle. Default 1 for bits, else 0.
     */
    uint8_t successors;

    uint8_t explore; /* RLVC_EXPLORE_*. Default RLVC_EXPLORE_DIRECTED */

    /* 1: for a feature that is new to the tree the samples of a class count as fewer, if from one
     * visit to the next both the feature and what it leaves unexplained of the targets stay: what
     * stays agrees by chance with other things that do, as a lamp that is on for a while with
     * rewards that drift. Without effect unless `successors` is 1, by which what the agent
     * influences is found. 0: the samples of a class count as independent, as those of counts do
     * (rlvc/counts.h), which keep no order. Default as `successors`, 0 where that is all that was
     * built in. */
    uint8_t dependence;

    uint8_t reserved; /* 0 */

    /* Discount factor, gamma of equation (1), [0, 1]. Default 0.9. What is d moves away counts
     * discount^d, and neighbouring numbers of binary32 differ by a ten millionth: where every move
     * has a reward, what is more than some 150 moves away tells no actions apart at 0.9, nor does
     * what is more than 1,600 away at 0.99. A coarse tolerance ends sight earlier. */
    float discount;

    /* Probability that rlvc_act explores, [0, 1]. Default 0.9. */
    float epsilon;

    /* The probability, at most, that the tree ever tests a feature while there is nothing to learn,
     * (0, 1]. All learning steps and all their tests share it (SPEC.md). Assumes that the samples
     * of one action are independent of each other, or that `dependence` is 1 and their
     * correlations fall off evenly; nothing is assumed about repeated tests of the growing
     * database. Once the tree has classes, it is the same probability for each of them. Default
     * 0.01. */
    float alpha;

    /* Significance level of a split by a feature that the tree already tests, or that the agent
     * influences, and that so is no noise, (0, 1]. Below alpha's share it has no effect. Default
     * 0.1 for bits, else 1: less than one split by chance is expected in a step. */
    float alpha_known;

    /* In units of reward, (0, RLVC_REWARD_MAX]. A batch solver that converges leaves values within
     * this of the fixed point, plus the error of binary32: at most 1e-6 max|V| / (1 - discount).
     * (Policy iteration: of the fixed point of a policy that no other action improves by more than
     * this. Discount 1: only that its last sweep changed no value by more; see
     * RLVC_SOLUTION_ENDLESS.) Under the residual criterion, targets closer than twice this count as
     * equal. Default 0.01. */
    float tolerance;

    /* Learning rate of the incremental solvers, (0, 1]. Default 0.1. */
    float learning_rate;

    /* In units of return, [0, RLVC_REWARD_MAX]. Of very many interactions any difference becomes
     * significant; a class is not split by targets if the mean targets of the two sides surely
     * differ by less, after each action: by three standard errors. Splits by what follows
     * (successors) are made all the same. 0: any difference is worth a split. Default 0. */
    float smallest_effect;

    /* Of the planner: */
    uint32_t sample;       /* interactions that a model is fitted to at most, drawn from the ring,
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
} rlvc_config;

/* Fills *config with the defaults for a domain and a number of actions. The domain is only looked
 * at for features_max and its method; nothing is checked. O(1).
 * @return RLVC_OK. */
RLVC_API rlvc_status rlvc_config_default(rlvc_config *config, const rlvc_domain *domain,
                                         uint32_t actions);

/* Checks every field of a config and a domain. O(1).
 * @param why optional; becomes a constant sentence that names the first field out of range and its
 *            range, or "ok".
 * @return RLVC_OK; RLVC_E_CONFIG. */
RLVC_API rlvc_status rlvc_config_check(const rlvc_config *config, const rlvc_domain *domain,
                                       const char **why);

/* The exact size of an agent's block on this target. O(1).
 * @return RLVC_OK; RLVC_E_CONFIG, or RLVC_E_MEMORY if no size_t holds the size: *bytes is then 0.
 */
RLVC_API rlvc_status rlvc_agent_size(const rlvc_config *config, const rlvc_domain *domain,
                                     size_t *bytes);

/* An upper bound of rlvc_agent_size as a constant expression, for static arrays; at most
 * RLVC_AGENT_FIXED_BYTES above it. Of classes: of a planner it is RLVC_PLANNER_BYTES. */
#ifdef RLVC_RED_ZONES
#define RLVC_AGENT_FIXED_BYTES 4096u /* builds for tests keep the arrays apart */
#else
#define RLVC_AGENT_FIXED_BYTES 1024u
#endif
/* The formatter takes a parenthesis before an operator for a cast. */
/* clang-format off */
#define RLVC_ROUND_UP_8(n) (((size_t)(n) + 7u) / 8u * 8u)
#define RLVC_AGENT_BYTES(actions, capacity, classes, percept_bytes, feature_bytes,                 \
                         features_at_once)                                                         \
    (RLVC_AGENT_FIXED_BYTES + RLVC_REPLAY_BYTES(capacity, percept_bytes) +                         \
     RLVC_TREE_BYTES(classes, feature_bytes) + RLVC_VALUES_BYTES(classes, actions) +               \
     RLVC_SEARCH_BYTES(actions, capacity, feature_bytes, features_at_once))
/* ... whose parts are: the ring's slots, one more than the capacity; */
#define RLVC_REPLAY_BYTES(capacity, percept_bytes)                                                 \
    (RLVC_ROUND_UP_8(((size_t)(capacity) + 1u) * (percept_bytes)) +                                \
     RLVC_ROUND_UP_8(((size_t)(capacity) + 1u) * 4u) +                                             \
     RLVC_ROUND_UP_8(((size_t)(capacity) + 1u) * 2u) +                                             \
     RLVC_ROUND_UP_8((size_t)(capacity) + 1u) * 2u)
/* the nodes, and the record and the feature of each split; */
#define RLVC_TREE_BYTES(classes, feature_bytes)                                                    \
    (RLVC_ROUND_UP_8((2u * (size_t)(classes) - 1u) * 4u) +                                         \
     RLVC_ROUND_UP_8(((size_t)(classes) - 1u) * RLVC_SPLIT_BYTES) +                                \
     RLVC_ROUND_UP_8(((size_t)(classes) - 1u) * (feature_bytes)))
#define RLVC_SPLIT_BYTES 32u
/* the tables by class and action, and by class; */
#define RLVC_VALUES_BYTES(classes, actions)                                                        \
    (RLVC_ROUND_UP_8((size_t)(classes) * (actions) * 4u) * 3u +                                    \
     RLVC_ROUND_UP_8(((size_t)(classes) * (actions) + 1u) * 4u) +                                  \
     RLVC_ROUND_UP_8((size_t)(classes) * 4u) + RLVC_ROUND_UP_8((size_t)(classes) * 2u) +           \
     RLVC_ROUND_UP_8((size_t)(classes) * (actions)) + RLVC_ROUND_UP_8(classes) * 3u +              \
     ((classes) > 512u ? (size_t)(classes) * 8u + RLVC_ROUND_UP_8((size_t)(classes) * 4u) : 0u))
/* and the samples, cutpoints and bit columns of the search for a split. */
#define RLVC_SEARCH_BYTES(actions, capacity, feature_bytes, features_at_once)                      \
    (((size_t)(capacity) + 1u) * 8u + RLVC_SEARCH_WORDS(actions, capacity) * 8u +        \
     RLVC_SEARCH_COLUMN_BYTES(actions, capacity, features_at_once) +                               \
     RLVC_ROUND_UP_8((size_t)(features_at_once) * (feature_bytes)) +                               \
     RLVC_ROUND_UP_8(feature_bytes) * 2u + (size_t)(actions) * 16u +                               \
     (size_t)(features_at_once) * 16u)
#define RLVC_SEARCH_WORDS(actions, capacity)                                                       \
    (((size_t)(capacity) + 1u + 63u * (size_t)(actions)) / 64u)
#define RLVC_SEARCH_COLUMN_BYTES(actions, capacity, features_at_once)                              \
    (((RLVC_SEARCH_WORDS(actions, capacity) | 1u) * (features_at_once) * 8u) > 2048u               \
         ? ((RLVC_SEARCH_WORDS(actions, capacity) | 1u) * (features_at_once) * 8u)                 \
         : 2048u)
/* clang-format on */

/* Makes a new agent in the caller's block: one class that holds every percept, no interaction, step
 * k = 0. The config and the domain are copied; the block belongs to the agent until the caller
 * takes it back (there is nothing to free). It must not be moved. O(classes * actions); of a
 * planner O(bytes).
 * @param memory aligned to RLVC_ALIGNMENT; `bytes` of it, rlvc_agent_size or more
 * @return RLVC_OK; RLVC_E_CONFIG; RLVC_E_MEMORY: the block is untouched and *agent is null. */
RLVC_API rlvc_status rlvc_agent_init(const rlvc_config *config, const rlvc_domain *domain,
                                     void *memory, size_t bytes, rlvc_agent **agent);

/* ------------------------------------------------------------------ acting and observing */

/* What was done, and why: e_t of section 4.2.1. */
typedef struct rlvc_choice {
    uint8_t action;    /* [0, actions) */
    uint8_t exploited; /* 1: the greedy action of the agent's policy; 0: any other reason */
} rlvc_choice;

/* How an interaction ended. */
#define RLVC_GOES_ON 0u    /* s' follows, and is the next current percept */
#define RLVC_TERMINATED 1u /* the episode is over by its own rules: nothing comes after it */
#define RLVC_TRUNCATED 2u  /* cut short from outside (a time limit): s' is still worth something */

/* Starts an episode at a percept, which is copied. If one was under way, it is
 * interrupted here, as if its last interaction had been truncated. O(percept_bytes), and a call of
 * check_percept(). The return of an episode that a planner was interrupted in does not count.
 * @return RLVC_OK; RLVC_E_BUSY: finish the learning step; RLVC_E_PERCEPT: the domain refuses the
 *         percept. */
RLVC_API rlvc_status rlvc_begin(rlvc_agent *agent, const void *percept);

/* Chooses an action for the current percept: epsilon-greedy, in runs. With probability 1 - epsilon
 * a run of k + 1 greedy actions begins (of one under the residual criterion), as section 4.2.1
 * asks; otherwise one action explores, as config.explore says. Each call is a new decision, and is
 * counted by directed exploration. O(actions), and O(depth of the tree) calls of exhibits().
 * A planner acts by one tree for a whole episode: it explores while that is random, or sought for
 * what is new.
 * @return RLVC_OK; RLVC_E_ORDER: no current percept; RLVC_E_CALLBACK. */
RLVC_API rlvc_status rlvc_act(rlvc_agent *agent, rlvc_choice *choice);

/* Stores the interaction <s, a, r, s', e> whose s is the current percept. The choice need not come
 * from rlvc_act. O(percept_bytes), and a call of check_percept(); with an incremental solver also
 * O(depth) calls of exhibits().
 * @param next s', copied; optional (not looked at) if `end` is RLVC_TERMINATED, but of a planner
 *             required, since the model learns what an end looks like
 * @param end  RLVC_GOES_ON, or RLVC_TERMINATED or RLVC_TRUNCATED: then call rlvc_begin next
 * @return RLVC_OK; RLVC_E_ORDER: no current percept; RLVC_E_RANGE: action, exploited or end;
 *         RLVC_E_REWARD; RLVC_E_BUSY; RLVC_E_CALLBACK; RLVC_E_PERCEPT: the domain refuses s'. */
RLVC_API rlvc_status rlvc_observe(rlvc_agent *agent, rlvc_choice choice, float reward,
                                  const void *next, uint8_t end);

/* ------------------------------------------------------------------ learning */

#define RLVC_BUDGET_MIN 64u
#define RLVC_BUDGET_UNBOUNDED UINT32_MAX

typedef struct rlvc_progress {
    uint32_t work;   /* work done by this call, at most its budget */
    uint32_t rounds; /* rounds of refinement begun in this step so far */
    uint32_t splits; /* splits made in this step so far */
    uint8_t done;    /* 1: the step is finished; 0: call again */
    uint8_t reserved[3];
} rlvc_progress;

/* The least budget of rlvc_learn: what cannot be cut. Of classes RLVC_BUDGET_MIN. O(1).
 * @return RLVC_OK. */
RLVC_API rlvc_status rlvc_budget_min(const rlvc_agent *agent, uint32_t *budget);

/* One step of section 4.2.1 (parts 3a to 3c) on the interactions stored when it begins: refines
 * every aliased class until none is left, then solves for the values and increments k. Call it
 * until progress->done. The result does not depend on the budgets. Interactions observed in between
 * wait for the next step. Under the returns criterion the end of a step empties the ring,
 * since the next needs a fresh database.
 *
 * The unit of work is one sample looked at (SPEC.md says what each part of the method is charged);
 * RLVC_BUDGET_UNBOUNDED does the whole step. A step without any new interaction would find
 * nothing, and takes O(classes). A full tree is not an error: rlvc_stats counts
 * the refused splits.
 *
 * A planner's step is another one: rlvc/planner.h.
 * @param budget [RLVC_BUDGET_MIN, UINT32_MAX]; of a planner from rlvc_budget_min on
 * @return RLVC_OK; RLVC_E_RANGE: budget; RLVC_E_CALLBACK: work done before
 *         the failure is kept, as if the budget had ended there. The next call retries that
 *         callback. *progress is filled in. */
RLVC_API rlvc_status rlvc_learn(rlvc_agent *agent, uint32_t budget, rlvc_progress *progress);

/* Abandons the learning step under way and releases the interactions that it held. The next
 * rlvc_learn begins a new step. Use it when a step cannot be finished because a callback keeps
 * failing. Splits and values made so far are kept; k is not incremented. rlvc_begin and
 * rlvc_observe do the same, instead of returning RLVC_E_BUSY, if the last rlvc_learn failed: so the
 * percept that made it fail can leave the ring. O(capacity + classes).
 * @return RLVC_OK, also if no step is under way; RLVC_E_MISMATCH: a planner's steps never fail. */
RLVC_API rlvc_status rlvc_learn_abandon(rlvc_agent *agent);

/* Takes tests out of the tree that the stored interactions do not support (section 7): from the
 * newest to the oldest a split is undone if its two sides are single classes that agree. These
 * become one class with the mean of their Q, weighted by the interactions behind each; classes and
 * splits are numbered anew, in the order they had. Two classes agree if their greedy action is the
 * same and every action was tried in both or in neither, with Q that differ by no more than the
 * tolerance, or than so many standard errors of the difference where both have min_samples in the
 * ring. So no greedy action changes, and a test stays that has one below it which stays.
 *
 * Use it before a tree is read or deployed, or after the world has changed. The next rlvc_learn
 * tests the classes again, and splits those that differ. The standard errors
 * are those of independent samples, which those of one trajectory are not. O(capacity + classes *
 * actions).
 * @param tolerance  in units of return, [0, RLVC_REWARD_MAX]
 * @param deviations [0, 1000]; 0: only the tolerance counts
 * @param undone     how many splits were undone
 * @return RLVC_OK; RLVC_E_RANGE; RLVC_E_BUSY: a learning step is under way; RLVC_E_MISMATCH. */
RLVC_API rlvc_status rlvc_prune(rlvc_agent *agent, float tolerance, float deviations,
                                uint32_t *undone);

/* ------------------------------------------------------------------ asking */

/* The class of a percept and its greedy action: the learnt policy. Changes nothing. While a
 * learning step is under way, the actions are those of the last solution. O(depth) calls of
 * exhibits(). Of a planner the class is a leaf of the tree that rlvc_print prints, and the action 0
 * while there is none.
 * @param class_id, action each optional
 * @return RLVC_OK; RLVC_E_CALLBACK, RLVC_E_PERCEPT (of a planner): *class_id and *action
 *         unchanged. */
RLVC_API rlvc_status rlvc_predict(rlvc_agent *agent, const void *percept, uint32_t *class_id,
                                  uint32_t *action);

/* statistics.solution: what the values are. */
#define RLVC_SOLUTION_CONVERGED 0u /* within the tolerance */
/* They took all of max_sweeps sweeps, and may have been changing still. */
#define RLVC_SOLUTION_CUT_SHORT 1u
/* Discount 1, and the interactions show no way to an end from some classes, or rewards that go on
 * for ever: the sum of rewards is not finite there. These classes' values are held at half of
 * max_sweeps times the greatest mean reward, above or below 0; all others are within the
 * tolerance. */
#define RLVC_SOLUTION_ENDLESS 2u

#define RLVC_RESIDUAL_ENDLESS 1e30f

/* Of a planner those from last_split on are 0, and classes are the leaves of the learnt policy;
 * rlvc/planner.h has more. */
typedef struct rlvc_statistics {
    uint64_t interactions; /* observed since init */
    uint32_t stored;       /* of these, still in the ring */
    uint32_t step;         /* k: learning steps finished */
    uint32_t classes;      /* [1, config.classes] */
    uint32_t depth;        /* of the tree: tests on its longest path */
    uint32_t last_split;   /* the step k at which the newest split was made; 0 if none */
    uint32_t refused;      /* significant splits not made because the tree was full, since init */
    uint32_t sweeps;       /* of the last solution */
    float residual;        /* of the last solution: max |V_new - V_old| of its last sweep, or
                              RLVC_RESIDUAL_ENDLESS */
    uint32_t solution;     /* RLVC_SOLUTION_*, of a batch solver */
    uint32_t reserved;     /* 0 */
} rlvc_statistics;

/* @return RLVC_OK. O(splits); of a planner O(capacity). */
RLVC_API rlvc_status rlvc_stats(const rlvc_agent *agent, rlvc_statistics *statistics);

/* Q(class, action) of the last solution, and how many interactions it rests on (0: untried, and q
 * is 0). O(1).
 * @param q, samples each optional
 * @return RLVC_OK; RLVC_E_RANGE: class_id or action; RLVC_E_MISMATCH. */
RLVC_API rlvc_status rlvc_q(const rlvc_agent *agent, uint32_t class_id, uint32_t action, float *q,
                            uint32_t *samples);

/* V(class) and the greedy action of the last solution. O(1).
 * @param value, action each optional
 * @return RLVC_OK; RLVC_E_RANGE: class_id; RLVC_E_MISMATCH. */
RLVC_API rlvc_status rlvc_value(const rlvc_agent *agent, uint32_t class_id, float *value,
                                uint32_t *action);

/* One split of the tree, in the order in which they were made: split 0 is the root. Split j of
 * class c leaves the percepts without the feature in class c, and gives those with it the new class
 * j + 1. */
typedef struct rlvc_split {
    uint32_t class_id; /* the class that was split */
    uint32_t step;     /* k at that time */

    /* The action whose targets showed the aliasing, [0, actions). `actions`: the evidence of all
     * actions was pooled. `actions` + 1: the successors showed it (config.successors). */
    uint32_t action;

    uint32_t samples; /* of that class and action, or of the class */
    float log_tests;  /* natural logarithm of the number of tests that log_p is corrected by */

    /* Of the split, by config.score. Pooled: the mean over the samples. By ranks: the statistic. By
     * successors: chi-square per sample. */
    float score;

    /* Natural logarithm of the p-value, corrected for the number of tests in this class, but not
     * for the steps that share alpha. */
    float log_p;
} rlvc_split;

/* @param split, feature each optional; feature gets feature_bytes
 * @return RLVC_OK; RLVC_E_RANGE: index is not below classes - 1; RLVC_E_MISMATCH. O(1). */
RLVC_API rlvc_status rlvc_split_at(const rlvc_agent *agent, uint32_t index, rlvc_split *split,
                                   void *feature);

/* Receives `bytes` of text, not terminated. Returns 0, or anything else to fail. */
typedef int (*rlvc_write)(void *ctx, const char *text, size_t bytes);

#define RLVC_PRINT_TEXT 0u /* indented, one node a line */
#define RLVC_PRINT_DOT 1u  /* a Graphviz digraph */
#define RLVC_PRINT_JSON 2u /* one object; SPEC.md gives its form */

/* Prints the tree with the action, value and numbers of each class; of a planner as
 * rlvc_policy_print does. O(nodes * depth).
 * @return RLVC_OK; RLVC_E_RANGE: format; RLVC_E_CALLBACK: a write, or the domain's name(), failed;
 * the text ends where it did. */
RLVC_API rlvc_status rlvc_print(rlvc_agent *agent, uint32_t format, rlvc_write write, void *ctx);

/* Checks every invariant of the agent's memory (SPEC.md lists them). For tests and for debugging.
 * O(capacity + classes * actions), and a call of the domain's checks for each percept in the ring
 * and each feature of the tree.
 * @return RLVC_OK; RLVC_E_MEMORY: damaged; RLVC_E_BUSY: a planner is learning. */
RLVC_API rlvc_status rlvc_agent_check(rlvc_agent *agent);

#ifdef __cplusplus
}
#endif

#endif
