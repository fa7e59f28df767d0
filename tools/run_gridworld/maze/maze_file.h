// SPDX-License-Identifier: MIT
// A maze from a file, with the memory of its cells.
#ifndef RUN_GRIDWORLD_MAZE_MAZE_FILE_H
#define RUN_GRIDWORLD_MAZE_MAZE_FILE_H

#include "gridworld.h"

#include <string>
#include <vector>

// The rows of a maze as text, from the top.
std::vector<std::string> rows_of(const gridworld_maze &maze);

class Maze {
  public:
    // Reads a file; an empty name means Sutton's maze, an empty legend that of the file's dialect.
    // Throws Failure.
    explicit Maze(const std::string &file, const std::string &legend = "");
    Maze(const Maze &) = delete;
    Maze &operator=(const Maze &) = delete;

    const gridworld_maze &get() const {
        return maze_;
    }

  private:
    std::vector<unsigned char> cells_;
    gridworld_maze maze_;
};

#endif
