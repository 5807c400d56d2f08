#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// True for SQLite databases, such as result files.
bool is_database(const std::string& path);

/// Checks, without leaving a file, that a file can be written at a path. To be called before a long computation.
/// @throws InputError when it cannot
void require_writable(const std::string& path);

/// Makes a folder and its parent folders, unless they exist. @param option for the message
/// @throws InputError when it cannot be made
void make_folder(const std::string& folder, const std::string& option);

struct NamedFile {
    std::string name; ///< its name in messages: the option that names it, or "the model"
    std::string path; ///< empty: no file
};

/// Checks that no two paths are the same file, also through links: one output would replace the other.
/// @throws InputError when two are
void require_distinct(const std::vector<NamedFile>& files);

/// Checks that the path of a file in a folder does not lead out of the folder through a link.
/// @throws InputError when it does
void require_inside(const std::string& path, const std::string& folder);

/// A file that appears completely under its name, or not at all: it is written to a temporary file with a random name
/// beside it, which commit() renames. All files of the program, except result files and records of experiments, are
/// written by this class. It replaces no database, and no file that the running command reads (see KeptInputs).
class FileReplacement {
public:
    /// @throws InputError when no file can be written at the path
    explicit FileReplacement(const std::string& path);
    ~FileReplacement();
    FileReplacement(const FileReplacement&) = delete;
    FileReplacement& operator=(const FileReplacement&) = delete;

    /// Path of the temporary file; it has the ending of the file's name.
    const std::string& temporary_path() const { return temporary_; }
    /// Writes the contents of the file. @throws InputError when they cannot be written
    void write(std::string_view contents) const;
    /// Calls a function that writes to the temporary path. Its errors name the final path instead.
    void written_by(const std::function<void(const std::string& path)>& work) const;
    /// Gives the file its name. @throws InputError when the contents are not on the disk, or renaming fails
    void commit();

private:
    void make_temporary(const std::filesystem::path& target);

    std::string path_, target_, temporary_;
    int file_ = -1;       ///< descriptor of the temporary file; its path may later lead to another file
    bool direct_ = false; ///< the target is not a regular file, such as /dev/null: it is written directly
};

/// Writes a file by a FileReplacement. @throws InputError when it cannot be written
void write_file(const std::string& path, std::string_view contents);

} // namespace graze
