/* SPDX-License-Identifier: MIT */
/* Statuses in words, and the library's version. */
#include "rlvc/float_rules.h"

#include "rlvc/rlvc.h"

const char *rlvc_status_text(rlvc_status status) {
    static const char *const texts[] = {
        [-RLVC_OK] = "ok",
        [-RLVC_E_NULL] = "a required pointer is null",
        [-RLVC_E_CONFIG] = "a field of the config or the domain is out of range "
                           "(rlvc_config_check says which)",
        [-RLVC_E_MEMORY] = "the memory block is too small, not aligned to 8, or damaged",
        [-RLVC_E_ORDER] = "there is no current percept (call rlvc_begin first)",
        [-RLVC_E_RANGE] = "an action, class, index or budget is out of range",
        [-RLVC_E_REWARD] = "a reward is not a finite number within +-1e12",
        [-RLVC_E_BUSY] = "a step of learning is under way, and the ring is full of what it "
                         "needs, or it is too early to save (finish learning)",
        [-RLVC_E_CALLBACK] = "a callback failed",
        [-RLVC_E_REENTERED] = "a callback called back into the agent that had called it",
        [-RLVC_E_STORE] = "a read, write, erase or sync of the store failed",
        [-RLVC_E_EMPTY] = "the store holds no snapshot",
        [-RLVC_E_DAMAGED] = "the snapshot is truncated or corrupt",
        [-RLVC_E_VERSION] = "the snapshot is of a version that this library does not read",
        [-RLVC_E_MISMATCH] = "the snapshot is of another config or another domain",
        [-RLVC_E_PERCEPT] =
            "the domain refuses the percept: a number in it is not finite or out of "
            "range",
    };
    const uint32_t index = 0u - (uint32_t)status;
    return index < sizeof texts / sizeof texts[0] ? texts[index] : "not a status of rlvc";
}

const char *rlvc_version(void) {
    return RLVC_VERSION;
}
