/* SPDX-License-Identifier: MIT */
/* The C part of the Python package: loops over arrays, and the layout of the structs as compiled.
 * It uses only the public interface of the library.
 *
 * The functions are exported with the library's own; shim/rlvc/_native/bindings.py declares them.
 * Pointers are trusted: the package checks its arrays before it calls. */
#ifndef RLVC_SHIM_H
#define RLVC_SHIM_H

#include "gridworld.h"
#include "rlvc/descriptors.h"
#include "rlvc/rlvc.h"

/* An entry of the table of layouts: the size of a struct ("rlvc_choice"), or the offset of a field
 * ("rlvc_choice.action"). The table ends with a null name. */
typedef struct rlvc_shim_entry {
    const char *name;
    size_t value;
} rlvc_shim_entry;

RLVC_API const rlvc_shim_entry *rlvc_shim_layout(void);

/* The loops below stop at the first element that fails and return its status. *done is its index,
 * or `count`. Elements before it stay processed. `bytes` is the size of a percept. */

/* rlvc_predict for each of `count` percepts.
 * @param percepts of a planner aligned for floats
 * @param classes, actions [count], each optional */
RLVC_API rlvc_status rlvc_shim_predict(rlvc_agent *agent, const unsigned char *percepts,
                                       uint32_t bytes, size_t count, uint32_t *classes,
                                       uint32_t *actions, size_t *done);

/* rlvc_policy_act for each of `count` percepts.
 * @param actions [count] */
RLVC_API rlvc_status rlvc_shim_policy_act(rlvc_policy *policy, const unsigned char *percepts,
                                          uint32_t bytes, size_t count, uint32_t *actions,
                                          size_t *done);

/* Interactions, as arrays of `count` elements. */
typedef struct rlvc_shim_log {
    const unsigned char *percepts, *next; /* `bytes` each */
    rlvc_choice *choices;
    const float *rewards;
    const uint8_t *ends;
    size_t count;
    uint32_t bytes;
    uint32_t actions;
    uint32_t resume; /* 1: the first goes on from the agent's percept; 0: it begins an episode */
} rlvc_shim_log;

/* rlvc_begin and rlvc_act for each percept of a vector of environments: fills log->choices. Reads
 * only percepts, count and bytes. */
RLVC_API rlvc_status rlvc_shim_act(rlvc_agent *agent, const rlvc_shim_log *log, size_t *done);

/* rlvc_observe for each interaction of a log. Two successive interactions belong to one episode if
 * the first goes on and its next percept equals the percept of the second. All are checked before
 * the first is stored: with RLVC_E_RANGE and RLVC_E_REWARD nothing was stored. */
RLVC_API rlvc_status rlvc_shim_observe(rlvc_agent *agent, const rlvc_shim_log *log, size_t *done);

/* A log of rlvc/log.h as arrays of `interactions` elements. */
typedef struct rlvc_shim_records {
    unsigned char *percepts, *next; /* `percept_bytes` each; next is 0 where terminated */
    rlvc_choice *choices;
    float *rewards;
    uint8_t *ends; /* truncated where the writer stopped within an episode */
    size_t interactions;
    size_t fault_at; /* the offset of the fault */
    uint32_t percept_bytes, actions;
    uint32_t torn; /* number of records that were cut short */
    uint32_t reserved;
} rlvc_shim_records;

#define RLVC_SHIM_RECORDS_PERCEPT (1u << 20) /* bytes of the largest percept */
#define RLVC_SHIM_RECORDS_ROOM (RLVC_SHIM_RECORDS_PERCEPT + 13u)

/* Reads a log of `count` bytes into *records; also into its arrays, unless choices and ends are
 * null. A record that was cut short is skipped if it is the last one or a header follows.
 * @param buffer  [RLVC_SHIM_RECORDS_ROOM]
 * @param current [RLVC_SHIM_RECORDS_PERCEPT]
 * @return RLVC_OK; RLVC_E_DAMAGED: bytes or records are missing; RLVC_E_VERSION,
 *         RLVC_E_MISMATCH: a header has another version, or other percepts than the first */
