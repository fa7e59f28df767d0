/* SPDX-License-Identifier: MIT */
/* Assertions of the library's inside. They are for its own tests: in a controller they are compiled
 * out, and nothing that a caller can do reaches one, since the public functions validate. */
#ifndef RLVC_SRC_ASSERT_H
#define RLVC_SRC_ASSERT_H

#ifdef RLVC_ASSERTS
#include <assert.h>
#define RLVC_ASSERT(condition) assert(condition)
#else
#define RLVC_ASSERT(condition) ((void)0)
#endif

#endif
