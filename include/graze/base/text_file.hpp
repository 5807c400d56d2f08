#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace graze {

/// Largest size of a model or study file, in bytes; a longer file is a mistake or an attack.
inline constexpr std::size_t longest_model = std::size_t{16} << 20;
/// Largest size of a table of numbers, in bytes.
inline constexpr std::size_t longest_table = std::size_t{256} << 20;

/// A regular file that is read from its beginning. Other kinds of files are refused: a directory has no text, reading a
/// device may never end, and reading a pipe may never begin.
class PlainFile {
public:
    /// @param what names the file in messages, as in "model file"
    /// @throws InputError when the file cannot be opened or is not a regular file
    PlainFile(const std::string& path, std::string_view what);
    ~PlainFile();
    PlainFile(const PlainFile&) = delete;
    PlainFile& operator=(const PlainFile&) = delete;
    /// Reads the next bytes into `to`, at most `room`. @return the number of bytes read; 0 at the end of the file
    /// @throws InputError when reading fails
    std::size_t read(char* to, std::size_t room);

private:
    [[noreturn]] void fail(int reason) const;
    std::string path_, what_;
    int file_ = -1;
};

/// Returns the contents of a regular file.
/// @param what names the file in messages, as in "model file"; @param most the largest size, in bytes
/// @throws InputError when the file cannot be read, is not a regular file, or is longer than `most`
std::string read_text_file(const std::string& path, std::string_view what, std::size_t most);

} // namespace graze
