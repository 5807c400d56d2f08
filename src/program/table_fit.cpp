#include "program/table_fit.hpp"

#include "graze/base/printable.hpp"
#include "program/table.hpp"
#include "program/wrapped_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>
#include <utility>

namespace graze {

namespace {

/// Columns that are left out first if a table is too wide, the least important one first.
constexpr std::array<std::string_view, 28> least_important{
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

/// The column that is left out next; the number of columns if all must stay.
std::size_t next_to_go(const Table& table, const std::vector<std::size_t>& shown, const std::vector<bool>& kept) {
    const auto goes = [&](std::size_t column) { return column > 0 && !kept[column]; };
    for (const std::string_view name : least_important)
        for (const std::size_t column : shown)
            if (goes(column) && table.columns()[column].name == name)
                return column;
    for (const std::size_t column : shown) // final states, of which there may be many
        if (goes(column) && table.columns()[column].name.starts_with("end_"))
            return column;
    for (auto column = shown.rbegin(); column != shown.rend(); ++column)
        if (goes(*column))
            return *column;
    return table.columns().size();
}

constexpr std::size_t longest_signature = 40; ///< letters

/// Shortens long texts in columns `signature`. @return true if there were any
bool shorten_signatures(Table& table) {
    const std::size_t columns = table.columns().size();
    Table result(table.columns());
    bool any = false;
    for (std::size_t row = 0; row < table.rows(); ++row)
        for (std::size_t column = 0; column < columns; ++column) {
            if (!table.is_text(row, column)) {
                result.add(table.number(row, column));
                continue;
            }
            const std::string& text = table.text(row, column);
            const bool longer = table.columns()[column].name == "signature" && width_of(text) > longest_signature;
            result.add(longer ? shortened_words(text, longest_signature) : text);
            any = any || longer;
        }
    table = std::move(result);
    return any;
}

} // namespace

std::string shortened_words(const std::string& text, std::size_t most) {
    std::istringstream stream(text);
    std::vector<std::pair<std::string, std::size_t>> runs;
    std::size_t count = 0;
    for (std::string word; stream >> word; ++count)
        if (!runs.empty() && runs.back().first == word)
            ++runs.back().second;
        else
            runs.emplace_back(word, 1);
    constexpr std::size_t few = 3;
    std::string result;
    const std::string ending = fmt::format(" ... ({} words)", count);
    for (std::size_t r = 0; r < runs.size(); ++r) {
        std::string part =
            runs[r].second > few ? fmt::format("{} ({} times)", runs[r].first, runs[r].second) : runs[r].first;
        for (std::size_t i = 1; runs[r].second <= few && i < runs[r].second; ++i)
            part += " " + runs[r].first;
        const std::size_t available = most - (r + 1 < runs.size() ? ending.size() : 0);
        if (!result.empty() && width_of(result) + 1 + width_of(part) > available)
            return result + ending;
        result += (result.empty() ? "" : " ") + part;
    }
    return width_of(result) <= most ? result : shortened(result, most);
}

FittedTable fitted(const Table& given, int digits, std::size_t width, const std::vector<std::string>& kept) {
    Table table = given;
    FittedTable result;
    result.shortened = shorten_signatures(table);
    std::vector<std::size_t> widths = column_widths(table, digits);
    const std::size_t columns = table.columns().size();
    if (columns > 0 && table.rows() > 0 &&
        table.is_text(0, columns - 1)) // texts in the last column can be broken into lines
        widths.back() = std::min(widths.back(), least_text);
    std::vector<bool> stays(columns);
    std::vector<std::size_t> shown;
    std::size_t needed = 0;
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
