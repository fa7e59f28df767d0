/* SPDX-License-Identifier: MIT */
/* Gives a file without a name the name of another file: see shim.h.
 *
 * Linux replaces a name by another name only, so that the new file must have one first: two system
 * calls, and a process that is killed between them would leave that name in the folder for ever. So
 * a second process makes them, out of reach of a signal that is meant for the first or for its
 * group. It is made as posix_spawn makes one: it shares the memory, and the first waits for it. */
#define _GNU_SOURCE /* NOLINT(bugprone-reserved-identifier): of the C library */
#include "shim.h"

#ifdef __linux__
#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

#define STACK_WORDS 4096u /* of 8 bytes */

typedef struct naming {
    char here[32];
    const char *temporary, *name;
    int folder;
    int error; /* 0, or as of errno; EINTR until it is known */
} naming;

static int give_name(void *ctx) {
    naming *names = ctx;
    if (linkat(AT_FDCWD, names->here, names->folder, names->temporary, AT_SYMLINK_FOLLOW) != 0) {
        names->error = errno;
    } else if (renameat(names->folder, names->temporary, names->folder, names->name) != 0) {
        names->error = errno;
        (void)unlinkat(names->folder, names->temporary, 0);
    } else {
        names->error = 0;
    }
    return 0;
}

static int give_name_apart(void *ctx) {
    (void)setsid();
    return give_name(ctx);
}

int rlvc_shim_give_name(int file, int folder, const char *temporary, const char *name) {
    uint64_t stack[STACK_WORDS];
    uint64_t *top = stack + STACK_WORDS - (uintptr_t)stack % 16u / 8u; /* aligned to 16 */
    naming names = {"", temporary, name, folder, EINTR};
    sigset_t all, before;
    (void)snprintf(names.here, sizeof names.here, "/proc/self/fd/%d", file);
    /* No handler of the first process may run in the second. */
    (void)sigfillset(&all);
    (void)sigprocmask(SIG_BLOCK, &all, &before);
    const int second = clone(give_name_apart, top, CLONE_VM | CLONE_VFORK, &names);
    if (second > 0)
        (void)waitpid(second, NULL, (int)__WCLONE);
    (void)sigprocmask(SIG_SETMASK, &before, NULL);
    if (second < 0) /* there may be no more processes */
        (void)give_name(&names);
    return names.error;
}

#else

int rlvc_shim_give_name(int file, int folder, const char *temporary, const char *name) {
    (void)file;
    (void)folder;
    (void)temporary;
    (void)name;
    return -1; /* only Linux has files without a name */
}

#endif
