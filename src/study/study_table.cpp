#include "graze/study/study_table.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/results/stored_run.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <variant>

namespace graze {

namespace {

using Cell = std::variant<double, std::string>;

Cell cell_of(const ResultFile::Rows& rows, std::size_t column) {
    if (rows.is_text(column))
        return rows.text(column);
    return rows.is_null(column) ? not_a_number : rows.number(column);
}

/// Whether an expression has this name in it.
bool mentions(const std::string& expression, const std::string& name) {
    const auto is_of_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    for (std::size_t at = expression.find(name); at != std::string::npos; at = expression.find(name, at + 1)) {
        const std::size_t end = at + name.size();
        if ((at == 0 || !is_of_name(expression[at - 1])) && (end == expression.size() || !is_of_name(expression[end])))
            return true;
    }
    return false;
}

class TableMaker {
public:
    TableMaker(const StudyTable& asked, const ResultFile& file) : asked_(&asked) {
        for (const std::string& name : asked.runs)
            runs_.emplace_back(file, name, asked.place);
        const auto any = [&](auto holds) { return std::any_of(runs_.begin(), runs_.end(), holds); };
        branches_ = any([](const StoredRun& run) { return run.record.is_branch(); });
        if (runs_.size() > 1)
            heading_.emplace_back("run");
        if (branches_)
            heading_.emplace_back("label");
        if (any([](const StoredRun& run) { return !run.record.point_names.empty(); }))
            heading_.emplace_back("name");
    }

    Table make() {
        for (const StoredRun& run : runs_)
            add_rows(run);
        Table table(columns());
        for (std::size_t r = 0; r < rows_.size(); ++r) {
            for (const Cell& cell : rows_[r])
                if (const double* number = std::get_if<double>(&cell))
                    table.add_extended(*number);
                else
                    table.add(std::get<std::string>(cell));
            for (const StudyTable::Column& ratio : asked_->ratios)
                table.add(ratio_at(r, ratio.value));
        }
        return table;
    }

private:
    std::vector<Table::Column> columns() const {
        std::vector<Table::Column> columns;
        for (const std::string& name : heading_)
            columns.push_back({name, ""});
        for (const StudyTable::Column& column : asked_->columns)
            columns.push_back({column.name, runs_.front().unit(column.value)});
        for (const StudyTable::Column& ratio : asked_->ratios)
            columns.push_back({ratio.name, ""});
        return columns;
    }
    bool is_asked_for(const StoredRun& run, const std::string& type, const std::string& label) const {
        const std::vector<std::string>& points = asked_->points;
        if (points.empty())
            return !label.empty();
        return std::any_of(points.begin(), points.end(), [&](const std::string& point) {
            return point == type || point == label || (!label.empty() && point == run.record.point_name(label));
        });
    }
    /// Whether a column is of what was sampled, rather than of points.
    bool takes_samples(const StoredRun& run) const {
        if (run.record.is_branch())
            return false;
        const std::vector<std::string> values = run.value_names();
        return std::any_of(values.begin(), values.end(), [&](const std::string& value) {
            return std::any_of(asked_->columns.begin(), asked_->columns.end(),
                               [&](const StudyTable::Column& column) { return mentions(column.value, value); });
        });
    }
    void add_rows(const StoredRun& run) {
        const std::vector<std::string> of_branches{"type", "label"};
        Selection selection;
        selection.samples = takes_samples(run);
        if (branches_)
            selection.columns = of_branches;
        for (const StudyTable::Column& column : asked_->columns)
            selection.quantities.push_back(column.value);
        selection.directions = asked_->directions;
        selection.samplings = asked_->samplings;
        auto rows = read(run, selection);
        while (rows.next()) {
            if (branches_ && !is_asked_for(run, rows.text(0), rows.text(1)))
                continue;
            std::vector<Cell>& row = rows_.emplace_back();
            for (const std::string& name : heading_)
                row.emplace_back(name == "run"     ? run.record.name
                                 : name == "label" ? rows.text(1)
                                                   : run.record.point_name(rows.text(1)));
            for (std::size_t c = selection.columns.size(); c < rows.columns(); ++c)
                row.push_back(cell_of(rows, c));
        }
    }
    /// What is wrong with an expression is told with the place of the table.
    ResultFile::Rows read(const StoredRun& run, const Selection& selection) const {
        try {
            return run.rows(selection);
        } catch (const InputError& error) {
            throw InputError(asked_->place, "run '" + run.record.name + "': " + error.problem(), error.remedy());
        }
    }
    double number(std::size_t row, std::size_t column) const {
        const double* value = row < rows_.size() ? std::get_if<double>(&rows_[row][column]) : nullptr;
        return value && std::isfinite(*value) ? *value : not_a_number;
    }
    double ratio_at(std::size_t row, const std::string& name) const {
        std::size_t column = heading_.size();
        while (asked_->columns[column - heading_.size()].name != name)
            ++column;
        const double before = number(row + 1, column) - number(row, column);
        return before == 0 ? not_a_number : (number(row + 2, column) - number(row + 1, column)) / before;
    }

    const StudyTable* asked_;
    std::vector<StoredRun> runs_;
    bool branches_ = false;            ///< whether rows are of branches
    std::vector<std::string> heading_; ///< columns before those that are asked for
    std::vector<std::vector<Cell>> rows_;
};

} // namespace

Table make_table(const StudyTable& table, const ResultFile& file) {
    return TableMaker(table, file).make();
}

} // namespace graze
