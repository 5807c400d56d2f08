#include "record/text_record.hpp"

#include "graze/symbolic/input_error.hpp"
#include "graze/symbolic/printable.hpp"
#include "graze/symbolic/trimmed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <system_error>
#include <utility>

namespace graze {

namespace {

constexpr std::size_t longest_line = std::size_t{1} << 20;
constexpr std::size_t most_columns = 10'000;
constexpr std::size_t longest_channel_name = 100;
constexpr std::size_t rows_of_a_part = 16'384;
constexpr std::size_t buffer_size = std::size_t{4} << 20;

bool is_blank(char letter) {
    return letter == ' ' || letter == '\t';
}

const char* past_blanks(const char* at, const char* end) {
    while (at != end && is_blank(*at))
        ++at;
    return at;
}

/// A number, whose decimal point is a point whatever the language of the system. @return behind it; null: none is there
const char* parse_number(const char* at, const char* end, double& value) {
    if (at != end && *at == '+')
        ++at;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error == std::errc::result_out_of_range) { // too large is no number; too small is nought
        const std::string_view text(at, static_cast<std::size_t>(next - at));
        const std::size_t exponent = text.find_first_of("eE");
        if (exponent == std::string_view::npos || exponent + 1 >= text.size() || text[exponent + 1] != '-')
            return nullptr;
        value = 0;
        return next;
    }
    return error == std::errc() && std::isfinite(value) ? next : nullptr;
}

/// The first that a line has outside of brackets; blanks count only if there is no other.
char separator_of(std::string_view line) {
    line = trimmed(line);
    for (const char separator : {';', ',', '\t', ' '}) {
        int depth = 0;
        for (const char letter : line) {
            depth += letter == '[' || letter == '(' ? 1 : letter == ']' || letter == ')' ? -1 : 0;
            if (letter == separator && depth <= 0)
                return separator == '\t' ? ' ' : separator;
        }
    }
    return ',';
}

struct Field {
    std::string_view text;
    std::size_t begin = 0; ///< in the line
};

/// Fields of a header line. Units may stand behind a blank even where blanks separate.
std::vector<Field> header_fields(std::string_view line, char separator) {
    std::vector<Field> fields;
    std::size_t begin = 0;
    int depth = 0;
    for (std::size_t i = 0; i <= line.size(); ++i) {
        if (i < line.size()) {
            const char letter = line[i];
            depth += letter == '[' || letter == '(' ? 1 : letter == ']' || letter == ')' ? -1 : 0;
            const bool ends = separator == ' ' ? is_blank(letter) : letter == separator;
            if (!ends || depth > 0)
                continue;
        }
        const Field field{line.substr(begin, i - begin), begin};
        begin = i + 1;
        const std::string_view text = trimmed(field.text);
        if (separator == ' ' && text.empty())
            continue;
        if (separator == ' ' && !fields.empty() && (text.front() == '[' || text.front() == '('))
            fields.back().text = line.substr(fields.back().begin, i - fields.back().begin);
        else
            fields.push_back(field);
    }
    return fields;
}

Channel channel_of(const Field& field, const Place& line) {
    std::string_view text = trimmed(field.text);
    const Place place{line.file, line.line, line.line > 0 ? static_cast<int>(field.begin) + 1 : 0};
    Channel channel;
    const std::size_t bracket = text.find_first_of("[(");
    if (bracket != std::string_view::npos && (text.back() == ']' || text.back() == ')')) {
        channel.unit = trimmed(text.substr(bracket + 1, text.size() - bracket - 2));
        text = trimmed(text.substr(0, bracket));
    }
    if (text.size() > 1 && text.front() == '"' && text.back() == '"')
        text = text.substr(1, text.size() - 2);
    channel.name = text;
    double number = 0;
    const char* const end = text.data() + text.size();
    const bool is_number = std::from_chars(text.data(), end, number).ptr == end; // "nan" too
    if (text.empty() || is_number || text.size() > longest_channel_name || channel.unit.size() > longest_channel_name ||
        !is_plain_line(channel.name) || !is_plain_line(channel.unit))
        throw InputError(place, fmt::format("'{}' is no name of a column", printable_line(shortened(field.text, 100))),
                         "write names with their units, as in 't [s], V [V], q [mm]'");
    return channel;
}

} // namespace

