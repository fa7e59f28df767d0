// SPDX-License-Identifier: MIT
// A file that is written as a whole or not at all: the text goes to a temporary file beside it,
// which is renamed at the end. A file that is not regular, such as /dev/stdout, is written
// directly.
#ifndef RUN_GRIDWORLD_CLI_OUTPUT_FILE_H
#define RUN_GRIDWORLD_CLI_OUTPUT_FILE_H

#include <string>

class OutputFile {
  public:
    // Opens the file for writing; call it before the work, so that a wrong name fails early. An
    // empty name means no file. Throws Failure, whose message names `option`, or Interrupted.
    OutputFile(const std::string &option, const std::string &name);
    ~OutputFile();
    OutputFile(const OutputFile &) = delete;
    OutputFile &operator=(const OutputFile &) = delete;

    // Writes the whole text and renames the file; does nothing if there is none. Throws Failure.
    void write(const std::string &text);

  private:
    [[noreturn]] void fail(int error) const;

    std::string option_, name_;
    std::string final_;     // name_ with links resolved
    std::string temporary_; // empty: none
    int file_ = -1;
};

#endif
