#pragma once

#include <string>
#include <string_view>

namespace graze {

/// Checks that a file can be written there, leaving nothing behind: call it before work that would be lost.
/// @throws InputError when it cannot
void require_writable(const std::string& path);

/// A file that appears whole under its name, or not at all: it is written under another name beside it.
class FileReplacement {
public:
    /// @throws InputError when nothing can be written there
    explicit FileReplacement(const std::string& path);
    ~FileReplacement();
    FileReplacement(const FileReplacement&) = delete;
    FileReplacement& operator=(const FileReplacement&) = delete;

    /// Where to write; keeps the ending of the file's name.
    const std::string& temporary_path() const { return temporary_; }
    /// @throws InputError when what was written cannot be given its name
    void commit();

private:
    std::string path_, target_, temporary_;
    bool direct_ = false; ///< not a regular file, such as /dev/null: there is nothing to replace
};

/// @throws InputError when it cannot be written
void write_file(const std::string& path, std::string_view contents);

} // namespace graze
