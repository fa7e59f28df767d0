// SPDX-License-Identifier: MIT
// A maze and the memory of its cells.
#ifndef RUN_GRIDWORLD_MAZE_FILE_H
#define RUN_GRIDWORLD_MAZE_FILE_H

#include "gridworld.h"

#include <string>
#include <vector>

class Maze {
  public:
    // Reads a file, or takes Sutton's maze if its name is empty. Throws Failure.
    explicit Maze(const std::string &file);
    Maze(const Maze &) = delete;
    Maze &operator=(const Maze &) = delete;

    const gridworld_maze &get() const {
        return maze_;
    }

    // The maze's rows, as in its text.
    std::vector<std::string> rows() const;

  private:
    std::vector<unsigned char> cells_;
    gridworld_maze maze_;
};

#endif
