/* SPDX-License-Identifier: MIT */
/* Statuses in words, and the library's version. */
#include "rlvc/rlvc.h"

const char *rlvc_status_text(rlvc_status status) {
    switch (status) {
    case RLVC_OK:
        return "ok";
    case RLVC_E_NULL:
        return "a required pointer is null";
    case RLVC_E_CONFIG:
        return "a field of the config or the domain is out of range (rlvc_config_check says which)";
    case RLVC_E_MEMORY:
        return "the memory block is too small, not aligned to 8, or damaged";
    case RLVC_E_ORDER:
        return "there is no current percept (call rlvc_begin first)";
    case RLVC_E_RANGE:
        return "an action, class, index or budget is out of range";
    case RLVC_E_REWARD:
        return "a reward is not a finite number within +-1e12";
    case RLVC_E_BUSY:
        return "the ring is full and its oldest interaction is being learnt from (finish learning)";
    case RLVC_E_CALLBACK:
        return "a callback failed";
    case RLVC_E_REENTERED:
        return "a callback called back into the agent that had called it";
    case RLVC_E_STORE:
        return "a read, write, erase or sync of the store failed";
    case RLVC_E_EMPTY:
        return "the store holds no snapshot";
    case RLVC_E_DAMAGED:
        return "what is stored was cut short or changed";
    case RLVC_E_VERSION:
        return "what is stored is of a version that this library does not read";
    case RLVC_E_MISMATCH:
        return "what is stored is of another config or another domain";
    case RLVC_E_PERCEPT:
        return "the domain refuses the percept: a number in it is not finite or out of range";
    }
    return "not a status of rlvc";
}

const char *rlvc_version(void) {
    return RLVC_VERSION;
}
