#pragma once

#include "graze/base/input_error.hpp"

#include <cstddef>
#include <string>
#include <string_view>

namespace graze {

/// A text and the place where it begins, for errors that point at one of its characters.
struct Source {
    std::string_view text;
    Place begin;

    /// Returns the place of a byte. Columns count characters, not bytes; an unknown line or column counts from 1.
    Place at(std::size_t offset) const;
    [[noreturn]] void fail(std::size_t offset, const std::string& problem, const std::string& remedy) const;
};

/// Returns the remedy for a name directly after a number: it may be meant as a factor, or as a unit (not supported).
std::string remedy_behind_number(std::string_view number, std::string_view word);

struct Token {
    enum class Kind {
        number,
        name,
        plus,
        minus,
        times,
        divide,
        power,
        open,
        close,
        comma,
        less,
        less_equal,
        greater,
        greater_equal,
        conjunction, ///< the word `and`
        end,
    };
    Kind kind = Kind::end;
    std::size_t offset = 0;
    std::string_view text;
    double value = 0; ///< of a number

    bool is_comparison() const { return kind >= Kind::less && kind <= Kind::greater_equal; }
};

bool is_name_start(char character);
bool is_name_character(char character);

/// Returns a part of the user's text in quotes, shortened if long.
std::string quoted(std::string_view text);

/// Splits a text into tokens, one at a time.
class Lexer {
public:
    explicit Lexer(const Source& source) : source_(source) {}

    /// Returns the next token; after the last one always `end`. @throws InputError
    Token next();

private:
    Token number();
    Token symbol();
    [[noreturn]] void refuse_character() const;
    char character(std::size_t ahead = 0) const {
        return offset_ + ahead < source_.text.size() ? source_.text[offset_ + ahead] : '\0';
    }
    Token take(Token::Kind kind, std::size_t length);

    const Source& source_;
    std::size_t offset_ = 0;
};

} // namespace graze
