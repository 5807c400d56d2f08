#pragma once

#include "graze/results/result_file.hpp"
#include "results/database.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

// Each table of the result file is described by a list of columns. A column describes in one place its name, the type
// and unit of its cells, and how they are written from a record and read into one. Schema, writer, reader, views,
// exports and pictures all use these lists.

/// Unit of the numbers in a column.
enum class ColumnUnit {
    none,
    time,
    per_time,
    followed, ///< unit of the first coordinate of the run
    own,      ///< unit of the parameter, state or value that the column belongs to
};

/// Which columns of a run a ColumnKind describes: one that every run has, or one for each coordinate, state or value.
enum class ColumnGroup {
    single, ///< one column that every run has
    coordinates,
    states,
    values,
};

/// Description of a column, or a group of columns, that is the same for all runs.
struct ColumnKind {
    const char* name; ///< name of a single column; prefix of the names in a group
    ColumnType type = ColumnType::real;
    ColumnUnit unit = ColumnUnit::none;
    bool in_views = false; ///< whether the views over all runs have the column
    ColumnGroup group = ColumnGroup::single;
    const char* former = ""; ///< its name in older files; empty: the same
    bool may_lack = false;   ///< in older files: what reads it takes nothing for an absent value
};

/// A column that views over all runs show.
constexpr ColumnKind shown(const char* name, ColumnUnit unit = ColumnUnit::none) {
    return {name, ColumnType::real, unit, true};
}

/// A column that they do not show.
constexpr ColumnKind kept(const char* name, ColumnUnit unit = ColumnUnit::none) {
    return {name, ColumnType::real, unit};
}

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

    void real(double value) { row_->bind(at_++, value); }              ///< missing unless finite
    void extended(double value) { row_->bind_extended(at_++, value); } ///< infinite numbers are kept
    void whole(std::size_t value) { row_->bind(at_++, value); }
    void truth(bool value) { row_->bind(at_++, std::int64_t{value}); }
    void text(std::string_view value) { row_->bind_copy(at_++, value); }
    void nothing() { row_->bind_null(at_++); }
    /// An empty text becomes a missing cell.
    void word(std::string_view value) { value.empty() ? nothing() : text(value); }
    void optional(const std::optional<double>& value) { value ? real(*value) : nothing(); }
    /// An index, which begins at 1 in the file.
    void position(std::size_t index) { whole(index + 1); }
    void reals(const std::vector<double>& values) {
        for (const double value : values)
            real(value);
    }

private:
    Statement* row_;
    int at_;
};

/// Reads the cells of a row from left to right.
class CellReader {
public:
    explicit CellReader(const Statement& row, int first = 0) : row_(&row), at_(first) {}

    bool is_nothing() const { return row_->is_null(at_); }
    double number() { return row_->number(at_++); } ///< 0 if the cell is missing
    double real() { return is_nothing() ? skip(), std::numeric_limits<double>::quiet_NaN() : number(); }
    std::size_t whole() { return static_cast<std::size_t>(row_->integer(at_++)); }
    bool truth() { return row_->integer(at_++) != 0; }
    std::string text() { return row_->text(at_++); }
    std::optional<double> optional() { return is_nothing() ? skip(), std::nullopt : std::optional(number()); }
    std::size_t position() { return static_cast<std::size_t>(std::max<std::int64_t>(row_->integer(at_++), 1) - 1); }
    /// So many reals. @param values receives them
    void reals(std::vector<double>& values, std::size_t count) {
        values.resize(count);
        for (double& value : values)
            value = real();
    }
    void skip() { ++at_; }
    void move_to(int column) { at_ = column; }

private:
    const Statement* row_;
    int at_;
};

/// A column, or a group of columns, of a table whose rows are records.
/// @tparam Context further data that writing and reading a cell needs
template <class Context, class Record>
struct ColumnOf {
    ColumnKind kind;
    void (*write)(const Context&, const Record&, CellWriter&);
    void (*read)(const Context&, Record&, CellReader&) = nullptr; ///< null: derived from other cells, not read
};

template <class Context, class Record>
using ColumnsOf = std::vector<ColumnOf<Context, Record>>;

struct Always {
    bool operator()(const auto& /*record*/) const { return true; }
};

/// A column of what is a member of records. It can be a column of any context.
/// @tparam write, read functions of CellWriter and CellReader
/// @tparam Member, Holds function objects without state: where the member of a record is, and whether it has one
template <auto write, auto read, class Member, class Holds = Always>
struct MemberColumn {
    ColumnKind kind;

    template <class Context, class Record>
    operator ColumnOf<Context, Record>() const { // NOLINT(google-explicit-constructor)
        return {kind,
                [](const Context&, const Record& record, CellWriter& cell) {
                    Holds()(record) ? (cell.*write)(*Member()(record)) : cell.nothing();
                },
                [](const Context&, Record& record, CellReader& cell) { *Member()(record) = (cell.*read)(); }};
    }
};

/// Makes columns of members, of the type of their cells.
template <ColumnType type, auto write, auto read>
struct ColumnMaker {
    template <class Member>
    constexpr MemberColumn<write, read, Member> operator()(ColumnKind kind, Member /*member*/) const {
        kind.type = type;
        return {kind};
    }
};
inline constexpr ColumnMaker<ColumnType::text, &CellWriter::text, &CellReader::text> text_column;
inline constexpr ColumnMaker<ColumnType::text, &CellWriter::word, &CellReader::text> word_column;
inline constexpr ColumnMaker<ColumnType::whole, &CellWriter::whole, &CellReader::whole> whole_column;
inline constexpr ColumnMaker<ColumnType::whole, &CellWriter::truth, &CellReader::truth> truth_column;
inline constexpr ColumnMaker<ColumnType::whole, &CellWriter::position, &CellReader::position> position_column;
inline constexpr ColumnMaker<ColumnType::real, &CellWriter::real, &CellReader::number>
    number_column; ///< missing numbers are read as 0
inline constexpr ColumnMaker<ColumnType::real, &CellWriter::real, &CellReader::real> real_column; ///< and here as NaN
inline constexpr ColumnMaker<ColumnType::real, &CellWriter::extended, &CellReader::number> extended_column;
inline constexpr ColumnMaker<ColumnType::real, &CellWriter::optional, &CellReader::optional> optional_column;

/// The same column, whose cells are missing in other records.
template <class Holds, auto write, auto read, class Member>
MemberColumn<write, read, Member, Holds> only_if(Holds /*holds*/, const MemberColumn<write, read, Member>& column) {
    return {column.kind};
}

/// Number of columns that a table of a run has of this kind.
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

/// Writes a record as one row. @param first position of the parameter of the first column in the statement
template <class Context, class Record>
void write_row(Statement& statement, const ColumnsOf<Context, Record>& columns, const Context& context,
               const Record& record, int first = 1) {
    CellWriter cells(statement, first);
    for (const auto& column : columns)
        column.write(context, record, cells);
    statement.run();
}

/// Reads a record from one row. @param first index of the first column in the row
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
