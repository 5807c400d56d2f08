#include "python/tables.hpp"

#include "base/special_numbers.hpp"
#include "graze/results/query_interruption.hpp"
#include "python/attended.hpp"

#include <cstdint>
#include <optional>
#include <variant>

namespace graze::python {

namespace {

/// The cells of one column that is read without knowing its type. It is made of whole numbers until another cell comes,
/// then of numbers, and finally of anything.
class ColumnCells {
public:
    void add(std::int64_t number) {
        if (auto* whole = std::get_if<Whole>(&cells_))
            whole->push_back(number);
        else
            add(static_cast<double>(number));
    }
    void add(double number) {
        if (auto* whole = std::get_if<Whole>(&cells_))
            cells_ = Reals(whole->begin(), whole->end());
        if (auto* reals = std::get_if<Reals>(&cells_))
            reals->push_back(number);
        else
            std::get<Mixed>(cells_).push_back({number, {}});
    }
    void add(std::string text) { mixed().push_back({not_a_number, std::move(text)}); }

    /// An empty column becomes one of numbers that need not be whole.
    void of_numbers() { cells_ = Reals(); }

    /// With the interpreter's lock.
    py::object object() && {
        if (auto* whole = std::get_if<Whole>(&cells_))
            return array_of(std::move(*whole));
        if (auto* reals = std::get_if<Reals>(&cells_))
            return array_of(std::move(*reals));
        py::list list;
        for (const Cell& cell : std::get<Mixed>(cells_))
            if (cell.text)
                list.append(py::str(*cell.text));
            else if (cell.number == cell.number)
                list.append(cell.number);
            else
                list.append(py::none());
        return list;
    }

private:
    struct Cell {
        double number = not_a_number;
        std::optional<std::string> text;
    };
    using Whole = std::vector<std::int64_t>;
    using Reals = std::vector<double>;
    using Mixed = std::vector<Cell>;

    Mixed& mixed() {
        if (auto* mixed = std::get_if<Mixed>(&cells_))
            return *mixed;
        Mixed all;
        if (auto* whole = std::get_if<Whole>(&cells_))
            for (const std::int64_t number : *whole)
                all.push_back({static_cast<double>(number), {}});
        else
            for (const double number : std::get<Reals>(cells_))
                all.push_back({number, {}});
        return cells_.emplace<Mixed>(std::move(all));
    }

    std::variant<Whole, Reals, Mixed> cells_;
};

py::tuple made_columns(const std::vector<std::string>& names, std::vector<ColumnCells>& columns,
                       const std::vector<std::string>& units) {
    py::list arrays;
    for (ColumnCells& column : columns)
        arrays.append(std::move(column).object());
    return py::make_tuple(names, arrays, units);
}

} // namespace

py::tuple columns_of(const Table& table) {
    std::vector<std::string> names, units;
    std::vector<ColumnCells> columns(table.columns().size());
    for (std::size_t c = 0; c < columns.size(); ++c) {
        names.push_back(table.columns()[c].name);
        units.push_back(table.columns()[c].unit);
        columns[c].of_numbers();
        for (std::size_t r = 0; r < table.rows(); ++r)
            if (table.is_text(r, c))
                columns[c].add(table.text(r, c));
            else
                columns[c].add(table.is_missing(r, c) ? not_a_number : table.number(r, c));
    }
    return made_columns(names, columns, units);
}

py::tuple columns_of(ResultFile::Rows rows, const std::vector<std::string>& units) {
    std::vector<std::string> names;
    std::vector<ColumnCells> columns(rows.columns());
    attended([&](const MustStop& must_stop) {
        const QueryInterruption stoppable(must_stop);
        for (std::size_t c = 0; c < columns.size(); ++c)
            names.push_back(rows.column_name(c));
        while (rows.next())
            for (std::size_t c = 0; c < columns.size(); ++c)
                if (rows.is_null(c))
                    columns[c].add(not_a_number);
                else if (rows.is_text(c))
                    columns[c].add(rows.text(c));
                else if (rows.is_integer(c))
                    columns[c].add(rows.integer(c));
                else
                    columns[c].add(rows.number(c));
    });
    return made_columns(names, columns, units);
}

} // namespace graze::python
