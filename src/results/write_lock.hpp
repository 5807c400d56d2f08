#pragma once

#include <string>

namespace graze {

/// The right of one process to write a file. It ends with the object or, at the latest, with the process.
class WriteLock {
public:
    /// @throws InputError when another process has it, or the folder cannot be written
    explicit WriteLock(const std::string& path);
    ~WriteLock();
    WriteLock(const WriteLock&) = delete;
    WriteLock& operator=(const WriteLock&) = delete;

private:
    std::string path_;
    int file_ = -1;
};

} // namespace graze
