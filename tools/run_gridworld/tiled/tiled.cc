// SPDX-License-Identifier: MIT
//     options    the command line                 pictures   the objects in the cells
//     scenery    what is behind and before them
//     gallery    their percepts, by the vision module
//     learner    one run                          report     what is shown and written
#include "tiled.h"

#include "../cli/failure.h"
#include "../cli/interrupt.h"
#include "../cli/output_file.h"
#include "../cli/screen.h"
#include "../maze/maze_file.h"
#include "../report/picture.h"
#include "report.h"

#include <opencv2/core.hpp>

#include <cstring>
#include <functional>

namespace {

constexpr char small_text[] = "....\n.#..\n...*\n";
constexpr std::size_t small_cells = 12;

// The maze "small", "sutton" or of a file.
class TiledMaze {
  public:
    explicit TiledMaze(const std::string &name)
        : file_(name == "small" || name == "sutton" ? std::string() : name) {
        if (name == "small") {
            gridworld_parse(&small_, small_text, std::strlen(small_text), cells_, small_cells,
                            nullptr);
        }
    }

    const gridworld_maze &get() const {
        return small_.cells ? small_ : file_.get();
    }

  private:
    Maze file_;
    gridworld_maze small_{};
    unsigned char cells_[small_cells];
};

void show_one(const gridworld_maze &maze, const Gallery &gallery, const TiledRun &run,
              Screen &screen) {
    screen.print("\n" + draw_pictures(maze, run.policy, locale_has_utf8()) + "\n");
    screen.print(describe_classes(maze, gallery, run) + "\n");
    screen.print(describe_tests(gallery, run));
}

// A row for each run; after Ctrl-C the runs that were finished.
std::vector<TiledRun> learn_all(const TiledOptions &options, const gridworld_maze &maze,
                                const Optimum &optimum, Gallery &gallery, Screen &screen,
                                const std::function<void(const std::string &)> &show) {
    std::vector<TiledRun> runs;
    screen.print(runs_table_header());
    for (uint32_t i = 0; i < options.runs; i++) {
        try {
            runs.push_back(learn_tiled(options, maze, optimum, gallery, options.seed + i, show));
        } catch (const Interrupted &) {
            if (runs.empty()) {
                throw;
            }
            break;
        }
        screen.print(runs_table_row(runs.back()));
    }
    screen.print(runs_table_end(runs));
    return runs;
}

void learn_and_show(const TiledOptions &options) {
    const TiledMaze maze(options.maze);
    OutputFile json("--json", options.json);
    OutputFile dot("--dot", options.dot);
    OutputFile snapshot("--snapshot", options.snapshot);
    const Optimum optimum(maze.get(), double{options.discount}, 0.0);
    Screen screen;
    const auto show = [&](const std::string &line) {
        if (screen.terminal()) {
            screen.refresh(line);
        }
    };
    Gallery gallery(options, find_objects(options, maze.get().free_cells), show);
    screen.print("Maze of " + std::to_string(maze.get().free_cells) + " free cells, " +
                 std::to_string(gallery.objects().size()) + " objects, " +
                 rlvc_descriptor_name(options.descriptor) + " vectors\n");
    const std::vector<TiledRun> runs =
        learn_all(options, maze.get(), optimum, gallery, screen, show);
    if (runs.size() == 1) {
        show_one(maze.get(), gallery, runs.front(), screen);
    }
    dot.write(make_dot(gallery, runs.front()));
    snapshot.write(runs.front().snapshot);
    json.write(make_tiled_report(options, maze.get(), gallery, runs));
    need_all_runs(runs.size(), options.runs);
}

} // namespace

void run_tiled(int argc, char **argv) {
    TiledOptions options;
    if (!read_tiled_options(argc, argv, options)) {
        return;
    }
    cv::setNumThreads(1);
    try {
        learn_and_show(options);
    } catch (const cv::Exception &error) {
        throw Failure(std::string("OpenCV: ") + error.what());
    }
}