RLVC_API rlvc_status rlvc_shim_records_read(const unsigned char *bytes, size_t count,
                                            unsigned char *buffer, unsigned char *current,
                                            rlvc_shim_records *records);

/* Interactions to be counted, as arrays of `count` elements. */
typedef struct rlvc_shim_columns {
    const unsigned char *percepts, *next; /* bits, as rlvc/bits.h has them */
    const float *keys;                    /* rewards as rows tell them apart */
    const float *rewards;                 /* rewards as they are summed */
    const uint8_t *actions;
    const uint8_t *ends; /* RLVC_GOES_ON, RLVC_TERMINATED or RLVC_TRUNCATED */
    size_t count;
} rlvc_shim_columns;

/* The counts of a part of a log (rlvc/counts.h), in arrays of the caller's. At first all are 0 but
 * the indices, whose elements are all ones. */
typedef struct rlvc_shim_table {
    rlvc_count_row *row;    /* [rows_max] */
    uint64_t *with;         /* [rows_max][features] */
    uint64_t *follow;       /* [rows_max][2][features], or null */
    uint64_t *lanes;        /* [rows_max][kinds][ceil(features / 8)] what is not yet in `with` and,
                               if there is that, in `follow`: kinds is 1, or 3 */
    uint8_t *pending;       /* [rows_max] how many interactions are in `lanes` */
    uint32_t *row_index;    /* [2 rows_max] */
    rlvc_exact_sum *reward; /* [pairs_max], or null: then there are no pairs */
    uint32_t *row_pair;     /* [rows_max] */
    rlvc_count_pair *pair;  /* [pairs_max] */
    uint32_t *pair_index;   /* [2 pairs_max] */
    const uint64_t *gather; /* [gather_bytes][256] the bits of a cell that a byte's values have */
    const uint64_t *spread; /* [256] bit i of a byte as byte i */
    const uint32_t *gather_byte; /* [gather_bytes] which byte of a percept */
    uint32_t rows, rows_max;     /* rows_max and pairs_max are powers of two */
    uint32_t pairs, pairs_max;
    uint32_t features, percept_bytes; /* percept_bytes = ceil(features / 8) */
    uint32_t gather_bytes, actions;
} rlvc_shim_table;

/* Counts interactions from number *done on, which becomes the first that is not counted, or
 * `count`.
 * @return RLVC_OK; RLVC_E_MEMORY: there is no room for another row or pair; RLVC_E_RANGE: its
 *         action or end; RLVC_E_REWARD. O(features / 8) for each interaction. */
RLVC_API rlvc_status rlvc_shim_count(rlvc_shim_table *table, const rlvc_shim_columns *columns,
                                     size_t *done);

/* Completes the counts: nothing is pending any more. O(rows features). */
RLVC_API void rlvc_shim_count_end(rlvc_shim_table *table);

/* Adds counts of the same features and cells.
 * @return RLVC_OK; RLVC_E_MEMORY: no room; some are added then. O(features) a row. */
RLVC_API rlvc_status rlvc_shim_count_add(rlvc_shim_table *table, const rlvc_counts *part);

/* The last solution as tables.
 * @param q, samples    [classes][actions]
 * @param values, policy [classes] */
RLVC_API rlvc_status rlvc_shim_tables(const rlvc_agent *agent, uint32_t classes, uint32_t actions,
                                      float *q, uint32_t *samples, float *values, uint32_t *policy);

/* Text written by the library. */
typedef struct rlvc_shim_text {
    char *bytes;
    size_t room;
    size_t size; /* of the whole text; only the first `room` bytes are kept */
} rlvc_shim_text;

/* Appends to the rlvc_shim_text that `ctx` points to: an rlvc_write.
 * @return 0 */
RLVC_API int rlvc_shim_text_write(void *ctx, const char *bytes, size_t size);

/* A store in memory: both slots, one after the other. */
typedef struct rlvc_shim_memory {
    unsigned char *bytes;
    size_t size; /* 2 * slot_bytes */
} rlvc_shim_memory;

