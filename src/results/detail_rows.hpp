#pragma once

#include "results/columns.hpp"
#include "results/schema.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace graze {

/// Writes the rows of one point in a detail table, for example of its multipliers.
template <class Context, class Record>
void write_details(Statement& statement, const ColumnsOf<Context, Record>& columns, const Context& context,
                   const RunRecord& run, std::size_t point, const std::vector<Record>& records) {
    for (std::size_t position = 0; position < records.size(); ++position) {
        statement.bind_all(run.name, point, position);
        write_row(statement, columns, context, records[position], 4);
    }
}

/// Reads rows of a detail table, one point after the other.
template <class Context, class Record>
class DetailReader {
public:
    DetailReader(const Database& database, const char* table, const ColumnsOf<Context, Record>& columns,
                 const RunRecord& run)
        : rows_(database.prepare(fmt::format("SELECT {} FROM {} WHERE run = ?1 AND point = ?2 ORDER BY position",
                                             listed(kinds_of(columns)), table))),
          columns_(&columns), run_(&run) {}

    std::vector<Record> of_point(const Context& context, std::size_t point) {
        rows_.bind(1, std::string_view(run_->name)).bind(2, point);
        std::vector<Record> records;
        while (rows_.step())
            read_row(rows_, *columns_, context, records.emplace_back(), *run_);
        rows_.reset();
        return records;
    }

private:
    Statement rows_;
    const ColumnsOf<Context, Record>* columns_;
    const RunRecord* run_;
};

} // namespace graze
