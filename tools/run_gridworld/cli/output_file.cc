// SPDX-License-Identifier: MIT
#include "output_file.h"

#include "failure.h"
#include "interrupt.h"

#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace {

// The target of a link: the new file must replace that, not the link.
std::string resolved(const std::string &name) {
    char path[PATH_MAX];
    return realpath(name.c_str(), path) ? path : name;
}

// The permissions of a new file.
mode_t default_mode() {
    const mode_t mask = umask(0);
    umask(mask);
    return 0666 & ~mask;
}

} // namespace

OutputFile::OutputFile(const std::string &option, const std::string &name)
    : option_(option), name_(name), final_(resolved(name)) {
    if (name.empty()) {
        return;
    }
    struct stat there;
    const bool exists = stat(name.c_str(), &there) == 0;
    if (exists && !S_ISREG(there.st_mode)) {
        const InterruptibleWait waits;
        file_ = open(name.c_str(), O_WRONLY | O_CLOEXEC);
        InterruptibleWait::check();
    } else if (exists && access(name.c_str(), W_OK) != 0) {
        fail(errno);
    } else {
        temporary_ = final_ + ".XXXXXX";
        file_ = mkostemp(temporary_.data(), O_CLOEXEC);
        if (file_ >= 0) { // where a file system has no permissions there are none to keep
            static_cast<void>(fchmod(file_, exists ? there.st_mode & 07777 : default_mode()));
        }
    }
    if (file_ < 0) {
        fail(errno);
    }
}

OutputFile::~OutputFile() {
    if (file_ >= 0) {
        close(file_);
    }
    if (!temporary_.empty()) {
        unlink(temporary_.c_str());
    }
}

void OutputFile::fail(int error) const {
    throw Failure(option_ + ": cannot write '" + name_ + "': " + std::strerror(error));
}

void OutputFile::write(const std::string &text) {
    if (name_.empty()) {
        return;
    }
    std::size_t written = 0;
    while (written < text.size()) {
        const ssize_t n = ::write(file_, text.data() + written, text.size() - written);
        if (n < 0 && errno != EINTR) {
            fail(errno);
        }
        written += n > 0 ? static_cast<std::size_t>(n) : 0;
    }
    const int file = file_;
    file_ = -1;
    if (close(file) != 0) {
        fail(errno);
    }
    if (!temporary_.empty()) {
        if (rename(temporary_.c_str(), final_.c_str()) != 0) {
            fail(errno);
        }
        temporary_.clear();
    }
}
