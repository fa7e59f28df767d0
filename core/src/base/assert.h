/* SPDX-License-Identifier: MIT */
/* Internal assertions, for the library's own tests. In a controller they are compiled out. No
 * caller can trigger one, since the public functions validate their arguments. */
#ifndef RLVC_SRC_ASSERT_H
#define RLVC_SRC_ASSERT_H

#ifdef RLVC_ASSERTS
#include <assert.h>
#define RLVC_ASSERT(condition) assert(condition)
#else
#define RLVC_ASSERT(condition) ((void)0)
#endif

#endif
