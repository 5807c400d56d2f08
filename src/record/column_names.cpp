#include "record/column_names.hpp"

#include "base/character.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/physical_unit.hpp"
#include "graze/base/printable.hpp"
#include "graze/base/trimmed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

namespace graze {

namespace {

constexpr std::size_t most_columns = 10'000;
constexpr std::size_t longest_channel_name = 100;

std::string_view without_quotes(std::string_view text) {
    return text.size() > 1 && text.front() == '"' && text.back() == '"' ? text.substr(1, text.size() - 2) : text;
}

std::string_view without_brackets(std::string_view text) {
    const bool has =
        text.size() > 1 && ((text.front() == '(' && text.back() == ')') || (text.front() == '[' && text.back() == ']'));
    return has ? trimmed(text.substr(1, text.size() - 2)) : text;
}

Place column_of(const Place& line, std::size_t begin) {
    return {line.file, line.line, line.line > 0 ? static_cast<int>(begin) + 1 : 0};
}

void require_utf8(const NameField& field, const Place& line) {
    for (std::size_t at = 0; at < field.text.size();) {
        const Character character = character_at(field.text, at);
        if (!character.valid)
            throw InputError(column_of(line, field.begin + at),
                             fmt::format("'{}' is not text in UTF-8: another encoding was used, such as Latin-1",
                                         printable_line(shortened(field.text, 100))),
                             "save the file as UTF-8, as by iconv -f latin1 -t utf-8, or write us and ohm for the "
                             "Greek letters");
        at += character.bytes;
    }
}

/// Tracks brackets and quotes along a line of names; within them nothing separates columns.
class NameNesting {
public:
    /// A quote that is never closed counts as a letter.
    explicit NameNesting(std::string_view line) : has_quotes_(std::count(line.begin(), line.end(), '"') % 2 == 0) {}
    /// @return whether the letter, the next one of the line, may separate columns
    bool is_outside(char letter) {
        depth_ += letter == '[' || letter == '(' ? 1 : letter == ']' || letter == ')' ? -1 : 0;
        in_quotes_ = in_quotes_ != (has_quotes_ && letter == '"');
        return depth_ <= 0 && !in_quotes_;
    }

private:
    bool has_quotes_, in_quotes_ = false;
    int depth_ = 0;
};

/// Splits "t / s", "CH1 in V" and, in quotes, "Time, s", if the last part is a unit.
void split_unit_behind(std::string_view& text, std::string& unit) {
    for (const std::string_view between : {" / ", " in ", ", "}) {
        const std::size_t at = text.rfind(between);
        if (at == std::string_view::npos || at == 0 || !is_unit_word(text.substr(at + between.size())))
            continue;
        unit = unit_of_word(text.substr(at + between.size()));
        text = trimmed(text.substr(0, at));
        return;
    }
}

/// Units as instruments write them in a line of units.
constexpr std::array<std::string_view, 40> symbols{
    "s",  "ms", "us",  "ns",   "\xc2\xb5s", "\xce\xbcs", "ps", "min", "h",   "V",   "mV",   "uV", "kV", "Vpp",
    "A",  "mA", "uA",  "nA",   "W",         "mW",        "Hz", "kHz", "MHz", "ohm", "kohm", "m",  "mm", "um",
    "nm", "cm", "m/s", "mm/s", "m/s^2",     "g",         "N",  "mN",  "rad", "deg", "Pa",   "%",
};

} // namespace

char separator_of_names(std::string_view line) {
    line = trimmed(line);
    for (const char separator : {';', ',', '\t', ' '}) {
        NameNesting nesting(line);
        for (const char letter : line)
            if (nesting.is_outside(letter) && letter == separator)
                return separator == '\t' ? ' ' : separator;
    }
    return ',';
}

std::vector<NameField> name_fields(std::string_view line, char separator) {
    std::vector<NameField> fields;
    std::size_t begin = 0;
    NameNesting nesting(line);
    for (std::size_t i = 0; i <= line.size(); ++i) {
        if (i < line.size()) {
            const char letter = line[i];
            const bool ends = separator == ' ' ? is_blank(letter) : letter == separator;
            if (!nesting.is_outside(letter) || !ends)
                continue;
        }
        const NameField field{line.substr(begin, i - begin), begin};
        begin = i + 1;
        const std::string_view text = trimmed(field.text);
        if (separator == ' ' && text.empty())
            continue;
        if (separator == ' ' && !fields.empty() && (text.front() == '[' || text.front() == '('))
            fields.back().text = line.substr(fields.back().begin, i - fields.back().begin);
        else
            fields.push_back(field);
    }
    while (fields.size() > 1 && trimmed(fields.back().text).empty())
        fields.pop_back();
    return fields;
}

Channel named_channel(const NameField& field, const Place& line) {
    std::string_view text = without_quotes(trimmed(field.text));
    Channel channel;
    const std::size_t bracket = text.find_first_of("[(");
    if (bracket != std::string_view::npos && (text.back() == ']' || text.back() == ')')) {
        channel.unit = unit_symbol(trimmed(text.substr(bracket + 1, text.size() - bracket - 2)));
        text = trimmed(text.substr(0, bracket));
        if (text.ends_with(" /")) // "v / (m/s)"
            text = trimmed(text.substr(0, text.size() - 1));
    } else {
        split_unit_behind(text, channel.unit);
    }
    text = without_quotes(text);
    channel.name = text;
    double number = 0;
    const char* const end = text.data() + text.size();
    const bool is_number = std::from_chars(text.data(), end, number).ptr == end; // also "nan"
    require_utf8(field, line);
    if (text.empty() || is_number || text.size() > longest_channel_name || channel.unit.size() > longest_channel_name ||
        !is_plain_line(channel.name) || !is_plain_line(channel.unit))
        throw InputError(column_of(line, field.begin),
                         fmt::format("'{}' is not a name of a column", printable_line(shortened(field.text, 100))),
                         "write names with their units, as in 't [s], V [V], q [mm]'");
    return channel;
}

RecordHeader header_of(const std::vector<NameField>& fields, const Place& line) {
    if (fields.size() < 2)
        throw InputError(line, "there is only one column",
                         "give the time first and then a column for each channel, separated by commas");
    RecordHeader header;
    for (const NameField& field : fields) {
        const Channel channel = named_channel(field, line);
        const auto same = [&](const Channel& one) { return one.name == channel.name; };
        const Place at = column_of(line, field.begin);
        if (std::any_of(header.channels.begin(), header.channels.end(), same))
            throw InputError(at, fmt::format("column '{}' occurs twice", channel.name),
                             "give each column a name of its own");
        if (header.channels.size() > most_columns)
            throw InputError(at, fmt::format("there are more than {} columns", most_columns),
                             "give the time and the channels that are wanted");
        header.channels.push_back(channel);
    }
    header.time = header.channels.front();
    header.channels.erase(header.channels.begin());
    return header;
}

void require_closed_brackets(std::string_view line, const Place& place) {
    constexpr std::size_t none = std::string_view::npos;
    std::size_t square = none, round = none; // index of the open bracket
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '[' && square != none) // brackets are not nested
            break;
        if (line[i] == '[')
            square = i;
        else if (line[i] == ']')
            square = none;
        else if (line[i] == '(' && round == none)
            round = i;
        else if (line[i] == ')')
            round = none;
    }
    if ((square == none && round == none) || !is_plain_line(std::string(line)))
        return;
    throw InputError(column_of(place, std::min(square, round)), "the bracket of a unit is not closed",
                     "write names with their units, as in 't [s], V [V]'");
}

std::string unit_of_word(std::string_view word) {
    return unit_symbol(without_brackets(without_quotes(trimmed(word))));
}

bool is_unit_word(std::string_view word) {
    const std::string_view text = without_quotes(trimmed(word));
    if (text.empty() || without_brackets(text).size() < text.size())
        return !text.empty();
    return unit_symbol(text) != text || std::find(symbols.begin(), symbols.end(), text) != symbols.end();
}

std::string unit_of_time_word(std::string_view word) {
    const std::string unit = unit_of_word(word);
    return unit == "S" ? "s" : unit;
}

void require_unit_of_time(const RecordHeader& header, const std::string& path) {
    const std::optional<PhysicalUnit> unit = known_unit(header.time.unit);
    if (unit && unit->dimension == physical_unit("S").dimension)
        throw InputError(
            Place{path, 0, 0},
            fmt::format("the unit of the times, {}, is one of conductance: S is siemens", header.time.unit),
            "write times in s, ms, us, min or h, with small letters");
}

RecordHeader parse_record_header(const std::string& line, const Place& place) {
    require_closed_brackets(line, place);
    return header_of(name_fields(line, separator_of_names(line)), place);
}

} // namespace graze
