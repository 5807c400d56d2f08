#include "program/table.hpp"

#include "graze/base/printable.hpp"
#include "program/wrapped_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

namespace graze {

namespace {

std::string padded(const std::string& text, std::size_t width, bool right) {
    const std::string blanks(width - std::min(width, width_of(text)), ' ');
    return right ? blanks + text : text + blanks;
}

/// The text of a cell on one line: a line feed in it would begin a row.
std::string shown_cell(const Table& table, std::size_t row, std::size_t column, int digits) {
    return printable_line(cell_text(table, row, column, digits));
}

/// Writes a table with aligned columns. If it is wider than `longest` characters (0: no limit), texts in the last
/// column are broken into lines.
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

} // namespace graze
