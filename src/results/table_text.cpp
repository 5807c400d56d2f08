#include "graze/results/table_text.hpp"

#include "base/json_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

namespace graze {

namespace {

std::string number_text(double value, int digits) {
    return fmt::format("{:.{}g}", value, digits);
}

std::string json_number(double value, int digits) {
    return std::isfinite(value) ? number_text(value, digits) : "null";
}

std::string csv_cell(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos)
        return text;
    std::string result = "\"";
    for (const char c : text)
        result += c == '"' ? "\"\"" : std::string(1, c);
    return result + '"';
}

} // namespace

std::string cell_text(const Table& table, std::size_t row, std::size_t column, int digits) {
    if (table.is_text(row, column))
        return table.text(row, column);
    return table.is_missing(row, column) ? "" : number_text(table.number(row, column), digits);
}

void write_csv(std::ostream& out, const Table& table, int digits) {
    const std::size_t columns = table.columns().size();
    for (std::size_t column = 0; column < columns; ++column)
        out << (column > 0 ? "," : "") << csv_cell(table.columns()[column].name);
    out << '\n';
    for (std::size_t row = 0; row < table.rows(); ++row) {
        for (std::size_t column = 0; column < columns; ++column)
            out << (column > 0 ? "," : "") << csv_cell(cell_text(table, row, column, digits));
        out << '\n';
    }
}

std::string csv_text(const Table& table) {
    std::ostringstream text;
    write_csv(text, table, 17);
    return text.str();
}

void write_json(std::ostream& out, const Table& table, int digits, const JsonObject& heading) {
    const std::size_t columns = table.columns().size();
    std::vector<std::string> names, units;
    for (const Table::Column& column : table.columns()) {
        names.push_back(json_text(column.name));
        units.push_back(json_text(column.unit));
    }
    out << '{' << heading.members() << (heading.members().empty() ? "" : ",")
        << fmt::format("\n\"columns\":[{}],\n\"units\":[{}", fmt::join(names, ","), fmt::join(units, ","));
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

void add_cell(JsonObject& object, const std::string& name, const Table& table, std::size_t row, std::size_t column) {
    if (table.is_text(row, column))
        object.add(name, table.text(row, column));
    else
        object.add(name, table.number(row, column));
}

std::vector<JsonObject> json_rows(const Table& table, MissingCells missing) {
    std::vector<JsonObject> rows;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        JsonObject& object = rows.emplace_back();
        for (std::size_t column = 0; column < table.columns().size(); ++column)
            if (missing == MissingCells::null || table.is_text(row, column) || !table.is_missing(row, column))
                add_cell(object, table.columns()[column].name, table, row, column);
    }
    return rows;
}

} // namespace graze
