#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace graze {

/// Whole texts of models and studies; longer ones are a mistake or an attack.
inline constexpr std::size_t longest_model = std::size_t{16} << 20;
/// Of tables of numbers.
inline constexpr std::size_t longest_table = std::size_t{256} << 20;

/// A plain file that is read from its beginning. Only plain files are read: a folder has no text, a device may never
/// end, and a pipe may never begin.
class PlainFile {
public:
    /// @param what as in "model file". @throws InputError when it cannot be opened, or is no plain file
    PlainFile(const std::string& path, std::string_view what);
    ~PlainFile();
    PlainFile(const PlainFile&) = delete;
    PlainFile& operator=(const PlainFile&) = delete;
    /// The next bytes, as many as there are, but no more than there is room for. @return how many; 0 at the end
    /// @throws InputError when they cannot be read
    std::size_t read(char* to, std::size_t room);

private:
    [[noreturn]] void fail(int reason) const;
    std::string path_, what_;
    int file_ = -1;
};

/// Reads a plain file.
/// @param what as in "model file"; @param most of its bytes
/// @throws InputError when it cannot be read, is no plain file, or is longer
std::string read_text_file(const std::string& path, std::string_view what, std::size_t most);

} // namespace graze
