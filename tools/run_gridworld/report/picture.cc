// SPDX-License-Identifier: MIT
#include "picture.h"

#include <algorithm>
#include <clocale>
#include <cstring>
#include <functional>

#include <langinfo.h>

namespace {

constexpr std::size_t page_width = 100;
constexpr char signs[] = "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
constexpr uint32_t sign_count = sizeof signs - 1;
constexpr const char *gap = "    ";

struct Picture {
    std::string title;
    std::vector<std::string> lines;
    std::size_t columns; // on the screen, of each line
};

struct Style {
    const char *wall, *line, *bar, *corners[4]; // corners by row, the upper left one first
    const char *arrows[GRIDWORLD_ACTIONS];
};

const Style plain{"#", "-", "|", {"+", "+", "+", "+"}, {"^", ">", "v", "<"}};
const Style pretty{"█", "─", "│", {"┌", "┐", "└", "┘"}, {"↑", "→", "↓", "←"}};

std::string repeat(const std::string &text, std::size_t times) {
    std::string all;
    for (std::size_t i = 0; i < times; i++) {
        all += text;
    }
    return all;
}

// Frames the cells; free_cell gives the text of a free one, `columns` wide on the screen.
Picture draw(const gridworld_maze &maze, const Style &style, const std::string &title,
             std::size_t columns, const std::function<std::string(uint32_t)> &free_cell) {
    const std::size_t inside = columns * maze.width;
    const std::string edge = repeat(style.line, inside);
    Picture picture{title, {}, inside + 2};
    picture.lines.push_back(style.corners[0] + edge + style.corners[1]);
    for (uint32_t y = 0; y < maze.height; y++) {
        std::string line = style.bar;
        for (uint32_t cell = y * maze.width; cell < (y + 1) * maze.width; cell++) {
            if (maze.cells[cell] == GRIDWORLD_WALL) {
                line += repeat(style.wall, columns);
            } else if (maze.cells[cell] == GRIDWORLD_EXIT) {
                line += std::string(columns - 1, ' ') + "*";
            } else {
                line += free_cell(cell);
            }
        }
        picture.lines.push_back(line + style.bar);
    }
    picture.lines.push_back(style.corners[2] + edge + style.corners[3]);
    return picture;
}

std::string right_aligned(const std::string &text, std::size_t columns) {
    return std::string(columns - std::min(columns, text.size()), ' ') + text;
}

Picture draw_classes(const gridworld_maze &maze, const Policy &policy, const Style &style) {
    uint32_t last = 0;
    for (const CellPolicy &cell : policy.cells) {
        last = std::max(last, cell.class_id.value_or(0));
    }
    const std::size_t numbered = std::to_string(last).size() + 1;
    if (numbered * maze.width <= page_width) {
        return draw(maze, style, "Classes", numbered, [&](uint32_t cell) {
            const std::optional<uint32_t> id = policy.cells[cell].class_id;
            return right_aligned(id ? std::to_string(*id) : "?", numbered);
        });
    }
    return draw(maze, style, "Classes (by number modulo 62: 0-9, a-z, A-Z)", 1, [&](uint32_t cell) {
        const std::optional<uint32_t> id = policy.cells[cell].class_id;
        return std::string(1, id ? signs[*id % sign_count] : '?');
    });
}

Picture draw_policy(const gridworld_maze &maze, const Policy &policy, const Style &style) {
    const std::size_t columns = 2 * maze.width <= page_width ? 2 : 1;
    return draw(maze, style, "Policy", columns, [&](uint32_t cell) {
        const std::optional<uint32_t> action = policy.cells[cell].action;
        return std::string(columns - 1, ' ') + (action ? style.arrows[*action] : "?");
    });
}

std::string below(const Picture &picture) {
    std::string all = picture.title + "\n";
    for (const std::string &line : picture.lines) {
        all += line + "\n";
    }
    return all;
}

std::string beside(const Picture &left, const Picture &right) {
    const std::size_t columns = std::max(left.columns, left.title.size());
    std::string all =
        left.title + std::string(columns - left.title.size(), ' ') + gap + right.title + "\n";
    for (std::size_t i = 0; i < left.lines.size(); i++) {
        all +=
            left.lines[i] + std::string(columns - left.columns, ' ') + gap + right.lines[i] + "\n";
    }
    return all;
}

} // namespace

std::string draw_pictures(const gridworld_maze &maze, const Policy &policy, bool utf8) {
    const Style &style = utf8 ? pretty : plain;
    const Picture classes = draw_classes(maze, policy, style);
    const Picture arrows = draw_policy(maze, policy, style);
    if (classes.columns + std::strlen(gap) + arrows.columns <= page_width) {
        return beside(classes, arrows);
    }
    return below(classes) + "\n" + below(arrows);
}

bool locale_has_utf8() {
    // Only the characters: numbers keep their point.
    return std::setlocale(LC_CTYPE, "") && std::strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
}
