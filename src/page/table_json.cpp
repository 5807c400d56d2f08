#include "page/table_json.hpp"

#include "page/json_text.hpp"

namespace graze {

namespace {

nlohmann::json table_with(const std::string& title, nlohmann::json columns, nlohmann::json rows, bool left_out) {
    nlohmann::json one{{"title", title}, {"left_out", left_out}};
    one["columns"] = std::move(columns);
    one["rows"] = std::move(rows);
    return one;
}

nlohmann::json cell_json(const Table& table, std::size_t row, std::size_t column) {
    if (table.is_text(row, column))
        return table.text(row, column);
    return table.is_missing(row, column) ? nlohmann::json() : number_json(table.number(row, column));
}

nlohmann::json cell_json(const ResultFile::Rows& rows, std::size_t column) {
    if (rows.is_null(column))
        return {};
    if (rows.is_text(column))
        return rows.text(column);
    return rows.is_integer(column) ? nlohmann::json(rows.integer(column)) : number_json(rows.number(column));
}

} // namespace

nlohmann::json table_json(const std::string& title, const Table& table) {
    nlohmann::json columns = nlohmann::json::array(), rows = nlohmann::json::array();
    for (const Table::Column& column : table.columns())
        columns.push_back({{"name", column.name}, {"unit", column.unit}});
    for (std::size_t r = 0; r < table.rows(); ++r) {
        nlohmann::json row = nlohmann::json::array();
        for (std::size_t c = 0; c < table.columns().size(); ++c)
            row.push_back(cell_json(table, r, c));
        rows.push_back(std::move(row));
    }
    return table_with(title, std::move(columns), std::move(rows), false);
}

nlohmann::json table_json(const std::string& title, ResultFile::Rows rows, const std::vector<std::string>& units,
                          std::size_t most) {
    nlohmann::json columns = nlohmann::json::array(), found = nlohmann::json::array();
    for (std::size_t c = 0; c < rows.columns(); ++c)
        columns.push_back({{"name", rows.column_name(c)}, {"unit", c < units.size() ? units[c] : std::string()}});
    bool left_out = false;
    while (!left_out && rows.next()) {
        left_out = found.size() == most;
        nlohmann::json row = nlohmann::json::array();
        for (std::size_t c = 0; c < rows.columns() && !left_out; ++c)
            row.push_back(cell_json(rows, c));
        if (!left_out)
            found.push_back(std::move(row));
    }
    return table_with(title, std::move(columns), std::move(found), left_out);
}

} // namespace graze
