#include "model/model_file_guard.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace graze {

namespace {

constexpr int most_parts_of_a_key = 16;

bool is_ascii(char c) {
    return static_cast<unsigned char>(c) < 0x80;
}

bool is_key_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == ' ' || c == '\t';
}

/// Scans the text as far as needed to tell strings, comments and keys apart.
class Guard {
public:
    Guard(std::string_view text, const SourceText& source) : text_(text), source_(source) {}

    void run() {
        if (text_.substr(0, 3) == "\xef\xbb\xbf") // byte order mark
            at_ = 3;
        int parts = 1;
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '"' || c == '\'') {
                read_string();
                continue;
            }
            if (c == '#') {
                at_ = std::min(text_.find('\n', at_), text_.size());
                continue;
            }
            if (!is_ascii(c))
                fail("a character outside ASCII", "put texts in quotes; names and keys consist of plain letters");
            if (c == '[' && open_.empty() && begins_line()) {
                check_header();
            } else if (c == '[' || c == '{') {
                open_ += c;
            } else if (c == ']' || c == '}') {
                close(c);
            }
            if (c == '.')
                ++parts;
            else if (!is_key_character(c))
                parts = 1;
            if (parts > most_parts_of_a_key)
                fail(fmt::format("a key of more than {} parts", most_parts_of_a_key),
                     "no key of a model has more than four");
            ++at_;
        }
    }

private:
    [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
        throw InputError(source_.place(at_), problem, remedy);
    }

    bool begins_line() const {
        const std::size_t before = at_ == 0 ? std::string_view::npos : text_.find_last_not_of(" \t", at_ - 1);
        return before == std::string_view::npos ||
               std::string_view("\r\n\xbf").find(text_[before]) != std::string_view::npos;
    }

    /// Checks that the name of a table, after `[` or `[[`, begins like a key. Skips the characters before it.
    void check_header() {
        open_ += '[';
        skip_blanks();
        if (at_ + 1 < text_.size() && text_[at_ + 1] == '[') {
            ++at_;
            open_ += '[';
            skip_blanks();
        }
        if (at_ + 1 == text_.size())
            return;
        const char c = text_[at_ + 1];
        if (!is_key_character(c) && c != '"' && c != '\'' && c != ']') {
            ++at_;
            fail("a table without a name", "write its name between the brackets, as in [name] or [[name]]");
        }
    }

    void skip_blanks() { at_ = std::min(text_.find_first_not_of(" \t", at_ + 1), text_.size()) - 1; }

    void close(char bracket) {
        if (open_.empty() || open_.back() != (bracket == ']' ? '[' : '{'))
            fail(fmt::format("a '{}' that closes nothing", bracket),
                 "lists are written [1, 2], tables { a = 1, b = 2 }");
        open_.pop_back();
    }

    /// Skips the string that begins here. The parser does not recognise a string in the middle of a word.
    void read_string() {
        const std::size_t begin = at_;
        const bool in_word =
            begin > 0 && std::string_view(" \t\r\n=[{,\xbf").find(text_[begin - 1]) == std::string_view::npos;
        skip_string(text_[begin]);
        const std::string_view string = text_.substr(begin, at_ - begin);
        if (in_word && !std::all_of(string.begin(), string.end(), is_ascii)) {
            at_ = begin;
            fail("a quote in the middle of a word", "close the string before it, or leave a blank");
        }
    }

    void skip_string(char quote) {
        const std::string long_quote(3, quote);
        const bool is_long = text_.substr(at_, 3) == long_quote;
        at_ += is_long ? 3 : 1;
        while (at_ < text_.size()) {
            if (quote == '"' && text_[at_] == '\\') {
                skip_escape(is_long);
            } else if (!is_long && (text_[at_] == quote || text_[at_] == '\n')) {
                ++at_;
                return;
            } else if (is_long && text_.substr(at_, 3) == long_quote) {
                at_ += 3;
                // Up to two more quotes belong to the value.
                for (int extra = 0; extra < 2 && at_ < text_.size() && text_[at_] == quote; ++extra)
                    ++at_;
                return;
            } else {
                ++at_;
            }
        }
    }

    void skip_escape(bool is_long) {
        ++at_;
        const std::size_t next = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
        if (!is_long || (next == at_ && next < text_.size() && is_ascii(text_[next]))) {
            at_ = std::min(at_ + 1, text_.size());
            return;
        }
        at_ = next; // a backslash at the end of a line removes the white space that follows
        if (at_ < text_.size() && !is_ascii(text_[at_]))
            fail("a line that continues another one begins with a character outside ASCII",
                 "move the backslash, for the line to begin with a plain letter");
    }

    std::string_view text_;
    const SourceText& source_;
    std::size_t at_ = 0;
    std::string open_; ///< brackets not yet closed
};

} // namespace

void guard_toml(std::string_view text, const SourceText& source) {
    Guard(text, source).run();
}

} // namespace graze
