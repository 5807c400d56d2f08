#pragma once

#include "graze/base/text_file.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Reads the lines of a text file of any length, in bounded memory.
class TextLines {
public:
    /// @throws InputError when the file cannot be opened, or is UTF-16
    explicit TextLines(const std::string& path);
    /// Reads the next line, without its end and without the byte order mark of UTF-8. @return false after the last
    /// @throws InputError for lines of more than a MiB
    bool next(std::string_view& line);
    /// Number of the line that `next` has returned, from 1 on.
    int number() const { return number_; }
    /// Whether that line has a line end. The last one of a file that was cut off has none.
    bool is_ended() const { return ended_; }
    const std::string& path() const { return path_; }

private:
    void give_up() const;

    std::string path_;
    PlainFile file_;
    std::vector<char> buffer_;
    std::size_t begin_ = 0, end_ = 0; ///< unread part of the buffer
    bool at_end_ = false;             ///< the end of the file was reached
    bool ended_ = true;
    int number_ = 0;
};

} // namespace graze
