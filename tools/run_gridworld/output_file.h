// SPDX-License-Identifier: MIT
// A file that comes into being whole or not at all: the text goes to a temporary file beside it,
// which takes its name at the end. What is no regular file (a pipe, /dev/stdout) is written to
// directly.
#ifndef RUN_GRIDWORLD_OUTPUT_FILE_H
#define RUN_GRIDWORLD_OUTPUT_FILE_H

#include <string>

class OutputFile {
  public:
    // Opens for writing, before the work that the text comes from. An empty name asks for no file.
    // Throws Failure; `option` is named in its message.
    OutputFile(const std::string &option, const std::string &name);
    ~OutputFile();
    OutputFile(const OutputFile &) = delete;
    OutputFile &operator=(const OutputFile &) = delete;

    // Writes the whole text and gives the file its name. Throws Failure.
    void write(const std::string &text);

  private:
    [[noreturn]] void fail(int error) const;

    std::string option_, name_;
    std::string final_;     // name_ with links resolved
    std::string temporary_; // empty if there is none (any more)
    int file_ = -1;
};

#endif
