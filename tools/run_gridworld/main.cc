// SPDX-License-Identifier: MIT
// run_gridworld: learns a maze from rewards alone, by the public interface of the library.
//
//     cli/      options, output files, the screen, Ctrl-C
//     maze/     the maze and its optimum; an agent and a run; the policy and its minimal tree
//     report/   what is shown and written
//     binary    the subcommand for the Binary Gridworld
//     tiled/    the subcommand for the Tiled Gridworld, with its pictures
//
// A file includes headers of its own folder and of the folders before it. Exit status: 0; 2 after a
// failure, with one line on stderr; 128 + n after signal n.
#include "binary.h"
#include "cli/failure.h"
#include "cli/interrupt.h"
#include "cli/screen.h"
#include "tiled/tiled.h"

#include "rlvc/rlvc.h"

#include <csignal>
#include <cstdio>
#include <new>

namespace {

constexpr int exit_failure = 2;
constexpr int exit_signal = 128;

constexpr char help[] = R"(Learns a maze from rewards alone and prints the classes and the policy.
Usage: run_gridworld SUBCOMMAND [OPTIONS]

Subcommands:
  binary      a cell is seen as a string of bits (the Binary Gridworld, section 6.1)
  tiled       a cell is seen as pictures of an object (the Tiled Gridworld, section 6.2)

Options:
  -h,--help   Print this help message and exit; after a subcommand, its options
  --version   Print the version and exit
)";

void run(int argc, char **argv) {
    const std::string command = argc > 1 ? argv[1] : "";
    if (command == "binary") {
        run_binary(argc - 1, argv + 1);
    } else if (command == "tiled") {
        run_tiled(argc - 1, argv + 1);
    } else if (command == "--help" || command == "-h") {
        Screen().print(help);
    } else if (command == "--version") {
        Screen().print(std::string("run_gridworld ") + rlvc_version() + "\n");
    } else if (command.empty()) {
        throw Failure("no subcommand: use 'binary' or 'tiled' (see --help)");
    } else {
        throw Failure(command + ": unknown subcommand: use 'binary' or 'tiled' (see --help)");
    }
}

int complain(const std::string &message) {
    std::fprintf(stderr, "run_gridworld: %s\n", message.c_str());
    return exit_failure;
}

} // namespace

int main(int argc, char **argv) {
    watch_for_interrupts();
    try {
        run(argc, argv);
        return 0;
    } catch (const Interrupted &interrupted) {
        complain(std::string("interrupted after ") + interrupted.what());
        return exit_signal + interrupt_signal();
    } catch (const ReaderGone &) {
        return exit_signal + SIGPIPE;
    } catch (const Failure &failure) {
        return complain(failure.what());
    } catch (const std::bad_alloc &) {
        return complain("out of memory");
    }
}
