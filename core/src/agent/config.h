/* SPDX-License-Identifier: MIT */
/* Checks a config without saying why, and so without text in flash: see config.c. */
#ifndef RLVC_SRC_CONFIG_H
#define RLVC_SRC_CONFIG_H

#include "rlvc/agent.h"

/* What rlvc_config_check returns. O(1). */
rlvc_status rlvc_config_status(const rlvc_config *config, const rlvc_domain *domain);

#endif
