#include "program/table_fit.hpp"

#include "program/table.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace graze {

namespace {

/// Columns of results that people look at last, the least of them first.
constexpr std::array<std::string_view, 28> last_looked_at{
    "begun",          "durations",    "low",           "high",       "tangent", "iterations",  "step",
    "chain",          "returns",      "cycles",        "arclength",  "error",   "residual",    "outcome",
    "bracket_low",    "bracket_high", "event_segment", "event_time", "event",   "at_end",      "unstable",
    "lyapunov_error", "mode",         "version",       "time",       "ending",  "ending_time", "located"};

bool is_empty(const Table& table, std::size_t column) {
    for (std::size_t row = 0; row < table.rows(); ++row)
        if (table.is_text(row, column) ? !table.text(row, column).empty() : !table.is_missing(row, column))
            return false;
    return table.rows() > 0;
}

/// Which of the columns goes next; none: all stay.
std::size_t next_to_go(const Table& table, const std::vector<std::size_t>& shown, const std::vector<bool>& kept) {
    const auto goes = [&](std::size_t column) { return column > 0 && !kept[column]; };
    for (const std::string_view name : last_looked_at)
        for (const std::size_t column : shown)
            if (goes(column) && table.columns()[column].name == name)
                return column;
    for (const std::size_t column : shown) // states at the end, of which there may be many
        if (goes(column) && table.columns()[column].name.starts_with("end_"))
            return column;
    for (auto column = shown.rbegin(); column != shown.rend(); ++column)
        if (goes(*column))
            return *column;
    return table.columns().size();
}

} // namespace

FittedTable fitted(const Table& table, int digits, std::size_t width, const std::vector<std::string>& kept) {
    std::vector<std::size_t> widths = column_widths(table, digits);
    const std::size_t columns = table.columns().size();
    if (columns > 0 && table.rows() > 0 && table.is_text(0, columns - 1)) // it can be broken
        widths.back() = std::min(widths.back(), least_text);
    std::vector<bool> stays(columns);
    std::vector<std::size_t> shown;
    std::size_t needed = 0;
    FittedTable result;
    for (std::size_t column = 0; column < columns; ++column) {
        stays[column] = std::find(kept.begin(), kept.end(), table.columns()[column].name) != kept.end();
        if (column > 0 && !stays[column] && is_empty(table, column))
            continue;
        shown.push_back(column);
        needed += widths[column] + gap;
    }
    while (needed > width + gap) {
        const std::size_t column = next_to_go(table, shown, stays);
        if (column == columns)
            break;
        std::erase(shown, column);
        needed -= widths[column] + gap;
        result.left_out.push_back(table.columns()[column].name);
    }
    std::vector<Table::Column> headings;
    for (const std::size_t column : shown)
        headings.push_back(table.columns()[column]);
    result.table = Table(headings);
    for (std::size_t row = 0; row < table.rows(); ++row)
        for (const std::size_t column : shown)
            if (table.is_text(row, column))
                result.table.add(table.text(row, column));
            else
                result.table.add(table.number(row, column));
    return result;
}

} // namespace graze
