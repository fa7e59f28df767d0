// SPDX-License-Identifier: MIT
#include "arguments.h"

#include "failure.h"

#include "rlvc/rlvc.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <sstream>

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

CLI::Validator number(float low, float high, Ends ends) {
    return CLI::Validator(
        [low, high, ends](std::string &text) {
            char *end = nullptr;
            const float value = std::strtof(text.c_str(), &end);
            const bool whole_text = end != text.c_str() && *end == '\0';
            const bool above = ends == Ends::open_below ? value > low : value >= low;
            const bool below = ends == Ends::open_above ? value < high : value <= high;
            if (whole_text && above && below) {
                return std::string();
            }
            std::ostringstream message;
            message << "'" << text << "' is not a number in "
                    << (ends == Ends::open_below ? "(" : "[") << low << ", " << high
                    << (ends == Ends::open_above ? ")" : "]");
            return message.str();
        },
        "");
}

CLI::Validator file_name() {
    return CLI::Validator(
        [](std::string &text) {
            return text.empty() ? std::string("a file's name is wanted, and this is empty")
                                : std::string();
        },
        "");
}

CLI::Validator one_of(const std::vector<std::string> &names) {
    return CLI::Validator(
        [names](std::string &text) {
            if (std::find(names.begin(), names.end(), text) != names.end()) {
                return std::string();
            }
            return "'" + text + "' is none of " + CLI::detail::join(names, ", ");
        },
        "");
}

void add_criterion(CLI::App &app, uint8_t &criterion) {
    criterion = RLVC_CRITERION_RESIDUAL;
    app.add_option_function<std::string>(
           "--criterion",
           [&criterion](const std::string &name) {
               criterion = name == "returns" ? RLVC_CRITERION_RETURNS : RLVC_CRITERION_RESIDUAL;
           },
           "which classes are aliased: returns, as published, or residual (default)")
        ->type_name("NAME")
        ->check(one_of({"returns", "residual"}));
}

void check_files_differ(const std::vector<NamedFile> &files) {
    for (auto file = files.begin(); file != files.end(); ++file) {
        for (auto other = files.begin(); other != file; ++other) {
            if (!file->file.empty() && file->file == other->file) {
                throw Failure(file->option + ": '" + file->file + "' is the file of " +
                              other->option + " too");
            }
        }
    }
}

bool parse(CLI::App &app, int argc, char **argv) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success &asked) {
        app.exit(asked);
        return false;
    } catch (const CLI::RequiredError &) {
        throw;
    } catch (const CLI::ExtrasError &) {
        throw Failure(app.remaining(true).front() + ": not expected; --help names what is");
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
