#include "record/instrument_table.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/physical_unit.hpp"
#include "graze/base/printable.hpp"
#include "graze/base/trimmed.hpp"
#include "record/column_names.hpp"
#include "record/text_number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace graze {

namespace {

using Fields = std::vector<std::string_view>;

std::string_view field_at(const Fields& fields, std::size_t index) {
    return index < fields.size() ? trimmed(fields[index]) : std::string_view();
}

std::optional<double> number_of(std::string_view text, char decimal) {
    double value = 0;
    NumberReader reader(decimal);
    if (reader.read(trimmed(text), decimal == ',', value) != FieldKind::number)
        return std::nullopt;
    return value;
}

constexpr std::string_view end_of_heading = "***End_of_Header***";
constexpr int most_lines_of_heading = 1000;

/// Lines of a LabVIEW heading: values by key.
using LabviewHeading = std::map<std::string, std::vector<std::string>, std::less<>>;

LabviewHeading labview_heading(TextLines& lines, char separator) {
    LabviewHeading heading;
    std::string_view line;
    for (int i = 0; i < most_lines_of_heading; ++i) {
        if (!lines.next(line))
            break;
        if (trimmed(line, " \t,").starts_with(end_of_heading))
            return heading;
        const char used = separator != 0 ? separator : line.find('\t') != std::string_view::npos ? '\t' : ',';
        const Fields fields = row_fields(line, used);
        std::vector<std::string>& values = heading[std::string(field_at(fields, 0))];
        values.clear();
        for (std::size_t k = 1; k < fields.size(); ++k)
            values.emplace_back(trimmed(fields[k]));
    }
    throw InputError(Place{lines.path(), lines.number(), 1},
                     fmt::format("the heading of LabVIEW has no end ({})", end_of_heading),
                     "give the whole file, or pass over lines (skip) and say what the columns are");
}

std::string first_of(const LabviewHeading& heading, std::string_view key) {
    const auto found = heading.find(key);
    return found == heading.end() || found->second.empty() ? std::string() : found->second.front();
}

[[noreturn]] void fail_common(const TextLines& lines, const char* key) {
    throw InputError(Place{lines.path(), lines.number(), 1},
                     fmt::format("the channels have no common {}, and rows have no time", key),
                     "write the file with one column of times (X_Columns One)");
}

/// X0 or Delta_X, which must be equal for all channels.
double common_number(const TextLines& lines, const LabviewHeading& heading, const char* key, std::size_t channels,
                     char decimal) {
    const auto found = heading.find(key);
    std::optional<double> common;
    for (std::size_t c = 0; found != heading.end() && c < channels && c < found->second.size(); ++c) {
        const std::optional<double> one = number_of(found->second[c], decimal);
        if (!one || (common && *common != *one))
            fail_common(lines, key);
        common = one;
    }
    if (!common)
        fail_common(lines, key);
    return *common;
}

/// Unit of X0 and Delta_X, or of a column of times: X_Unit_Label if present.
std::string unit_of_times(const TextLines& lines, const LabviewHeading& heading, std::size_t channels) {
    constexpr const char* key = "X_Unit_Label";
    std::string unit = first_of(heading, "X_Dimension") == "Time" ? "s" : "";
    const auto found = heading.find(key);
    for (std::size_t c = 0; found != heading.end() && c < channels && c < found->second.size(); ++c) {
        if (found->second[c] != found->second.front())
            fail_common(lines, key);
        if (const std::string word = unit_of_time_word(found->second[c]); !word.empty())
            unit = word;
    }
    return unit;
}

constexpr std::size_t tektronix_columns = 3; // columns before the time

/// Parses a time such as "-5.0e-04s" or "3ms". @return seconds, which are assumed without a unit; nothing if there is
/// no number
std::optional<double> seconds_of(std::string_view text, const Place& place) {
    text = trimmed(text);
    double value = 0;
    const char* const end = text.data() + text.size();
    const char* const behind = NumberReader::read_beginning(text.data(), end, value);
    if (behind == nullptr)
        return std::nullopt;
    const std::string unit = unit_of_word(std::string_view(behind, static_cast<std::size_t>(end - behind)));
    if (unit.empty())
        return value;
    try {
        return converted(value, physical_unit(unit), physical_unit("s"));
    } catch (const InputError&) {
        throw InputError(place, fmt::format("'{}' is not a time", printable_line(shortened(text, 100))),
                         "write it in s, ms, us or ns, or pass over lines and say what the columns are");
    }
}

/// The time in a field such as "t0 =-5.0e-04s".
std::optional<double> seconds_behind_sign(std::string_view field, const Place& place) {
    const std::size_t equals = field.find('=');
    return equals == std::string_view::npos ? std::nullopt : seconds_of(field.substr(equals + 1), place);
}

/// "CH1V" is channel CH1 in V, "CH2mV" is CH2 in mV.
Channel rigol_channel(const NameField& field, const Place& place) {
    Channel channel = named_channel(field, place);
    constexpr std::string_view letters = "CH";
    const std::size_t behind = channel.name.find_first_not_of("0123456789", letters.size());
    if (channel.unit.empty() && channel.name.starts_with(letters) && behind != std::string::npos &&
        behind > letters.size() && is_unit_word(channel.name.substr(behind))) {
        channel.unit = channel.name.substr(behind);
        channel.name.resize(behind);
    }
    return channel;
}

/// Parses a line of names such as CH1V,CH2V,t0 =-5e-04s, tInc = 1e-06,
std::optional<TextTable> rigol_named_time(const KeptLine& names, const std::string& path) {
    std::vector<NameField> fields = name_fields(names.text, ',');
    const auto begins = [](const char* with) {
        return [=](const NameField& field) { return trimmed(field.text).starts_with(with); };
    };
    const auto start = std::find_if(fields.begin(), fields.end(), begins("t0")),
               step = std::find_if(fields.begin(), fields.end(), begins("tInc"));
    if (start == fields.end() || step <= start || step == fields.end())
        return std::nullopt;
    const Place place{path, names.number, 1};
    const std::optional<double> first = seconds_behind_sign(start->text, place),
                                apart = seconds_behind_sign(step->text, place);
    if (!first || !apart)
        return std::nullopt;
    TextTable table;
    fields.erase(start, fields.end());
    const bool has_time = !fields.empty() && trimmed(fields.front().text).starts_with("Time");
    table.header.time = {"t", "s"};
    if (has_time)
        table.header.time = named_channel(fields.front(), place);
    for (std::size_t k = has_time ? 1 : 0; k < fields.size(); ++k)
        table.header.channels.push_back(rigol_channel(fields[k], place));
    if (table.header.channels.empty())
        return std::nullopt;
    if (!has_time)
        table.time = {*first, *apart, false};
    return table;
}

} // namespace

