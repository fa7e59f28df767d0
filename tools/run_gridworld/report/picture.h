// SPDX-License-Identifier: MIT
// The two pictures of figure 3 as text: the class of each cell, and its action as an arrow.
#ifndef RUN_GRIDWORLD_REPORT_PICTURE_H
#define RUN_GRIDWORLD_REPORT_PICTURE_H

#include "../maze/policy.h"

#include <string>

// Both pictures with their titles, side by side if the page is wide enough. Walls are blocks, '*'
// is an exit, and '?' a cell whose percepts disagree. ASCII only unless utf8.
std::string draw_pictures(const gridworld_maze &maze, const Policy &policy, bool utf8);

// Whether the user's locale can show UTF-8.
bool locale_has_utf8();

#endif
