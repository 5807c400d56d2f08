#include "results/run_query.hpp"

#include "base/letter_case.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace graze {

namespace {

bool has_column(const std::vector<RunColumn>& columns, const std::string& name) {
    return std::any_of(columns.begin(), columns.end(), [&](const RunColumn& column) {
        return column.kind.group == ColumnGroup::single && column.column == name;
    });
}

bool has_column(const std::vector<ResultColumn>& columns, const std::string& name) {
    return std::ranges::find(columns, name, &ResultColumn::name) != columns.end();
}

[[noreturn]] void refuse_expression(const std::string& text, std::string_view reason) {
    throw InputError(fmt::format("'{}' {}", printable_line(shortened(text, 200)), reason),
                     "give a name of the run, or one expression in such names");
}

/// The end of what begins with a quotation mark or a bracket of SQL at this place: a text or a name.
std::size_t end_of_quoted(const std::string& text, std::size_t begin) {
    const char mark = text[begin] == '[' ? ']' : text[begin];
    const std::size_t end = text.find(mark, begin + 1);
    if (end == std::string::npos)
        refuse_expression(text, "ends within a quoted text");
    return end;
}

/// Reads one expression of SQL that has a value for each row of a run, and refuses others: those that would end the
/// place of an expression within a statement, so that other rows were read, and those that make one row of all.
class RowExpression {
public:
    explicit RowExpression(const std::string& text) : text_(text) {}

    void require() {
        if (text_.find_first_not_of(" \t\r\n") == std::string::npos)
            refuse_expression(text_, "is no expression");
        for (std::size_t i = 0; i < text_.size(); ++i)
            i = read(i);
        if (!open_.empty())
            refuse_expression(text_, "has brackets that do not match");
    }

private:
    struct Bracket {
        std::string function; ///< in front of it, if any
        bool selects = false; ///< it has a query of its own, which may make one row of many
        bool has_comma = false;
    };

    static bool is_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '$'; }

    /// @return the last place of what begins here
    std::size_t read(std::size_t i) {
        const char c = text_[i];
        const std::string_view two = std::string_view(text_).substr(i, 2);
        if (std::string_view("'\"`[").find(c) != std::string_view::npos)
            i = end_of_quoted(text_, i);
        else if (c == ';' || c == '\0' || two == "--" || two == "/*" || (c == ',' && open_.empty()))
            refuse_expression(text_, "is more than one expression");
        else if (std::string_view("?:@$").find(c) != std::string_view::npos)
            refuse_expression(text_, "has a value that is not given");
        else if (is_letter(c))
            return read_word(i);
        else if (c == '(')
            open_.push_back({word_, !open_.empty() && open_.back().selects});
        else if (c == ')')
            close(i);
        else if (c == ',')
            open_.back().has_comma = true;
        if (std::isspace(static_cast<unsigned char>(c)) == 0)
            word_.clear();
        return i;
    }

    std::size_t read_word(std::size_t begin) {
        std::size_t end = begin;
        while (end < text_.size() && is_letter(text_[end]))
            ++end;
        word_ = in_small_letters(text_.substr(begin, end - begin));
        if (!open_.empty() && (word_ == "select" || word_ == "values"))
            open_.back().selects = true;
        return end - 1;
    }

    void close(std::size_t i) {
        if (open_.empty())
            refuse_expression(text_, "has brackets that do not match");
        const Bracket one = std::move(open_.back());
        open_.pop_back();
        constexpr std::string_view aggregates[] = {
            "avg", "count", "group_concat", "json_group_array", "json_group_object", "sum", "string_agg", "total"};
        const bool is_extreme = one.function == "min" || one.function == "max";
        const bool makes_one =
            std::ranges::find(aggregates, one.function) != std::end(aggregates) || (is_extreme && !one.has_comma);
        const std::size_t next = std::min(text_.find_first_not_of(" \t\r\n", i + 1), text_.size());
        const bool of_window = in_small_letters(text_.substr(next, 4)) == "over"; // of which each row has a value
        if (makes_one && !one.selects && !of_window)
            refuse_expression(text_, "makes one value of all points");
    }

    const std::string& text_;
    std::vector<Bracket> open_;
    std::string word_; ///< just before this place, but for blanks
};

} // namespace

