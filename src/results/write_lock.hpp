#pragma once

#include <string>

namespace graze {

/// Exclusive right of one process to write a file. Released by the destructor, or when the process ends.
class WriteLock {
public:
    /// @throws InputError if another process has the right, or the folder cannot be written
    explicit WriteLock(const std::string& path);
    ~WriteLock();
    WriteLock(const WriteLock&) = delete;
    WriteLock& operator=(const WriteLock&) = delete;

private:
    std::string path_;
    int file_ = -1;
};

} // namespace graze
