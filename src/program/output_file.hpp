#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Whether it is a file of SQLite's, such as result files.
bool is_database(const std::string& path);

/// Checks that a file can be written there, leaving nothing behind: call it before work that would be lost.
/// @throws InputError when it cannot
void require_writable(const std::string& path);

/// Makes a folder, with those that it is in, unless it is there. @param option that names it
/// @throws InputError when it cannot be made
void make_folder(const std::string& folder, const std::string& option);

struct NamedFile {
    std::string name; ///< the option that asks for it, or "the model"
    std::string path; ///< empty: there is none
};

/// Checks that no two of them are the same file, of which one would be lost; by whatever names and links they go.
/// @throws InputError when two are
void require_distinct(const std::vector<NamedFile>& files);

/// Checks that a file in a folder lies in it indeed: a link there may lead elsewhere.
/// @throws InputError when it does
void require_inside(const std::string& path, const std::string& folder);

/// A file that appears whole under its name, or not at all: it is written under another name beside it, which nobody
/// can foresee, and which is no link. Everything that the program writes, besides result files and records of
/// experiments, is written by way of this. It replaces no database, and nothing that the running command reads.
class FileReplacement {
public:
    /// @throws InputError when nothing can be written there
    explicit FileReplacement(const std::string& path);
    ~FileReplacement();
    FileReplacement(const FileReplacement&) = delete;
    FileReplacement& operator=(const FileReplacement&) = delete;

    /// Where to write; keeps the ending of the file's name.
    const std::string& temporary_path() const { return temporary_; }
    /// Writes all of it. @throws InputError when it cannot be written
    void write(std::string_view contents) const;
    /// Does some work that writes to the temporary path: what goes wrong with it names the file as it is to be called.
    void written_by(const std::function<void(const std::string& path)>& work) const;
    /// @throws InputError when what was written is not on the disk, or cannot be given its name
    void commit();

private:
    void make_temporary(const std::filesystem::path& target);

    std::string path_, target_, temporary_;
    int file_ = -1;       ///< the file that was made, whatever is under its name later
    bool direct_ = false; ///< not a regular file, such as /dev/null: there is nothing to replace
};

/// @throws InputError when it cannot be written
void write_file(const std::string& path, std::string_view contents);

} // namespace graze