bool is_labview(std::string_view line) {
    return trimmed(line, " \t,").starts_with("LabVIEW Measurement");
}

TextTable labview_table(TextLines& lines) {
    const LabviewHeading file = labview_heading(lines, 0);
    TextTable table;
    table.separator = first_of(file, "Separator") == "Comma" ? ',' : '\t';
    table.decimal = first_of(file, "Decimal_Separator") == "," ? ',' : '.';
    table.has_comment = table.starts_again = true;
    const LabviewHeading segment = labview_heading(lines, table.separator);
    std::string_view line;
    if (!lines.next(line))
        throw InputError(Place{lines.path(), 0, 0}, "the record is empty", "give a table of channels against time");
    const Place place{lines.path(), lines.number(), 1};
    const std::string kind = first_of(file, "X_Columns");
    if (kind == "Multi")
        throw InputError(place, "each channel has times of its own (X_Columns Multi)",
                         "write the file with one column of times (X_Columns One)");
    std::vector<NameField> names = name_fields(line, table.separator);
    if (names.size() > 1 && trimmed(names.back().text) == "Comment")
        names.pop_back();
    table.header = header_of(names, place);
    table.header.time.unit = unit_of_times(lines, segment, table.header.channels.size());
    if (const auto units = segment.find("Y_Unit_Label"); units != segment.end())
        for (std::size_t c = 0; c < std::min(units->second.size(), table.header.channels.size()); ++c)
            table.header.channels[c].unit = unit_of_word(units->second[c]);
    if (kind == "No") {
        const std::size_t channels = table.header.channels.size();
        table.passed_over = 1;
        table.time = {common_number(lines, segment, "X0", channels, table.decimal),
                      common_number(lines, segment, "Delta_X", channels, table.decimal), false};
    }
    return table;
}

bool is_tektronix(std::string_view line) {
    const Fields fields = row_fields(line, ',');
    return field_at(fields, 0) == "Record Length" && number_of(field_at(fields, tektronix_columns), '.') &&
           number_of(field_at(fields, tektronix_columns + 1), '.');
}

TextTable tektronix_table(TextLines& lines, const KeptLine& first) {
    TextTable table;
    table.decimal = '.';
    table.passed_over = tektronix_columns;
    table.header = {{"t", "s"}, {{"CH1", ""}}};
    table.first.push_back(first);
    constexpr std::size_t most = 100;
    std::string_view line;
    while (table.first.size() < most && lines.next(line)) {
        const Fields fields = row_fields(line, ',');
        const std::string_view key = field_at(fields, 0), value = field_at(fields, 1);
        if (trimmed(line, " ,").empty())
            continue;
        table.first.push_back({std::string(line), lines.number(), lines.is_ended()});
        if (key == "Source" && !value.empty() && is_plain_line(value))
            table.header.channels.front().name = value;
        else if (key == "Vertical Units")
            table.header.channels.front().unit = unit_of_word(value);
        else if (key == "Horizontal Units")
            table.header.time.unit = unit_of_time_word(value);
    }
    return table;
}

bool has_time_in_names(std::string_view names) {
    return names.find("t0") != std::string_view::npos && names.find("tInc") != std::string_view::npos;
}

std::optional<TextTable> rigol_table(const std::vector<KeptLine>& heading, const std::string& path) {
    if (heading.empty())
        return std::nullopt;
    if (has_time_in_names(heading.back().text))
        return rigol_named_time(heading.back(), path);
    if (heading.size() < 2)
        return std::nullopt;
    const KeptLine &names = heading[heading.size() - 2], &units = heading.back();
    std::vector<NameField> fields = name_fields(names.text, ',');
    const Fields below = row_fields(units.text, ',');
    const auto start = std::find_if(fields.begin(), fields.end(),
                                    [](const NameField& field) { return trimmed(field.text) == "Start"; });
    const auto place = static_cast<std::size_t>(start - fields.begin());
    if (place < 2 || place + 1 >= fields.size() || trimmed(fields[place + 1].text) != "Increment")
        return std::nullopt;
    const Place at{path, units.number, 1};
    const std::optional<double> first = seconds_of(field_at(below, place), at),
                                apart = seconds_of(field_at(below, place + 1), at);
    if (!first || !apart)
        return std::nullopt;
    fields.erase(start, fields.end());
    TextTable table;
    table.header = header_of(fields, Place{path, names.number, 1});
    for (std::size_t c = 0; c < table.header.channels.size(); ++c)
        table.header.channels[c].unit = unit_of_word(field_at(below, c + 1));
    table.header.time = {"t", "s"};
    table.time = {*first, *apart, true};
    return table;
}

} // namespace graze
