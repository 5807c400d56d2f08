#include "program/json_rows.hpp"

namespace graze {

std::vector<JsonObject> json_rows(const Table& table) {
    std::vector<JsonObject> rows;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        JsonObject& object = rows.emplace_back();
        for (std::size_t column = 0; column < table.columns().size(); ++column)
            if (table.is_text(row, column))
                object.add(table.columns()[column].name, table.text(row, column));
            else if (!table.is_missing(row, column))
                object.add(table.columns()[column].name, table.number(row, column));
    }
    return rows;
}

} // namespace graze
