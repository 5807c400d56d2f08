#include "program/table.hpp"

#include "graze/base/printable.hpp"
#include "program/wrapped_text.hpp"
#include "study/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

namespace graze {

namespace {

std::string number_text(double value, int digits) {
    return fmt::format("{:.{}g}", value, digits);
}

std::string json_number(double value, int digits) {
    return std::isfinite(value) ? number_text(value, digits) : "null";
}

std::string csv_text(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos)
        return text;
    std::string result = "\"";
    for (const char c : text)
        result += c == '"' ? "\"\"" : std::string(1, c);
    return result + '"';
}

std::string cell_text(const Table& table, std::size_t row, std::size_t column, int digits) {
    if (table.is_text(row, column))
        return table.text(row, column);
    return table.is_missing(row, column) ? "" : number_text(table.number(row, column), digits);
}

std::string padded(const std::string& text, std::size_t width, bool right) {
    const std::string blanks(width - std::min(width, width_of(text)), ' ');
    return right ? blanks + text : text + blanks;
}

void write_csv(std::ostream& out, const Table& table, int digits) {
    const std::size_t columns = table.columns().size();
    for (std::size_t column = 0; column < columns; ++column)
        out << (column > 0 ? "," : "") << csv_text(table.columns()[column].name);
    out << '\n';
    for (std::size_t row = 0; row < table.rows(); ++row) {
        for (std::size_t column = 0; column < columns; ++column)
            out << (column > 0 ? "," : "") << csv_text(cell_text(table, row, column, digits));
        out << '\n';
    }
}

void write_json(std::ostream& out, const Table& table, int digits, const JsonObject& heading) {
    const std::size_t columns = table.columns().size();
    out << '{' << heading.members() << (heading.members().empty() ? "" : ",") << "\n\"columns\":[";
    for (std::size_t column = 0; column < columns; ++column)
        out << (column > 0 ? "," : "") << json_text(table.columns()[column].name);
    out << "],\n\"units\":[";
    for (std::size_t column = 0; column < columns; ++column)
        out << (column > 0 ? "," : "") << json_text(table.columns()[column].unit);
    out << "],\n\"rows\":[";
    for (std::size_t row = 0; row < table.rows(); ++row) {
        out << (row > 0 ? ",\n[" : "\n[");
        for (std::size_t column = 0; column < columns; ++column)
            out << (column > 0 ? "," : "")
                << (table.is_text(row, column) ? json_text(table.text(row, column))
                                               : json_number(table.number(row, column), digits));
        out << ']';
    }
    out << "]}\n";
}

/// A line feed in a text would begin a row.
std::string shown_cell(const Table& table, std::size_t row, std::size_t column, int digits) {
    return printable_line(cell_text(table, row, column, digits));
}

/// @param longest line, 0: any. The last column, where it is one of texts, is broken into as many lines as it needs.
void write_aligned(std::ostream& out, const Table& table, int digits, std::size_t longest) {
    const std::size_t columns = table.columns().size();
    if (columns == 0)
        return void(out << '\n');
    const std::vector<std::size_t> widths = column_widths(table, digits);
    std::vector<bool> right(columns, true);
    bool units = false;
    for (std::size_t column = 0; column < columns; ++column) {
        units = units || !table.columns()[column].unit.empty();
        for (std::size_t row = 0; row < table.rows(); ++row)
            right[column] = right[column] && !table.is_text(row, column);
    }
    const std::size_t last = std::accumulate(widths.begin(), widths.end(), gap * columns) - widths.back() - gap;
    const bool breaks = !right.back() && last + least_text <= longest && last + widths.back() > longest;
    const auto write_line = [&](const auto& text_of) {
        std::string line;
        for (std::size_t column = 0; column < columns; ++column) {
            const std::string& text = text_of(column);
            line += (column > 0 ? std::string(gap, ' ') : "") + (breaks && column + 1 == columns
                                                                     ? wrapped(text, longest, last)
                                                                     : padded(text, widths[column], right[column]));
        }
        line.erase(line.find_last_not_of(' ') + 1);
        out << line << '\n';
    };
    write_line([&](std::size_t column) { return table.columns()[column].name; });
    if (units)
        write_line([&](std::size_t column) { return table.columns()[column].unit; });
    for (std::size_t row = 0; row < table.rows(); ++row)
        write_line([&](std::size_t column) { return shown_cell(table, row, column, digits); });
}

} // namespace

void JsonObject::begin(std::string_view name) {
    members_ += (members_.empty() ? "" : ",\n") + json_text(name) + ':';
}

void JsonObject::add(std::string_view name, std::string_view text) {
    begin(name);
    members_ += json_text(text);
}

void JsonObject::add(std::string_view name, double number) {
    begin(name);
    members_ += json_number(number, std::numeric_limits<double>::max_digits10);
}

void JsonObject::add(std::string_view name, const JsonObject& object) {
    begin(name);
    members_ += '{' + object.members_ + '}';
}

void JsonObject::add(std::string_view name, const std::vector<JsonObject>& objects) {
    begin(name);
    members_ += '[';
    for (std::size_t i = 0; i < objects.size(); ++i)
        members_ += (i > 0 ? ",\n{" : "{") + objects[i].members_ + '}';
    members_ += ']';
}

std::vector<std::size_t> column_widths(const Table& table, int digits) {
    std::vector<std::size_t> widths;
    for (std::size_t column = 0; column < table.columns().size(); ++column) {
        const Table::Column& heading = table.columns()[column];
        std::size_t& width = widths.emplace_back(std::max(width_of(heading.name), width_of(heading.unit)));
        for (std::size_t row = 0; row < table.rows(); ++row)
            width = std::max(width, width_of(shown_cell(table, row, column, digits)));
    }
    return widths;
}

void write_table(std::ostream& out, const Table& table, TableFormat format, int digits, const JsonObject& heading,
                 std::size_t longest) {
    switch (format) {
    case TableFormat::table:
        return write_aligned(out, table, digits, longest);
    case TableFormat::csv:
        return write_csv(out, table, digits);
    case TableFormat::json:
        return write_json(out, table, digits, heading);
    }
}

std::string csv_text(const Table& table) {
    std::ostringstream text;
    write_table(text, table, TableFormat::csv, 17, {});
    return text.str();
}

} // namespace graze
