#include "graze/symbolic/text_file.hpp"

#include "graze/symbolic/input_error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace graze {

namespace {

/// Closed with its scope.
class OpenFile {
public:
    // Without waiting: opening a pipe otherwise lasts until somebody writes to it.
    explicit OpenFile(const std::string& path)
        : file_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY)) {}
    ~OpenFile() {
        if (file_ >= 0)
            ::close(file_);
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    int get() const { return file_; }

private:
    int file_;
};

} // namespace

std::string read_text_file(const std::string& path, std::string_view what, std::size_t most) {
    const Place place{path, 0, 0};
    const auto fail = [&](int reason) {
        throw InputError(place, fmt::format("the {} cannot be read ({})", what, std::strerror(reason)),
                         reason == ENOENT ? "check the path" : "check the path and the permissions");
    };
    if (path.find('\0') != std::string::npos)
        fail(EINVAL);
    const OpenFile file(path);
    struct stat status {};
    if (file.get() < 0 || fstat(file.get(), &status) != 0)
        fail(errno);
    if (!S_ISREG(status.st_mode))
        throw InputError(place,
                         fmt::format("this is a {}, not a {}",
                                     S_ISDIR(status.st_mode)    ? "directory"
                                     : S_ISFIFO(status.st_mode) ? "pipe"
                                                                : "device",
                                     what),
                         "give the name of a file, into which what comes from elsewhere can be copied");
    std::string text;
    constexpr std::size_t block = 1 << 16;
    for (;;) { // what the system says of the size is not always true
        const std::size_t size = text.size();
        text.resize(size + block);
        const ssize_t count = ::read(file.get(), &text[size], block);
        if (count < 0 && errno != EINTR)
            fail(errno);
        text.resize(size + static_cast<std::size_t>(count < 0 ? 0 : count));
        if (text.size() > most)
            throw InputError(place, fmt::format("there are more than {} bytes in this {}", most, what),
                             fmt::format("give the name of a {}", what));
        if (count == 0)
            return text;
    }
}

} // namespace graze
