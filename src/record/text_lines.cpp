#include "record/text_lines.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <cstring>

namespace graze {

namespace {

constexpr std::size_t longest_line = std::size_t{1} << 20;
constexpr std::size_t buffer_size = std::size_t{4} << 20;

} // namespace

TextLines::TextLines(const std::string& path) : path_(path), file_(path, "record"), buffer_(buffer_size) {}

void TextLines::give_up() const {
    throw InputError(Place{path_, number_, 1}, fmt::format("this line has more than {} bytes", longest_line),
                     "a record has a line for each row of its table; is this file one?");
}

bool TextLines::next(std::string_view& line) {
    for (std::size_t searched = begin_;;) {
        const void* found = std::memchr(buffer_.data() + searched, '\n', end_ - searched);
        if (found || (at_end_ && begin_ < end_)) {
            const char* const first = buffer_.data() + begin_;
            const auto length =
                found ? static_cast<std::size_t>(static_cast<const char*>(found) - first) : end_ - begin_;
            line = {first, length};
            begin_ += length + (found ? 1 : 0);
            ended_ = found != nullptr;
            ++number_;
            if (length > longest_line)
                give_up();
            if (!line.empty() && line.back() == '\r') {
                line.remove_suffix(1);
                ended_ = true;
            }
            break;
        }
        if (at_end_)
            return false;
        if (end_ - begin_ > longest_line) {
            ++number_;
            give_up();
        }
        std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
        end_ -= begin_;
        begin_ = 0;
        searched = end_;
        const std::size_t count = file_.read(buffer_.data() + end_, buffer_.size() - end_);
        end_ += count;
        at_end_ = count == 0;
    }
    if (number_ == 1 && line.starts_with("\xef\xbb\xbf")) // mark of UTF-8
        line.remove_prefix(3);
    if (number_ == 1 && (line.starts_with("\xff\xfe") || line.starts_with("\xfe\xff"))) // marks of UTF-16
        throw InputError(Place{path_, 1, 1}, "this text is in UTF-16", "save it as UTF-8");
    return true;
}

} // namespace graze
