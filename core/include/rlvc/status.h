/* SPDX-License-Identifier: MIT */
/* Status codes: what every function of the library returns.
 *
 * A function that fails changes neither its arguments nor the agent. The one exception is
 * rlvc_learn: it keeps what it finished before a callback failed. */
#ifndef RLVC_STATUS_H
#define RLVC_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

/* RLVC_SHARED is set while a shared library is made, RLVC_DLL while one of Windows is used. */
#if defined(RLVC_SHARED) && defined(_WIN32)
#define RLVC_API __declspec(dllexport)
#elif defined(RLVC_DLL)
#define RLVC_API __declspec(dllimport)
#elif defined(RLVC_SHARED) && defined(__GNUC__)
#define RLVC_API __attribute__((visibility("default")))
#else
#define RLVC_API
#endif

/* Values never change; new ones are appended. An enum may be one byte wide on a bare-metal Arm
 * (-fshort-enums), so it is a return type only and never a struct's field. */
typedef enum rlvc_status {
    RLVC_OK = 0,
    RLVC_E_NULL = -1,     /* a pointer that must not be null is null */
    RLVC_E_CONFIG = -2,   /* a field of the config or the domain is out of range:
                             rlvc_config_check says which */
    RLVC_E_MEMORY = -3,   /* the block is too small or not aligned to RLVC_ALIGNMENT */
    RLVC_E_ORDER = -4,    /* there is no current percept: call rlvc_begin first */
    RLVC_E_RANGE = -5,    /* an action, class, index or budget is out of range */
    RLVC_E_REWARD = -6,   /* a reward is not a finite number within +-RLVC_REWARD_MAX */
    RLVC_E_BUSY = -7,     /* a step of learning is under way, and the ring is full of what it needs,
                             or a planner cannot be saved before its end: finish it first */
    RLVC_E_CALLBACK = -8, /* a callback of the domain, or the caller's write, failed */
    RLVC_E_REENTERED = -9, /* a callback called back into the agent that had called it */
    RLVC_E_STORE = -10,    /* a read, write, erase or sync of the caller's store failed */
    RLVC_E_EMPTY = -11,    /* the store holds no snapshot */
    RLVC_E_DAMAGED = -12,  /* the snapshot is truncated or corrupt */
    RLVC_E_VERSION = -13,  /* the snapshot has a version that this library does not read */
    RLVC_E_MISMATCH = -14, /* the snapshot was saved with another config or domain; or the function
                              is not of the agent's method */
    RLVC_E_PERCEPT = -15   /* the domain refuses the percept */
} rlvc_status;

/* A constant English sentence for a status. Never null, even for an unknown value. O(1). */
RLVC_API const char *rlvc_status_text(rlvc_status status);

#ifdef __cplusplus
}
#endif

#endif
