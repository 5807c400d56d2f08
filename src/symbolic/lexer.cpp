#include "symbolic/lexer.hpp"

#include "graze/base/physical_unit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace graze {

namespace {

bool is_digit(char character) {
    return character >= '0' && character <= '9';
}

bool is_space(char character) {
    return character == ' ' || (character >= '\t' && character <= '\r'); // tab, line feed, ..., carriage return
}

bool is_continuation_byte(char character) {
    return (static_cast<unsigned char>(character) & 0xc0) == 0x80;
}

/// Returns the length of the well-formed UTF-8 character at the start of a text, 0 if there is none.
std::size_t character_length(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text.front());
    if (lead < 0x20 || lead == 0x7f)
        return 0;
    if (lead < 0x80)
        return 1;
    const std::size_t length = lead >= 0xf0 && lead <= 0xf4 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc2 ? 2 : 0;
    if (lead > 0xf4 || length == 0 || text.size() < length)
        return 0;
    return std::ranges::all_of(text.substr(1, length - 1), is_continuation_byte) ? length : 0;
}

/// Returns what to type for a character that word processors and papers use in place of an operator.
std::string_view plain_form(std::string_view character) {
    struct Form {
        std::string_view character, plain;
    };
    static constexpr Form forms[] = {
        {"\u2212", "-"},  {"\u2013", "-"},  {"\u2014", "-"},    {"\u00d7", "*"},  {"\u00b7", "*"},
        {"\u22c5", "*"},  {"\u2217", "*"},  {"\u00f7", "/"},    {"\u2215", "/"},  {"\u00b2", "^2"},
        {"\u00b3", "^3"}, {"\u03c0", "pi"}, {"\u221a", "sqrt"}, {"\u2264", "<="}, {"\u2265", ">="},
        {"[", "("},       {"]", ")"},       {"{", "("},         {"}", ")"},       {"\u00a0", " "},
    };
    const auto* found = std::ranges::find(forms, character, &Form::character);
    return found == std::end(forms) ? std::string_view() : found->plain;
}

} // namespace

std::string remedy_behind_number(std::string_view number, std::string_view word) {
    if (known_unit(word))
        return fmt::format("write {} alone, in the unit that is meant there, or {}*{} for a product", number, number,
                           word);
    return fmt::format("write {}*{} for a product", number, word);
}

Place Source::at(std::size_t offset) const {
    Place place{begin.file, std::max(begin.line, 1), std::max(begin.column, 1)};
    for (const char character : text.substr(0, offset)) {
        if (character == '\n') {
            ++place.line;
            place.column = 1;
        } else if (!is_continuation_byte(character)) {
            ++place.column;
        }
    }
    return place;
}

void Source::fail(std::size_t offset, const std::string& problem, const std::string& remedy) const {
    throw InputError(at(offset), problem, remedy);
}

bool is_name_start(char character) {
    return (character >= 'a' && character <= 'z') || (character >= 'A' && character <= 'Z') || character == '_';
}

bool is_name_character(char character) {
    return is_name_start(character) || is_digit(character);
}

std::string quoted(std::string_view text) {
    constexpr std::size_t longest = 40;
    return text.size() <= longest ? fmt::format("'{}'", text) : fmt::format("'{}...'", text.substr(0, longest));
}

Token Lexer::take(Token::Kind kind, std::size_t length) {
    const Token token{kind, offset_, source_.text.substr(offset_, length), 0};
    offset_ += length;
    return token;
}

Token Lexer::next() {
    while (offset_ < source_.text.size() && is_space(source_.text[offset_]))
        ++offset_;
    if (offset_ == source_.text.size())
        return take(Token::Kind::end, 0);
    if (is_digit(character()) || character() == '.')
        return number();
    if (!is_name_start(character()))
        return symbol();
    std::size_t length = 1;
    while (is_name_character(character(length)))
        ++length;
    const bool conjunction = source_.text.substr(offset_, length) == "and";
    return take(conjunction ? Token::Kind::conjunction : Token::Kind::name, length);
}

