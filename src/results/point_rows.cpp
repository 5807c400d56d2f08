#include "results/point_rows.hpp"

#include "graze/symbolic/input_error.hpp"
#include "results/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

Label label_named(const std::string& name) {
    for (int i = 0; i <= static_cast<int>(Label::failed); ++i)
        if (name == name_of(static_cast<Label>(i)))
            return static_cast<Label>(i);
    return Label::failed;
}

Ending ending_named(const std::string& name) {
    for (int i = 0; i <= static_cast<int>(Ending::step_limit); ++i)
        if (name == name_of(static_cast<Ending>(i)))
            return static_cast<Ending>(i);
    return Ending::running;
}

} // namespace

void throw_contradiction(const std::string& path, const std::string& what) {
    throw InputError(Place{path, 0, 0}, fmt::format("the result file contradicts itself: {}", what),
                     "it has been changed or damaged: ask for another copy, or run the study again");
}

void require_columns(const Statement& rows, std::size_t columns, const std::string& path) {
    if (static_cast<std::size_t>(rows.columns()) != columns)
        throw_contradiction(path, fmt::format("a table has {} columns instead of {}", rows.columns(), columns));
}

std::size_t index_of(const std::vector<std::string>& names, const std::string& name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

void write_multipliers(Statement& statement, const std::string& run, std::size_t point,
                       const std::vector<std::complex<double>>& multipliers) {
    for (std::size_t m = 0; m < multipliers.size(); ++m)
        statement.bind(1, std::string_view(run))
            .bind(2, point)
            .bind(3, m)
            .bind_extended(4, multipliers[m].real())
            .bind_extended(5, multipliers[m].imag())
            .run();
}

std::vector<std::complex<double>> read_multipliers(Statement& rows) {
    std::vector<std::complex<double>> multipliers;
    while (rows.step())
        multipliers.emplace_back(rows.is_null(0) ? std::numeric_limits<double>::infinity() : rows.number(0),
                                 rows.number(1));
    rows.reset();
    return multipliers;
}

void write_point(Statement& statement, const RunRecord& run, const PointRecord& point) {
    const PointResult& result = point.result;
    const std::string direction = point.direction < run.directions.size() ? run.directions[point.direction] : "";
    const std::string_view label = name_of(result.label), ending = name_of(result.outcome.ending);
    statement.bind(1, point.number).bind(2, point.chain).bind(3, std::string_view(direction));
    int at = 4;
    for (const double coordinate : point.coordinates)
        statement.bind(at++, coordinate);
    statement.bind(at++, label);
    const bool periodic = result.label == Label::periodic;
    periodic ? statement.bind(at, result.period) : statement.bind_null(at);
    periodic ? statement.bind(at + 1, result.duration) : statement.bind_null(at + 1);
    periodic ? statement.bind(at + 2, std::string_view(result.signature)) : statement.bind_null(at + 2);
    result.symmetric ? statement.bind(at + 3, std::int64_t{*result.symmetric}) : statement.bind_null(at + 3);
    result.multipliers.empty() ? statement.bind_null(at + 4)
                               : statement.bind_extended(at + 4, std::abs(result.multipliers.front()));
    result.lyapunov ? statement.bind(at + 5, *result.lyapunov) : statement.bind_null(at + 5);
    result.lyapunov_error ? statement.bind(at + 6, *result.lyapunov_error) : statement.bind_null(at + 6);
    periodic ? statement.bind(at + 7, result.residual) : statement.bind_null(at + 7);
    statement.bind(at + 8, result.cycles).bind(at + 9, result.periods_run).bind(at + 10, result.time);
    result.mode < run.modes.size() ? statement.bind(at + 11, std::string_view(run.modes[result.mode]))
                                   : statement.bind_null(at + 11);
    statement.bind(at + 12, ending).bind(at + 13, result.outcome.time);
    statement.bind(at + 14, std::string_view(result.outcome.detail));
    at += 15;
    for (const double value : result.state)
        statement.bind(at++, value);
    statement.run();
}

PointRecord read_point(const Statement& row, const RunRecord& run) {
    PointRecord point;
    point.number = static_cast<std::size_t>(row.integer(0));
    point.chain = static_cast<std::size_t>(row.integer(1));
    point.direction = index_of(run.directions, row.text(2));
    int at = 3;
    for (std::size_t i = 0; i < run.coordinates.size(); ++i)
        point.coordinates.push_back(row.number(at++));
    PointResult& result = point.result;
    result.label = label_named(row.text(at));
    result.period = static_cast<std::size_t>(row.integer(at + 1));
    result.duration = row.number(at + 2);
    result.signature = row.text(at + 3);
    if (!row.is_null(at + 4))
        result.symmetric = row.integer(at + 4) != 0;
    if (!row.is_null(at + 6))
        result.lyapunov = row.number(at + 6);
    if (!row.is_null(at + 7))
        result.lyapunov_error = row.number(at + 7);
    result.residual = row.number(at + 8);
    result.cycles = static_cast<std::size_t>(row.integer(at + 9));
    result.periods_run = static_cast<std::size_t>(row.integer(at + 10));
    result.time = row.number(at + 11);
    result.mode = index_of(run.modes, row.text(at + 12));
    result.outcome.ending = ending_named(row.text(at + 13));
    result.outcome.time = row.number(at + 14);
    result.outcome.detail = row.text(at + 15);
    at += fixed_point_columns;
    for (std::size_t i = 0; i < run.states.size(); ++i)
        result.state.push_back(row.is_null(at + static_cast<int>(i)) ? std::numeric_limits<double>::quiet_NaN()
                                                                     : row.number(at + static_cast<int>(i)));
    return point;
}

} // namespace graze
