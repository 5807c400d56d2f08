#pragma once

#include <string_view>

namespace graze {

/// What a field of a table holds.
enum class FieldKind {
    number,
    missing, ///< nothing, or what instruments write where there was no reading or one beyond their range
    text,
};

/// Numbers of a table, all of which have the same decimal sign: a point or a comma.
class NumberReader {
public:
    /// @param decimal '.' or ',', or 0: the first number that has one tells
    explicit NumberReader(char decimal = 0) : decimal_(decimal) {}

    /// A whole field without the blanks around it. A comma is a decimal one only in fields that others than commas
    /// separate. @param value unchanged unless it is a number
    FieldKind read(std::string_view field, bool may_have_comma, double& value);
    /// The beginning of a text that is a number with a decimal point, whatever the language of the system. What is too
    /// small for a double is nought. @return behind it; null: none is there, or it is too large
    static const char* read_beginning(const char* at, const char* end, double& value);
    char decimal() const { return decimal_; }

private:
    char decimal_;
};

/// Codes of instruments, as "NaN", "inf", "---", and 9.9E37 and 9.91E37 of SCPI, are `missing`.
bool is_word_of_missing(std::string_view field);

} // namespace graze
