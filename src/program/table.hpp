#pragma once

#include "graze/results/table.hpp"

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

enum class TableFormat { table, csv, json };

/// Members of a JSON object, in their order.
class JsonObject {
public:
    void add(std::string_view name, std::string_view text);
    void add(std::string_view name, double number);
    void add(std::string_view name, const JsonObject& object);
    void add(std::string_view name, const std::vector<JsonObject>& objects);
    /// The members, without the braces.
    const std::string& members() const { return members_; }

private:
    void begin(std::string_view name);
    std::string members_;
};

constexpr std::size_t gap = 2;         ///< between columns for people
constexpr std::size_t least_text = 30; ///< letters of a line that a text is broken to

/// How wide the columns are for people, headings included.
std::vector<std::size_t> column_widths(const Table& table, int digits);

/// @param digits significant digits; 17 tell any two numbers apart
/// @param heading what a JSON object says before columns, units and rows; other formats leave it out
/// @param longest letters in a line for people, 0: any; texts in the last column are broken to fit
void write_table(std::ostream& out, const Table& table, TableFormat format, int digits, const JsonObject& heading,
                 std::size_t longest = 0);

/// A table as text for files: CSV with all digits.
std::string csv_text(const Table& table);

} // namespace graze
