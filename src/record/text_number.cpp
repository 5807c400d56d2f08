#include "record/text_number.hpp"

#include "base/letter_case.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

namespace graze {

namespace {

/// Codes of IEEE 488.2 and SCPI-99, section 7.2.1, for infinity and "not a number".
bool is_code_of_missing(double value) {
    constexpr double infinity = 9.9e37, none = 9.91e37;
    return std::abs(value) == infinity || std::abs(value) == none;
}

} // namespace

bool is_word_of_missing(std::string_view field) {
    if (field.size() > 2 && field.front() == '"' && field.back() == '"')
        field = field.substr(1, field.size() - 2);
    if (!field.empty() && field.find_first_not_of('-') == std::string_view::npos)
        return true;
    if (!field.empty() && field.find_first_not_of('*') == std::string_view::npos)
        return true;
    const bool is_signed = !field.empty() && (field.front() == '+' || field.front() == '-');
    const std::string small = in_small_letters(is_signed ? field.substr(1) : field);
    constexpr std::array words{"",         "nan",    "na",      "n/a",    "#n/a",     "null", "none", "inf",
                               "infinity", "1.#inf", "1.#qnan", "1.#ind", "overload", "ovld", "ol",   "\xe2\x88\x9e"};
    return std::find(words.begin(), words.end(), small) != words.end();
}

const char* NumberReader::read_beginning(const char* at, const char* end, double& value) {
    if (at != end && *at == '+')
        ++at;
    double read = 0;
    const auto [next, error] = std::from_chars(at, end, read);
    if (error == std::errc::result_out_of_range) {
        const std::string_view text(at, static_cast<std::size_t>(next - at));
        const std::size_t exponent = text.find_first_of("eE");
        if (exponent == std::string_view::npos || exponent + 1 >= text.size() || text[exponent + 1] != '-')
            return nullptr;
        value = 0;
        return next;
    }
    if (error != std::errc() || !std::isfinite(read))
        return nullptr;
    value = read;
    return next;
}

FieldKind NumberReader::read(std::string_view field, bool may_have_comma, double& value) {
    if (field.empty()) // its pointer may be null, so it cannot be parsed
        return FieldKind::missing;
    const bool has_comma = may_have_comma && field.find(',') != std::string_view::npos;
    const bool has_point = field.find('.') != std::string_view::npos;
    constexpr std::size_t longest = 400;
    if (has_comma && (has_point || field.size() > longest))
        return FieldKind::text;
    std::string with_point(has_comma ? field : std::string_view());
    std::replace(with_point.begin(), with_point.end(), ',', '.'); // a second comma ends the number
    const char *const begin = has_comma ? with_point.data() : field.data(), *const end = begin + field.size();
    double read = 0;
    if (read_beginning(begin, end, read) != end)
        return !has_comma && is_word_of_missing(field) ? FieldKind::missing : FieldKind::text;
    const char sign = has_comma ? ',' : has_point ? '.' : decimal_;
    if (decimal_ != 0 && sign != decimal_)
        return FieldKind::text;
    decimal_ = sign;
    if (is_code_of_missing(read))
        return FieldKind::missing;
    value = read;
    return FieldKind::number;
}

} // namespace graze
