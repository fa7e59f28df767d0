// SPDX-License-Identifier: MIT
// The ways in which mazes are written: other signs for walls, free cells and the exit, other ends
// of lines, a byte order mark, blanks between cells.
#ifndef RUN_GRIDWORLD_MAZE_DIALECT_H
#define RUN_GRIDWORLD_MAZE_DIALECT_H

#include <string>

// What signs mean: each string holds the characters of its kind.
struct Legend {
    std::string wall, free, exit;
};

// Reads "wall=#,free=. ,exit=*". Throws Failure.
Legend read_legend(const std::string &text);

// The maze as gridworld_parse takes it: '#', '.' and '*'. An empty legend means that of the dialect
// which the text is in; a text in none is returned with its own signs, for the parser to refuse.
// Throws Failure, which names the file.
std::string plain_maze(const std::string &text, const std::string &legend, const std::string &file);

#endif