Token Lexer::number() {
    std::size_t length = 0;
    const auto digits = [&] {
        const std::size_t start = length;
        while (is_digit(character(length)))
            ++length;
        return length - start;
    };
    std::size_t mantissa_digits = digits();
    if (character(length) == '.') {
        ++length;
        mantissa_digits += digits();
    }
    bool complete = mantissa_digits > 0;
    if (complete && (character(length) == 'e' || character(length) == 'E')) {
        ++length;
        if (character(length) == '+' || character(length) == '-')
            ++length;
        complete = digits() > 0;
    }
    const std::size_t number_length = length;
    while (is_name_character(character(length)) || character(length) == '.')
        ++length;
    const std::string_view text = source_.text.substr(offset_, length);
    if (!complete || length > number_length) {
        std::string remedy = "write numbers as 12, 0.5 or 1e-3";
        if (complete && is_name_start(text[number_length]) && !text.starts_with("0x") && text.size() <= 40)
            remedy = remedy_behind_number(text.substr(0, number_length), text.substr(number_length));
        source_.fail(offset_, "malformed number " + quoted(text), remedy);
    }
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        source_.fail(offset_, "number " + quoted(text) + " is outside the range of double precision",
                     "scale the quantity, for instance by another unit");
    Token token = take(Token::Kind::number, length);
    token.value = value;
    return token;
}

Token Lexer::symbol() {
    using Kind = Token::Kind;
    constexpr std::pair<std::string_view, Kind> symbols[] = {
        {"+", Kind::plus},        {"-", Kind::minus},          {"*", Kind::times}, {"/", Kind::divide},
        {"^", Kind::power},       {"(", Kind::open},           {")", Kind::close}, {",", Kind::comma},
        {"<=", Kind::less_equal}, {">=", Kind::greater_equal}, {"<", Kind::less},  {">", Kind::greater}};
    const std::string_view rest = source_.text.substr(offset_);
    if (rest.starts_with("**"))
        source_.fail(offset_, "'**' is not an operator", "write a^b for a power");
    for (const auto& [text, kind] : symbols)
        if (rest.starts_with(text))
            return take(kind, text.size());
    refuse_character();
}

void Lexer::refuse_character() const {
    const std::string_view rest = source_.text.substr(offset_);
    if (rest.starts_with("==") || rest.starts_with("!="))
        source_.fail(
            offset_,
            fmt::format("'{}' cannot be tested: equality of real numbers is a matter of round-off", rest.substr(0, 2)),
            "write an inequality, or an event that happens where the two are equal");
    struct Refused {
        std::string_view text;
        const char *problem, *remedy;
    };
    for (const auto& [text, problem, remedy] :
         {Refused{"=", "unexpected '='", "write the right-hand side only, or a comparison with <, <=, > or >="},
          {"&&", "unexpected '&&'", "write 'and'"},
          {"||", "'||' cannot join conditions", "list the mode once more in `next`, with the other condition"},
          {"!", "'!' cannot stand in a condition", "turn the comparison round: 'a <= b' for 'not a > b'"},
          {"%", "the remainder '%' is not analytic", "declare a cyclic state, or make the jump an event"}})
        if (rest.starts_with(text))
            source_.fail(offset_, problem, remedy);
    const std::size_t length = character_length(rest);
    if (length == 0)
        source_.fail(offset_, fmt::format("unexpected byte 0x{:02x}", static_cast<unsigned char>(rest.front())),
                     "expressions are plain text");
    const std::string_view plain = plain_form(rest.substr(0, length));
    source_.fail(offset_, fmt::format("unexpected character '{}'", rest.substr(0, length)),
                 plain.empty()  ? "expressions are made of numbers, names, parentheses and + - * / ^"
                 : plain == " " ? "write an ordinary space"
                                : fmt::format("write {}", plain));
}

} // namespace graze
