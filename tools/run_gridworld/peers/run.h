// SPDX-License-Identifier: MIT
// One run of a peer on the maze that the library learns, in the same world, judged in the same way.
#ifndef RUN_GRIDWORLD_PEERS_RUN_H
#define RUN_GRIDWORLD_PEERS_RUN_H

#include "../optimum.h"
#include "../options.h"
#include "../outcome.h"

// What the options leave open is up to the peer: see its defaults in run.cc. The policy is looked
// at every 10 interactions, but at most 2,000 times. Throws Interrupted.
Outcome run_peer(const Options &options, const gridworld_maze &maze, const Optimum &optimum,
                 LearnerKind kind, uint32_t seed, const ProgressListener &listener);

#endif
