#include "graze/base/text_file.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace graze {

PlainFile::PlainFile(const std::string& path, std::string_view what) : path_(path), what_(what) {
    if (path.find('\0') != std::string::npos)
        fail(EINVAL);
    // O_NONBLOCK: opening a pipe would otherwise wait until another process writes to it.
    file_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    struct stat status {};
    if (file_ < 0)
        fail(errno);
    if (fstat(file_, &status) != 0) {
        const int reason = errno;
        ::close(file_);
        fail(reason);
    }
    if (!S_ISREG(status.st_mode)) {
        ::close(file_);
        throw FileError(path,
                        fmt::format("this is a {}, not a {}",
                                    S_ISDIR(status.st_mode)    ? "directory"
                                    : S_ISFIFO(status.st_mode) ? "pipe"
                                                               : "device",
                                    what),
                        "give the name of a regular file; copy other sources into one first");
    }
}

PlainFile::~PlainFile() {
    ::close(file_);
}

void PlainFile::fail(int reason) const {
    throw FileError(path_, fmt::format("the {} cannot be read ({})", what_, std::strerror(reason)),
                    reason == ENOENT ? "check the path" : "check the path and the permissions");
}

std::size_t PlainFile::read(char* to, std::size_t room) {
    for (;;) {
        const ssize_t count = ::read(file_, to, room);
        if (count >= 0)
            return static_cast<std::size_t>(count);
        if (errno != EINTR)
            fail(errno);
    }
}

std::string read_text_file(const std::string& path, std::string_view what, std::size_t most) {
    PlainFile file(path, what);
    std::string text;
    constexpr std::size_t block = 1 << 16;
    for (;;) { // until the end: the size that the system reports is not always true
        const std::size_t size = text.size();
        text.resize(size + block);
        const std::size_t count = file.read(&text[size], block);
        text.resize(size + count);
        if (text.size() > most)
            throw InputError(Place{path, 0, 0}, fmt::format("there are more than {} bytes in this {}", most, what),
                             fmt::format("give the name of a {}", what));
        if (count == 0)
            return text;
    }
}

} // namespace graze