/* Fills *store, which uses *memory from then on. */
RLVC_API void rlvc_shim_memory_store(rlvc_shim_memory *memory, uint32_t slot_bytes,
                                     rlvc_store *store);

/* The methods of a domain in Python, and the exception that one raised. A method gets addresses as
 * numbers, and returns a number: exhibits and the checks 0 or 1, candidates how many it wrote,
 * oracle how many it considered, the others 0. */
typedef struct rlvc_shim_python {
    /* Python objects; may be null: detect, oracle and the checks */
    void *exhibits, *candidates, *detect, *oracle, *name, *check_percept, *check_feature;
    void *type, *value, *traceback; /* of the exception; null: there is none */
    uint32_t depth;                 /* how many methods are running */
    uint32_t reserved;
} rlvc_shim_python;

/* Hands over the functions of Python's C interface: PyGILState_Ensure, PyGILState_Release,
 * PyObject_CallFunction, PyLong_AsLongLong, PyErr_Fetch, PyErr_Restore, Py_DecRef. */
RLVC_API void rlvc_shim_python_init(int (*ensure)(void), void (*release)(int),
                                    void *(*call)(void *, const char *, ...),
                                    long long (*number)(void *),
                                    void (*fetch)(void **, void **, void **),
                                    void (*restore)(void *, void *, void *), void (*drop)(void *));

/* Fills the callbacks of *domain, which use *methods from then on. */
RLVC_API void rlvc_shim_python_domain(rlvc_shim_python *methods, rlvc_domain *domain);

/* Raises the exception that was kept, if there is one: to be called with the interpreter's lock.
 * @return RLVC_E_CALLBACK */
RLVC_API rlvc_status rlvc_shim_python_raise(rlvc_shim_python *methods);

/* Drops the exception that was kept, if there is one: to be called with the interpreter's lock. */
RLVC_API void rlvc_shim_python_forget(rlvc_shim_python *methods);

/* Gives a file that has no name (O_TMPFILE) the name of another file, which it replaces in one
 * step. It is linked under a temporary name first, and renamed; a process of its own does both, so
 * that nothing is left under that name when the caller, or its process group, is killed in between.
 * That process keeps the file's lock until it is done. O(1) system calls.
 * @param file, folder descriptors
 * @param temporary, name in that folder
 * @return 0; an errno: the folder is as it was; -1: not on Linux */
RLVC_API int rlvc_shim_give_name(int file, int folder, const char *temporary, const char *name);

/* Do nothing, with the arguments of rlvc_act and rlvc_observe: the minimum cost of a call from
 * Python. */
RLVC_API rlvc_status rlvc_shim_empty_act(rlvc_agent *agent, rlvc_choice *choice);
RLVC_API rlvc_status rlvc_shim_empty_observe(rlvc_agent *agent, rlvc_choice choice, float reward,
                                             const void *next, uint8_t end);

/* The maze for the environments: gridworld.h documents these functions. */
RLVC_API const gridworld_maze *rlvc_shim_sutton(void);
RLVC_API int rlvc_shim_maze_parse(gridworld_maze *maze, const char *text, size_t bytes,
                                  unsigned char *cells, size_t room, gridworld_error *error);
RLVC_API uint32_t rlvc_shim_maze_bits(const gridworld_maze *maze, uint32_t distractors);
RLVC_API void rlvc_shim_maze_encode(const gridworld_maze *maze, uint32_t distractors, uint32_t cell,
                                    gridworld_random *random, unsigned char *percept);
RLVC_API int rlvc_shim_world_init(gridworld *world, const gridworld_maze *maze,
                                  uint32_t distractors, float slip, uint32_t seed);
RLVC_API void rlvc_shim_world_reset(gridworld *world);
RLVC_API void rlvc_shim_world_percept(gridworld *world, unsigned char *percept);
RLVC_API int rlvc_shim_world_step(gridworld *world, uint32_t action, float *reward);

#endif
