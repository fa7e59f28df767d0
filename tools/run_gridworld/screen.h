// SPDX-License-Identifier: MIT
// Standard output: lines that stay, and, on a terminal, one last line that is refreshed.
#ifndef RUN_GRIDWORLD_SCREEN_H
#define RUN_GRIDWORLD_SCREEN_H

#include <string>

class Screen {
  public:
    Screen();
    ~Screen(); // takes the refreshed line away

    // Prints text that stays. Throws Failure if nobody takes it.
    void print(const std::string &text);

    // Shows a line in place of the one before. Only for a terminal.
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
