#pragma once

#include "graze/picture/figure.hpp"
#include "graze/results/table.hpp"
#include "program/record_stages.hpp"

#include <string>
#include <vector>

namespace graze {

/// What is made of records: rows of a table, and the panels of a picture of it.
class RecordTable {
public:
    RecordTable(const RecordArguments& arguments, bool several);
    virtual ~RecordTable() = default;
    RecordTable(const RecordTable&) = delete;
    RecordTable& operator=(const RecordTable&) = delete;

    /// Reads a record to its end. @throws InputError
    virtual void add(const std::string& file, RecordStages& stages) = 0;
    const Table& table() const { return table_; }
    /// @throws InputError when there is nothing to draw
    virtual Figure figure() const = 0;

protected:
    /// Makes the table when the first record is known. @throws InputError when another one has other columns
    void begin(const std::vector<Table::Column>& columns);
    /// First cells of a row.
    void begin_row(const std::string& file);
    const RecordArguments& arguments() const { return *arguments_; }
    bool several() const { return several_; }
    Table& rows() { return table_; }

private:
    const RecordArguments* arguments_;
    bool several_, begun_ = false;
    Table table_;
};

/// The one that `--what` asks for. @throws InputError when something is missing for it
std::unique_ptr<RecordTable> record_table(const RecordArguments& arguments);

/// Those of periods: periods, sections and extremes.
std::unique_ptr<RecordTable> period_table(const RecordArguments& arguments);

/// An axis with a channel or the time.
void label_x(FigurePanel& panel, const Channel& channel);
void label_y(FigurePanel& panel, const Channel& channel);

/// Where a list of rows would become too long to be kept. @throws InputError
void require_few_rows(const Table& table);

} // namespace graze