std::string RunQuery::column(const std::string& name, bool with_samples) const {
    return (with_samples && has_column(tables_.sample_columns, name) ? "s." : "p.") + quoted_name(name);
}

std::string RunQuery::column_of(const std::vector<ResultColumn>& columns, ColumnGroup group,
                                const std::string& name) const {
    const auto found = std::ranges::find(columns, name, &ResultColumn::name);
    return quoted_name(
        found == columns.end() ? name : tables_.names_of(group)[static_cast<std::size_t>(found - columns.begin())]);
}

std::string RunQuery::value(const std::string& name) const {
    return (run_->is_branch() ? "p." : "s.") + column_of(run_->values, ColumnGroup::values, name);
}

std::string RunQuery::quantity(const std::string& name) const {
    if (has_column(run_->coordinates, name))
        return "p." + column_of(run_->coordinates, ColumnGroup::coordinates, name);
    if (has_column(run_->values, name))
        return value(name);
    if (run_->is_branch() && name == "multiplier")
        return fmt::format("(SELECT sqrt(m.real * m.real + m.imaginary * m.imaginary) FROM multipliers AS m WHERE "
                           "m.run = {} AND m.point = p.number AND m.position = 0)",
                           text_literal(run_->name));
    if (has_column(tables_.point_columns, name))
        return "p." + quoted_name(name);
    RowExpression(name).require();
    return fmt::format("({})", name);
}

std::string RunQuery::tables(bool with_samples, bool all) const {
    const std::string points = tables_.points + " AS p";
    if (!with_samples)
        return points;
    if (run_->is_branch())
        return fmt::format("{} JOIN {} AS s ON s.point = p.number", points, tables_.samples);
    return fmt::format("{0} {1} JOIN {2} AS s ON s.rowid >= p.number * {3} AND s.rowid < (p.number + 1) * {3}", points,
                       all ? "LEFT" : "CROSS", tables_.samples, RunTables::samples_of_a_point);
}

std::string RunQuery::condition(const std::vector<std::string>& directions,
                                const std::vector<std::string>& samplings) const {
    std::string text = "1";
    if (!directions.empty())
        text += fmt::format(" AND {} IN ({})", direction(), text_literals(directions));
    // The plus sign keeps SQLite from making an index of samplings, with which it would compare each point with all
    // samples.
    if (!samplings.empty())
        text += fmt::format(" AND +s.sampling IN ({})", text_literals(samplings));
    return text;
}

std::string RunQuery::order(bool with_samples) const {
    return !with_samples ? "p.number" : run_->is_branch() ? "p.number, s.segment" : "p.number, s.rowid";
}

std::optional<std::size_t> nearest_number(const ResultFile& file, const RunRecord& run,
                                          const std::vector<std::pair<std::string, double>>& at,
                                          const std::vector<std::string>& directions) {
    const RunQuery query(run);
    std::string order;
    std::vector<double> values;
    for (const auto& [name, value] : at) {
        values.push_back(value);
        order += fmt::format("abs({} - ?{}), ", query.quantity(name), values.size());
    }
    auto rows = file.query(fmt::format("SELECT p.number FROM {} WHERE {} ORDER BY {}p.number {} LIMIT 1",
                                       query.tables(false, false), query.condition(directions, {}), order,
                                       at.empty() ? "DESC" : "ASC"),
                           values);
    if (!rows.next())
        return std::nullopt;
    return static_cast<std::size_t>(rows.integer(0));
}

std::string unit_of(ColumnUnit unit, const StoredRun& run) {
    const std::string& time = run.model.time_unit;
    switch (unit) {
    case ColumnUnit::time:
        return time;
    case ColumnUnit::per_time:
        return time.empty() ? "" : "1/" + time;
    case ColumnUnit::followed:
        return run.record.coordinates.empty() ? "" : run.record.coordinates.front().unit;
    case ColumnUnit::none:
    case ColumnUnit::own:
        break;
    }
    return "";
}

std::string unit_of(const RunColumn& column, const StoredRun& run) {
    return column.kind.unit == ColumnUnit::own ? column.own_unit : unit_of(column.kind.unit, run);
}

} // namespace graze
