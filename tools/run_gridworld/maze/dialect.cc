// SPDX-License-Identifier: MIT
#include "dialect.h"

#include "../cli/failure.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace {

using Rows = std::vector<std::string>;

// The dialects in use. The first one that knows all signs of a maze, and an exit and a free cell
// among them, holds: the plain one; letters for start and goal, or A and B; blanks as free cells; X
// as walls; FrozenLake, whose holes are walls here; Pacman, whose food is the exit; numbers, with 2
// or 3 as the exit.
const Legend dialects[] = {
    {"#", ".", "*"},    {"#", ".SAR", "GEX*"}, {"#", " SAPR.", "GE*"},
    {"#", " .A", "B"},  {"X", " .SP", "GE*"},  {"H", "SF", "G"},
    {"%", " PGo", "."}, {"1", "0", "2"},       {"1", "02", "3"},
};

const char *const block = "\xe2\x96\x88"; // a full block in UTF-8

std::string decoded(const std::string &text, const std::string &file) {
    if (text.compare(0, 3, "\xef\xbb\xbf") == 0) {
        return text.substr(3);
    }
    const bool low_first = text.compare(0, 2, "\xff\xfe") == 0;
    if (!low_first && text.compare(0, 2, "\xfe\xff") != 0) {
        return text;
    }
    std::string narrow; // UTF-16
    for (std::size_t i = 2; i + 1 < text.size(); i += 2) {
        if (text[i + (low_first ? 1 : 0)] != '\0') {
            throw Failure(file + ": UTF-16 with signs beyond ASCII: save it as UTF-8");
        }
        narrow += text[i + (low_first ? 0 : 1)];
    }
    return narrow;
}

Rows lines_of(const std::string &text) {
    Rows rows(1);
    for (std::size_t i = 0; i < text.size(); i++) {
        if (text[i] == '\n' || text[i] == '\r') {
            i += text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n' ? 1 : 0;
            rows.emplace_back();
        } else if (text.compare(i, 3, block) == 0) {
            rows.back() += '#';
            i += 2;
        } else {
            rows.back() += text[i];
        }
    }
    for (std::string &row : rows) {
        row.erase(row.find_last_not_of(" \t") + 1);
    }
    while (!rows.empty() && rows.back().empty()) {
        rows.pop_back();
    }
    return rows;
}

bool is_number(const std::string &text) {
    return !text.empty() && std::all_of(text.begin(), text.end(),
                                        [](unsigned char c) { return std::isdigit(c) != 0; });
}

// Words after a sign of comments: two letters, one after the other.
bool is_comment(const std::string &row) {
    if (row.empty() || (row[0] != '#' && row[0] != ';')) {
        return false;
    }
    return std::adjacent_find(row.begin(), row.end(), [](unsigned char a, unsigned char b) {
               return std::islower(a) != 0 && std::islower(b) != 0;
           }) != row.end();
}

// Without comments, and without the number of rows, before the first row.
void drop_head(Rows &rows) {
    while (!rows.empty() && (is_comment(rows[0]) || (rows[0].empty() && rows.size() > 1))) {
        rows.erase(rows.begin());
    }
    if (rows.size() > 1 && is_number(rows[0]) && rows[0] == std::to_string(rows.size() - 1) &&
        rows[0].size() < rows[1].size()) {
        rows.erase(rows.begin());
    }
}

// Cells with a blank, a tab or a comma between any two.
bool is_spaced(const std::string &row) {
    for (std::size_t i = 1; i < row.size(); i += 2) {
        if ((row[i] != ' ' && row[i] != '\t' && row[i] != ',') || i + 1 == row.size()) {
            return false;
        }
    }
    return row.size() >= 3 && row.find_first_of(" \t,") == 1;
}

void close_up(Rows &rows) {
    if (!std::all_of(rows.begin(), rows.end(), is_spaced)) {
        return;
    }
    for (std::string &row : rows) {
        std::string cells;
        for (std::size_t i = 0; i < row.size(); i += 2) {
            cells += row[i];
        }
        row = cells;
    }
}

bool knows(const Legend &legend, const Rows &rows) {
    const std::string all = legend.wall + legend.free + legend.exit;
    bool exits = false, frees = false;
    for (const std::string &row : rows) {
        if (row.find_first_not_of(all) != std::string::npos) {
            return false;
        }
        exits = exits || row.find_first_of(legend.exit) != std::string::npos;
        frees = frees || row.find_first_of(legend.free) != std::string::npos;
    }
    return exits && frees;
}

// A blank at the end of a row was taken off with those that mean nothing: put it on again.
void fill(Rows &rows) {
    std::size_t width = 0;
    for (const std::string &row : rows) {
        width = std::max(width, row.size());
    }
    for (std::string &row : rows) {
        row.resize(width, ' ');
    }
}

std::string written(const Legend &legend, Rows rows, const std::string &file) {
    if (legend.free.find(' ') != std::string::npos || legend.wall.find(' ') != std::string::npos) {
        fill(rows);
    }
    std::string text;
    for (std::size_t y = 0; y < rows.size(); y++) {
        for (std::size_t x = 0; x < rows[y].size(); x++) {
            const char sign = rows[y][x];
            if (legend.wall.find(sign) == std::string::npos &&
                legend.free.find(sign) == std::string::npos &&
                legend.exit.find(sign) == std::string::npos) {
                throw Failure(file + ":" + std::to_string(y + 1) + ":" + std::to_string(x + 1) +
                              ": '" + sign + "' is not in --legend");
            }
            text += legend.exit.find(sign) != std::string::npos   ? '*'
                    : legend.wall.find(sign) != std::string::npos ? '#'
                                                                  : '.';
        }
        text += '\n';
    }
    return text;
}

std::string joined(const Rows &rows) {
    std::string text;
    for (const std::string &row : rows) {
        text += row + '\n';
    }
    return text;
}

} // namespace

Legend read_legend(const std::string &text) {
    Legend legend;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t sign = text.find('=', at);
        const std::string name = text.substr(at, sign == std::string::npos ? sign : sign - at);
        std::string *kind = name == "wall"   ? &legend.wall
                            : name == "free" ? &legend.free
                            : name == "exit" ? &legend.exit
                                             : nullptr;
        if (sign == std::string::npos || kind == nullptr) {
            throw Failure("--legend: '" + text + "': expected such as wall=#,free=.,exit=*");
        }
        const std::size_t end = std::min(text.find(',', sign + 2), text.size());
        *kind = text.substr(sign + 1, end - sign - 1);
        at = end + 1;
    }
    if (legend.free.empty() || legend.exit.empty()) {
        throw Failure("--legend: '" + text + "': name the signs of free and exit");
    }
    return legend;
}

std::string plain_maze(const std::string &text, const std::string &legend,
                       const std::string &file) {
    Rows rows = lines_of(decoded(text, file));
    drop_head(rows);
    close_up(rows);
    if (!legend.empty()) {
        return written(read_legend(legend), rows, file);
    }
    for (const Legend &dialect : dialects) {
        if (knows(dialect, rows)) {
            return written(dialect, rows, file);
        }
    }
    return joined(rows);
}
