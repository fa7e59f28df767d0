// SPDX-License-Identifier: MIT
#include "maze_file.h"

#include "../cli/failure.h"
#include "../cli/interrupt.h"
#include "dialect.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace {

// The largest text of a maze: three bytes a cell and a blank beside it, comments, and a byte more:
// a file that fills it is too large.
constexpr std::size_t room = GRIDWORLD_SIDE_MAX * (4 * GRIDWORLD_SIDE_MAX + 2) + 4096 + 1;

std::string read_all(const std::string &file) {
    errno = 0;
    const InterruptibleWait waits;
    const char *name = file == "-" ? "/dev/stdin" : file.c_str();
    const std::unique_ptr<std::FILE, int (*)(std::FILE *)> in(std::fopen(name, "rb"), std::fclose);
    std::string text(room, '\0');
    const std::size_t bytes = in ? std::fread(text.data(), 1, room, in.get()) : 0;
    InterruptibleWait::check();
    if (!in || std::ferror(in.get())) {
        throw Failure("--maze: cannot read '" + file + "': " + std::strerror(errno));
    }
    text.resize(bytes);
    return text;
}

std::string place(const std::string &file, const gridworld_error &error) {
    if (error.line == 0) {
        return file + ": ";
    }
    return file + ":" + std::to_string(error.line) + ":" + std::to_string(error.column) + ": ";
}

} // namespace

Maze::Maze(const std::string &file, const std::string &legend) : maze_(gridworld_sutton) {
    if (file.empty()) {
        return;
    }
    const std::string text = plain_maze(read_all(file), legend, file);
    gridworld_error error;
    cells_.resize(GRIDWORLD_CELLS_MAX);
    if (gridworld_parse(&maze_, text.data(), text.size(), cells_.data(), cells_.size(), &error)) {
        const bool sign = std::strncmp(error.what, "not a cell", 10) == 0;
        throw Failure(place(file, error) + error.what +
                      (sign ? "; --legend wall=...,free=...,exit=... tells of other signs" : ""));
    }
}

std::vector<std::string> rows_of(const gridworld_maze &maze) {
    std::vector<std::string> rows;
    for (uint32_t y = 0; y < maze.height; y++) {
        const unsigned char *first = maze.cells + std::size_t{y} * maze.width;
        rows.emplace_back(first, first + maze.width);
    }
    return rows;
}
