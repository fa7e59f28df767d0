// SPDX-License-Identifier: MIT
// The two pictures of figure 3 as text: the class of each cell, and its action as an arrow.
#ifndef RUN_GRIDWORLD_PICTURE_H
#define RUN_GRIDWORLD_PICTURE_H

#include "policy.h"

#include <string>

// Both pictures with their titles, side by side where they fit into the width. Walls are blocks, an
// exit is '*', and '?' stands where the percepts of one cell do not agree. Signs outside ASCII only
// if utf8.
std::string draw_pictures(const gridworld_maze &maze, const Policy &policy, bool utf8);

// Whether the user's locale can show UTF-8.
bool locale_has_utf8();

#endif
