#pragma once

#include "graze/results/result_file.hpp"
#include "results/database.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

// Tables are lists of columns, and each column says here, in one place, how it is called, what its cells are, in which
// unit, and how they are written from a record and read into one. Schema, writer, reader, views, exports and pictures
// follow from these lists.

/// In which unit a column's numbers are.
enum class ColumnUnit {
    none,
    time,
    per_time,
    followed, ///< of what a run varies first
    own,      ///< of the parameter, state or value that the column belongs to
};

/// Of which of a run's own things there is a column each.
enum class ColumnGroup {
    single, ///< of none: every run has this one column
    coordinates,
    states,
    values,
};

/// What is known of a column without a run.
struct ColumnKind {
    const char* name; ///< of a group what its names begin with
    ColumnType type = ColumnType::real;
    ColumnUnit unit = ColumnUnit::none;
    bool in_views = false; ///< of all runs
    ColumnGroup group = ColumnGroup::single;
    const char* former = ""; ///< its name in older files; empty: the same
    bool may_lack = false;   ///< in older files: what reads it takes nothing for an absent value
};

/// A column that was not always there.
constexpr ColumnKind added(ColumnKind kind, const char* former = "") {
    kind.may_lack = true;
    kind.former = former;
    return kind;
}

/// Binds the cells of a row from left to right.
class CellWriter {
public:
    explicit CellWriter(Statement& row, int first = 1) : row_(&row), at_(first) {}

    void real(double value) { row_->bind(at_++, value); }              ///< nothing unless finite
    void extended(double value) { row_->bind_extended(at_++, value); } ///< may be infinite
    void whole(std::size_t value) { row_->bind(at_++, value); }
    void truth(bool value) { row_->bind(at_++, std::int64_t{value}); }
    void text(std::string_view value) { row_->bind_copy(at_++, value); }
    void nothing() { row_->bind_null(at_++); }
    /// Nothing instead of an empty text.
    void word(std::string_view value) { value.empty() ? nothing() : text(value); }

private:
    Statement* row_;
    int at_;
};

/// Reads the cells of a row from left to right.
class CellReader {
public:
    explicit CellReader(const Statement& row, int first = 0) : row_(&row), at_(first) {}

    bool is_nothing() const { return row_->is_null(at_); }
    double number() { return row_->number(at_++); } ///< 0 where there is none
    double real() { return is_nothing() ? skip(), std::numeric_limits<double>::quiet_NaN() : number(); }
    std::size_t whole() { return static_cast<std::size_t>(row_->integer(at_++)); }
    bool truth() { return row_->integer(at_++) != 0; }
    std::string text() { return row_->text(at_++); }
    void skip() { ++at_; }
    void move_to(int column) { at_ = column; }

private:
    const Statement* row_;
    int at_;
};

/// A column, or a group of them, of a table whose rows are records.
/// @tparam Context what is needed besides the record
template <class Context, class Record>
struct ColumnOf {
    ColumnKind kind;
    void (*write)(const Context&, const Record&, CellWriter&);
    void (*read)(const Context&, Record&, CellReader&) = nullptr; ///< none: it follows from others
};

template <class Context, class Record>
using ColumnsOf = std::vector<ColumnOf<Context, Record>>;

/// How many columns a run's table has of a kind.
inline std::size_t width_of(const ColumnKind& kind, const RunRecord& run) {
    switch (kind.group) {
    case ColumnGroup::coordinates:
        return run.coordinates.size();
    case ColumnGroup::states:
        return run.states.size();
    case ColumnGroup::values:
        return run.values.size();
    case ColumnGroup::single:
        break;
    }
    return 1;
}

template <class Context, class Record>
std::vector<ColumnKind> kinds_of(const ColumnsOf<Context, Record>& columns) {
    std::vector<ColumnKind> kinds;
    for (const auto& column : columns)
        kinds.push_back(column.kind);
    return kinds;
}

/// @param first position of the first column's parameter in the statement
template <class Context, class Record>
void write_row(Statement& statement, const ColumnsOf<Context, Record>& columns, const Context& context,
               const Record& record, int first = 1) {
    CellWriter cells(statement, first);
    for (const auto& column : columns)
        column.write(context, record, cells);
    statement.run();
}

/// @param first place of the first column in the row
template <class Context, class Record>
void read_row(const Statement& row, const ColumnsOf<Context, Record>& columns, const Context& context, Record& record,
              const RunRecord& run, int first = 0) {
    CellReader cells(row, first);
    for (const auto& column : columns) {
        if (column.read)
            column.read(context, record, cells);
        first += static_cast<int>(width_of(column.kind, run));
        cells.move_to(first);
    }
}

} // namespace graze
