#pragma once

#include "graze/base/text_file.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Lines of a text file of any length, one after the other, in bounded memory.
class TextLines {
public:
    /// @throws InputError when it cannot be opened, or is text of two bytes a letter
    explicit TextLines(const std::string& path);
    /// The next line without its end, and without the mark of UTF-8 before the first one. @return false behind the last
    /// @throws InputError for lines of more than a MiB
    bool next(std::string_view& line);
    /// Of the line that `next` has given, from 1 on.
    int number() const { return number_; }
    /// Whether that one ends as a line does. The last one of a file that was cut off does not.
    bool is_ended() const { return ended_; }
    const std::string& path() const { return path_; }

private:
    void give_up() const;

    std::string path_;
    PlainFile file_;
    std::vector<char> buffer_;
    std::size_t begin_ = 0, end_ = 0; ///< of what is in the buffer and has not been read
    bool at_end_ = false;             ///< of the file
    bool ended_ = true;
    int number_ = 0;
};

} // namespace graze
