#pragma once

#include <string_view>

namespace graze {

/// Kind of a table field.
enum class FieldKind {
    number,
    missing, ///< empty, or a code of instruments for a missing or overrange reading
    text,
};

/// Reads numbers of a table, which must all have the same decimal sign: a point or a comma.
class NumberReader {
public:
    /// @param decimal '.' or ','; 0: the first number with a decimal sign decides
    explicit NumberReader(char decimal = 0) : decimal_(decimal) {}

    /// Reads a field, which must have no blanks around it. A decimal comma is allowed only if commas do not separate
    /// fields. @param value unchanged unless it is a number
    FieldKind read(std::string_view field, bool may_have_comma, double& value);
    /// Reads a number with a decimal point at the beginning of a text, independent of the locale. Underflow gives 0.
    /// @return pointer after it; null if there is none, or it overflows
    static const char* read_beginning(const char* at, const char* end, double& value);
    char decimal() const { return decimal_; }

private:
    char decimal_;
};

/// Whether a field is a word for a missing value, such as "NaN", "inf" or "---".
bool is_word_of_missing(std::string_view field);

} // namespace graze
