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

/// How wide the columns are for people, headings included.
std::vector<std::size_t> column_widths(const Table& table, int digits);

/// @param digits significant digits; 17 tell any two numbers apart
/// @param heading what a JSON object says before columns, units and rows; other formats leave it out
void write_table(std::ostream& out, const Table& table, TableFormat format, int digits, const JsonObject& heading);

} // namespace graze
