// SPDX-License-Identifier: MIT
// What the command lines of both subcommands share: checks of values, and refusals that name the option.
#ifndef RUN_GRIDWORLD_ARGUMENTS_H
#define RUN_GRIDWORLD_ARGUMENTS_H

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>
#include <vector>

// Validators look at the text, before it is converted: "-1", "1e3" and "nan" must not slip through.
CLI::Validator whole(uint64_t low, uint64_t high);

enum class Ends { closed, open_below, open_above };

// A number from low to high, with or without its ends, also once it is a binary32.
CLI::Validator number(float low, float high, Ends ends = Ends::closed);

CLI::Validator file_name();
CLI::Validator one_of(const std::vector<std::string> &names);

// --criterion, which is the residual if nothing else is asked for.
void add_criterion(CLI::App &app, uint8_t &criterion);

struct NamedFile {
    std::string option, file; // no file: an empty name
};

// Throws Failure if two of them are one.
void check_files_differ(const std::vector<NamedFile> &files);

// Reads a command line. False: help or the version was asked for, and is printed. Throws Failure, and
// CLI::RequiredError, which the caller knows the words for.
bool parse(CLI::App &app, int argc, char **argv);

#endif
