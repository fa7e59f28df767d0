/* SPDX-License-Identifier: MIT */
/* Loading an agent from a store whose bytes are unknown: by the contract of streams, which the
 * driver `stream` proves. A step that was under way is begun anew by the rooms of learning, which
 * are left out. */
#include "agent.h"
#include "rlvc/snapshot.h"
#include "store/cursor_marks.h"
#include "stream.h"

/*@ assigns \result \from indirect: agent, indirect: mark; */
rlvc_status rlvc_cursor_marks_resume(rlvc_agent *agent, const rlvc_cursor_mark *mark);

int eva_store(void) {
    const rlvc_store store = {0, 2048, read_any, write_any, erase_any, sync_any};
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    small_config(&domain, &config);
    (void)rlvc_load(&config, &domain, memory, sizeof memory, &store, &agent);
    return 0;
}
