// SPDX-License-Identifier: MIT
// Standard output: lines that stay and, on a terminal, a last line that shows progress.
#ifndef RUN_GRIDWORLD_CLI_SCREEN_H
#define RUN_GRIDWORLD_CLI_SCREEN_H

#include <string>

class Screen {
  public:
    Screen();
    ~Screen(); // clears the refreshed line

    // Prints text that stays. Throws Failure or ReaderGone if it cannot be written.
    void print(const std::string &text);

    // Replaces the last line. Only for a terminal.
    void refresh(const std::string &line);

    bool terminal() const {
        return terminal_;
    }

  private:
    void clear();

    bool terminal_;
    bool refreshed_ = false;
};

#endif
