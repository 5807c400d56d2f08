#include "results/write_lock.hpp"

#include "graze/base/input_error.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace graze {

WriteLock::WriteLock(const std::string& path) : path_(path + ".lock") {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file_ < 0)
        throw FileError(path, std::string("it cannot be written (") + std::strerror(errno) + ")",
                        "look at the permissions of the folder, or choose another one");
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
        ::close(file_);
        throw FileError(path, "another graze writes to this result file",
                        "wait until it has ended, or choose another folder");
    }
}

WriteLock::~WriteLock() {
    // The file is not removed: another process may have just opened it, and would then lock a file without a name.
    ::close(file_);
}

} // namespace graze
