#pragma once

#include <filesystem>
#include <string>

namespace graze {

/// A folder of this process alone, for files that others send or are sent. It is removed with all that is in it.
class ScratchFolder {
public:
    /// @throws FileError when it cannot be made
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    /// Path of a file in it.
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }

private:
    std::filesystem::path path_;
};

/// @throws FileError when a file cannot be written, or read
void write_bytes(const std::string& path, const std::string& bytes);
std::string bytes_in(const std::string& path);

} // namespace graze