/// Of a bracket that is never closed all that follows would be the unit.
void require_closed_brackets(std::string_view line, const Place& place) {
    constexpr std::size_t none = std::string_view::npos;
    std::size_t square = none, round = none; // where one was opened
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '[' && square != none) // within one there is no other
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
    throw InputError({place.file, place.line, place.line > 0 ? static_cast<int>(std::min(square, round)) + 1 : 0},
                     "the bracket of a unit is not closed", "write names with their units, as in 't [s], V [V]'");
}

/// Whether a row has a comma within a number, beside what separates columns.
bool has_decimal_commas(std::string_view line, char separator) {
    const auto is_digit = [](char letter) { return letter >= '0' && letter <= '9'; };
    bool commas = false, others = separator != ',';
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
        commas = commas || (line[i] == ',' && is_digit(line[i - 1]) && is_digit(line[i + 1]));
        others = others || (is_blank(line[i]) && is_digit(line[i - 1]) && line[i - 1] != ',');
    }
    return commas && others;
}

RecordHeader parse_record_header(const std::string& line, const Place& place) {
    require_closed_brackets(line, place);
    const std::vector<Field> fields = header_fields(line, separator_of(line));
    if (fields.size() < 2)
        throw InputError(place, "there is only one column",
                         "give the time first and then a column for each channel, separated by commas");
    RecordHeader header;
    for (const Field& field : fields) {
        const Channel channel = channel_of(field, place);
        const auto same = [&](const Channel& one) { return one.name == channel.name; };
        const Place at{place.file, place.line, place.line > 0 ? static_cast<int>(field.begin) + 1 : 0};
        if (std::any_of(header.channels.begin(), header.channels.end(), same))
            throw InputError(at, fmt::format("column '{}' is there twice", channel.name),
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

TextRecord::TextRecord(const std::string& path, const RecordLayout& layout)
    : path_(path), file_(path, "record"), buffer_(buffer_size), last_time_(-std::numeric_limits<double>::infinity()) {
    find_header(layout);
    row_.resize(header_.channels.size() + 1);
}

void TextRecord::refuse(std::string_view line, const char* at, const std::string& problem,
                        const std::string& remedy) const {
    throw InputError(Place{path_, line_, static_cast<int>(at - line.data()) + 1}, problem, remedy);
}

void TextRecord::refuse_field(std::string_view line, const char* at) const {
    const char* const end = line.data() + line.size();
    const char* last = at;
    while (last != end && (separator_ == ' ' ? !is_blank(*last) : *last != separator_))
        ++last;
    const std::string text = printable_line(shortened(trimmed({at, static_cast<std::size_t>(last - at)}), 100));
    if (text.empty())
        refuse(line, at, "a number is missing", "leave out rows of which a value is missing");
    refuse(line, at, fmt::format("'{}' is no finite number", text),
           line_ == 1 ? "give names of columns, as in 't [s], V [V]', or numbers with a decimal point"
                      : "write numbers with a decimal point, and leave out rows of which a value is missing");
}

bool TextRecord::next_raw_line(std::string_view& line) {
    for (std::size_t searched = begin_;;) {
        const void* found = std::memchr(buffer_.data() + searched, '\n', end_ - searched);
        if (found || (at_end_ && begin_ < end_)) {
            const char* const first = buffer_.data() + begin_;
            const auto length =
                found ? static_cast<std::size_t>(static_cast<const char*>(found) - first) : end_ - begin_;
            line = {first, length};
            begin_ += length + (found ? 1 : 0);
            ++line_;
            if (length > longest_line)
                break;
            if (!line.empty() && line.back() == '\r')
                line.remove_suffix(1);
            return true;
        }
        if (at_end_)
            return false;
        if (end_ - begin_ > longest_line) {
            ++line_;
            break;
        }
        std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
        end_ -= begin_;
        begin_ = 0;
        searched = end_;
        const std::size_t count = file_.read(buffer_.data() + end_, buffer_.size() - end_);
        end_ += count;
        at_end_ = count == 0;
    }
    throw InputError(Place{path_, line_, 1}, fmt::format("this line has more than {} bytes", longest_line),
                     "a record has a line for each row of its table; is this file one?");
}

bool TextRecord::next_line(std::string_view& line) {
    while (next_raw_line(line)) {
        if (line_ == 1 && line.starts_with("\xef\xbb\xbf")) // mark of UTF-8
            line.remove_prefix(3);
        const std::string_view text = trimmed(line);
        if (!text.empty() && text.front() != '#' && text.front() != '%')
            return true;
    }
    return false;
}

void TextRecord::find_header(const RecordLayout& layout) {
    std::string_view line;
    const bool has_line = next_line(line);
    if (has_line && (line.starts_with("\xff\xfe") || line.starts_with("\xfe\xff"))) // marks of UTF-16
        throw InputError(Place{path_, line_, 1}, "this is text of two bytes a letter (UTF-16)", "save it as UTF-8");
    if (!has_line)
        throw InputError(Place{path_, 0, 0}, "the record is empty", "give a table of channels against time");
    const std::string_view text = trimmed(line);
    double number = 0;
    const bool is_row = parse_number(text.data(), text.data() + text.size(), number) != nullptr;
    separator_ = separator_of(line);
    if (!is_row) {
        if (!layout.columns.empty())
            refuse(line, text.data(), "the file has a header of its own", "leave out what the columns are");
        header_ = parse_record_header(std::string(line), Place{path_, line_, 1});
        return;
    }
    if (has_decimal_commas(line, separator_))
        refuse(line, text.data(), "numbers have decimal commas", "write decimal points");
    const std::size_t columns = header_fields(line, separator_).size();
    constexpr std::size_t columns_of_dissertation = 5;
    if (!layout.columns.empty())
        header_ = parse_record_header(layout.columns, Place{"columns", 0, 0});
    else if (columns == columns_of_dissertation)
        header_ = {{"t", "s"}, {{"V", ""}, {"I", ""}, {"q", ""}, {"v", ""}}};
    else
        refuse(line, line.data(), fmt::format("nothing says what the {} columns of the record are", columns),
               "begin the file with a line such as 't [s], V [V], q [mm]', or say it by --columns");
    first_line_ = line;
    has_first_line_ = true;
}

void TextRecord::parse(std::string_view line, Samples& samples) {
    const char* at = line.data();
    const char* const end = at + line.size();
    const std::size_t columns = row_.size();
    for (std::size_t column = 0; column < columns; ++column) {
        at = past_blanks(at, end);
        if (at == end && column > 0 && (separator_ == ' ' || line.back() != separator_))
            refuse(line, end, fmt::format("the line has {} columns instead of {}", column, columns),
                   "give a number for each column; a file that ends here has been cut off");
        const char* const next = parse_number(at, end, row_[column]);
        if (!next)
            refuse_field(line, at);
        at = next;
        if (column + 1 == columns)
            break;
        const char* const behind = past_blanks(at, end);
        if (separator_ != ' ') {
            if (behind == end)
                refuse(line, end, fmt::format("the line has {} columns instead of {}", column + 1, columns),
                       "give a number for each column; a file that ends here has been cut off");
            if (*behind != separator_)
                refuse(line, behind,
                       fmt::format("'{}' stands behind a number", printable_line(std::string_view(behind, 1))),
                       fmt::format("separate columns by '{}', as in the first line, and write decimal points",
                                   separator_));
            at = behind + 1;
        } else if (behind == at && behind != end) {
            refuse(line, behind,
                   fmt::format("'{}' stands behind a number", printable_line(std::string_view(behind, 1))),
                   "separate columns by blanks, as in the first line, and write decimal points");
        }
    }
    const char* const rest = past_blanks(at, end);
    if (rest != end && separator_ == ',' && header_fields(line, separator_).size() == 2 * columns)
        refuse(line, line.data(), fmt::format("there are {} numbers instead of {}", 2 * columns, columns),
               "give one for each column; if commas are decimal ones, write decimal points");
    if (rest != end)
        refuse(line, rest, fmt::format("there is more on this line than {} columns", columns),
               "give a number for each column that the first line names");
    if (!(row_.front() > last_time_))
        refuse(line, past_blanks(line.data(), end),
               fmt::format("the time {} is not after the one before, {}", row_.front(), last_time_),
               "give each row once, in the order of time");
    last_time_ = row_.front();
    samples.times.push_back(row_.front());
    for (std::size_t column = 1; column < columns; ++column)
        samples.values[column - 1].push_back(row_[column]);
}

bool TextRecord::read(Samples& samples) {
    samples.clear(header_.channels.size());
    if (has_first_line_) {
        has_first_line_ = false;
        parse(first_line_, samples);
    }
    std::string_view line;
    while (samples.rows() < rows_of_a_part && next_line(line))
        parse(line, samples);
    return samples.rows() > 0;
}

} // namespace graze
