// SPDX-License-Identifier: MIT
#include "arguments.h"

#include "failure.h"
#include "screen.h"

#include "rlvc/rlvc.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <sstream>

namespace {

// Options by their old names still work.
constexpr struct {
    const char *old_name, *name;
} renamed[] = {{"--gamma", "--discount"}, {"--learner", "--solver"}};

std::string current_name(const std::string &argument) {
    const std::size_t end = std::min(argument.find('='), argument.size());
    for (const auto &option : renamed) {
        if (argument.compare(0, end, option.old_name) == 0) {
            return option.name + argument.substr(end);
        }
    }
    return argument;
}

} // namespace

CLI::Validator whole(uint64_t low, uint64_t high) {
    return CLI::Validator(
        [low, high](std::string &text) {
            char *end = nullptr;
            errno = 0;
            const bool digits = text.find_first_not_of("0123456789") == std::string::npos;
            const unsigned long long value = std::strtoull(text.c_str(), &end, 10);
            if (!text.empty() && digits && errno == 0 && value >= low && value <= high) {
                return std::string();
            }
            return "'" + text + "' is not a whole number from " + std::to_string(low) + " to " +
                   std::to_string(high);
        },
        "");
}

CLI::Validator number(float low, float high, Interval interval) {
    return CLI::Validator(
        [low, high, interval](std::string &text) {
            char *end = nullptr;
            const float value = std::strtof(text.c_str(), &end);
            const bool decimal = text.find_first_not_of("0123456789+-.eE") == std::string::npos;
            const bool whole_text = decimal && end != text.c_str() && *end == '\0';
            const bool above = interval == Interval::open_low ? value > low : value >= low;
            const bool below = interval == Interval::open_high ? value < high : value <= high;
            if (whole_text && above && below) {
                return std::string();
            }
            std::ostringstream message;
            message << "'" << text << "' is not a number in "
                    << (interval == Interval::open_low ? "(" : "[") << low << ", " << high
                    << (interval == Interval::open_high ? ")" : "]");
            return message.str();
        },
        "");
}

CLI::Validator file_name() {
    return CLI::Validator(
        [](std::string &text) {
            return text.empty() ? std::string("the file name is empty") : std::string();
        },
        "");
}

CLI::Validator one_of(const std::vector<std::string> &names) {
    return CLI::Validator(
        [names](std::string &text) {
            if (std::find(names.begin(), names.end(), text) != names.end()) {
                return std::string();
            }
            return "'" + text + "' is not one of " + CLI::detail::join(names, ", ");
        },
        "");
}

void add_whole(CLI::App &app, const std::string &name, uint32_t &into, uint64_t low, uint64_t high,
               const char *text) {
    app.add_option(name, into, text)->type_name("N")->check(whole(low, high));
}

void add_file(CLI::App &app, const std::string &name, std::string &into, const char *text) {
    app.add_option(name, into, text)->type_name("FILE")->check(file_name());
}

void add_output(CLI::App &app, const std::string &name, std::string &into, const char *text) {
    const auto names_a_file = [](std::string &given) {
        return given == "-" ? std::string("'-' is no file name") : std::string();
    };
    app.add_option(name, into, text)
        ->type_name("FILE")
        ->check(file_name())
        ->check(CLI::Validator(names_a_file, ""));
}

void add_named(CLI::App &app, const std::string &name, const std::vector<Named> &all, uint8_t &into,
               const char *text) {
    std::vector<std::string> names;
    for (const Named &one : all) {
        names.emplace_back(one.name);
    }
    into = all.front().number;
    const auto take = [&all, &into](const std::string &given) {
        const auto is = [&given](const Named &one) { return given == one.name; };
        into = std::find_if(all.begin(), all.end(), is)->number;
    };
    app.add_option_function<std::string>(name, take, text)->type_name("NAME")->check(one_of(names));
}

const char *name_of(const std::vector<Named> &all, uint8_t number) {
    const auto is = [number](const Named &one) { return one.number == number; };
    return std::find_if(all.begin(), all.end(), is)->name;
}

void check_files_differ(const std::vector<NamedFile> &files) {
    for (auto file = files.begin(); file != files.end(); ++file) {
        for (auto other = files.begin(); other != file; ++other) {
            if (!file->file.empty() && file->file == other->file) {
                throw Failure(file->option + ": '" + file->file + "' is also the file of " +
                              other->option);
            }
        }
    }
}

bool parse(CLI::App &app, int argc, char **argv) {
    app.set_version_flag("--version", std::string("run_gridworld ") + rlvc_version(),
                         "Print the version and exit");
    try {
        std::vector<std::string> arguments;
        for (int i = argc - 1; i > 0; i--) { // the last one first, as CLI11 takes them
            arguments.push_back(current_name(argv[i]));
        }
        app.parse(std::move(arguments));
    } catch (const CLI::Success &asked) {
        std::ostringstream answer;
        app.exit(asked, answer, answer);
        Screen().print(answer.str());
        return false;
    } catch (const CLI::ExtrasError &) {
        throw Failure(app.remaining(true).front() + ": unknown option; see --help");
    } catch (const CLI::ArgumentMismatch &error) { // "--name: ...", or "flag was given ..."
        const std::string what = error.what();
        const std::string name = what.substr(0, what.find_first_of(": "));
        const bool values = what.compare(name.size(), 1, ":") == 0;
        throw Failure(values ? name + ": takes one value, once" : "--" + name + ": takes no value");
    } catch (const CLI::ParseError &error) {
        throw Failure(error.what());
    }
    return true;
}
