// SPDX-License-Identifier: MIT
// Reading a command line: checks of values, and messages that name the option.
#ifndef RUN_GRIDWORLD_CLI_ARGUMENTS_H
#define RUN_GRIDWORLD_CLI_ARGUMENTS_H

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>
#include <vector>

// Validators check the text before it is converted, so that "-1", "1e3" and "nan" are refused.
CLI::Validator whole(uint64_t low, uint64_t high);

enum class Interval { closed, open_low, open_high };

// A number between low and high, also after rounding to binary32.
CLI::Validator number(float low, float high, Interval interval = Interval::closed);

CLI::Validator file_name();
CLI::Validator one_of(const std::vector<std::string> &names);

// Adds an option for a whole number, for a file that is read, or for one that is written.
void add_whole(CLI::App &app, const std::string &name, uint32_t &into, uint64_t low, uint64_t high,
               const char *text);
void add_file(CLI::App &app, const std::string &name, std::string &into, const char *text);
void add_output(CLI::App &app, const std::string &name, std::string &into, const char *text);

// A value that has a name on the command line and a number in the library.
struct Named {
    const char *name;
    uint8_t number;
};

// Adds an option that takes one of these names. The first one is the default. `all` must outlive
// the app.
void add_named(CLI::App &app, const std::string &name, const std::vector<Named> &all, uint8_t &into,
               const char *text);

const char *name_of(const std::vector<Named> &all, uint8_t number);

struct NamedFile {
    std::string option, file; // an empty name: no file
};

// Throws Failure if two of them are the same file.
void check_files_differ(const std::vector<NamedFile> &files);

// Reads the command line of a subcommand, which is argv[0]. Prints what --help and --version ask
// for and returns false then. Throws Failure.
bool parse(CLI::App &app, int argc, char **argv);

#endif
