#include "results/point_columns.hpp"

#include "graze/base/input_error.hpp"

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

bool is_periodic(const PointRecord& point) {
    return point.result.label == Label::periodic;
}

void write_optional(const std::optional<double>& value, CellWriter& cell) {
    value ? cell.real(*value) : cell.nothing();
}

std::optional<double> read_optional(CellReader& cell) {
    return cell.is_nothing() ? std::nullopt : std::optional(cell.number());
}

using Run = RunRecord;
using Point = PointRecord;
using Type = ColumnType;
using Unit = ColumnUnit;

} // namespace

const ColumnsOf<RunRecord, PointRecord>& point_columns() {
    static const ColumnsOf<RunRecord, PointRecord> columns{
        {{"number", Type::whole, Unit::none, true},
         [](const Run&, const Point& p, CellWriter& cell) { cell.whole(p.number); },
         [](const Run&, Point& p, CellReader& cell) { p.number = cell.whole(); }},
        {{"chain", Type::whole, Unit::none, true},
         [](const Run&, const Point& p, CellWriter& cell) { cell.whole(p.chain); },
         [](const Run&, Point& p, CellReader& cell) { p.chain = cell.whole(); }},
        {{"direction", Type::text, Unit::none, true},
         [](const Run& run, const Point& p, CellWriter& cell) {
             cell.text(p.direction < run.directions.size() ? run.directions[p.direction] : "");
         },
         [](const Run& run, Point& p, CellReader& cell) { p.direction = index_of(run.directions, cell.text()); }},
        {{"", Type::real, Unit::own, true, ColumnGroup::coordinates},
         [](const Run&, const Point& p, CellWriter& cells) {
             for (const double coordinate : p.coordinates)
                 cells.real(coordinate);
         },
         [](const Run& run, Point& p, CellReader& cells) {
             for (std::size_t i = 0; i < run.coordinates.size(); ++i)
                 p.coordinates.push_back(cells.number());
         }},
        {{"label", Type::text, Unit::none, true},
         [](const Run&, const Point& p, CellWriter& cell) { cell.text(name_of(p.result.label)); },
         [](const Run&, Point& p, CellReader& cell) { p.result.label = label_named(cell.text()); }},
        {{"period", Type::whole, Unit::none, true}, // number of returns
         [](const Run&, const Point& p, CellWriter& cell) {
             is_periodic(p) ? cell.whole(p.result.period) : cell.nothing();
         },
         [](const Run&, Point& p, CellReader& cell) { p.result.period = cell.whole(); }},
        {{"duration", Type::real, Unit::time, true},
         [](const Run&, const Point& p, CellWriter& cell) {
             is_periodic(p) ? cell.real(p.result.duration) : cell.nothing();
         },
         [](const Run&, Point& p, CellReader& cell) { p.result.duration = cell.number(); }},
        {{"signature", Type::text, Unit::none, true},
         [](const Run&, const Point& p, CellWriter& cell) {
             is_periodic(p) ? cell.text(p.result.signature) : cell.nothing();
         },
         [](const Run&, Point& p, CellReader& cell) { p.result.signature = cell.text(); }},
        {added({"symmetric", Type::whole, Unit::none, true}),
         [](const Run&, const Point& p, CellWriter& cell) {
             p.result.symmetric ? cell.truth(*p.result.symmetric) : cell.nothing();
         },
         [](const Run&, Point& p, CellReader& cell) {
             if (!cell.is_nothing())
                 p.result.symmetric = cell.truth();
         }},
        {added({"multiplier", Type::real, Unit::none, true}),
         [](const Run&, const Point& p, CellWriter& cell) {
             p.result.multipliers.empty() ? cell.nothing() : cell.extended(std::abs(p.result.multipliers.front()));
         }},
        {added({"lyapunov", Type::real, Unit::per_time, true}),
         [](const Run&, const Point& p, CellWriter& cell) { write_optional(p.result.lyapunov, cell); },
         [](const Run&, Point& p, CellReader& cell) { p.result.lyapunov = read_optional(cell); }},
        {added({"lyapunov_error", Type::real, Unit::per_time, true}),
         [](const Run&, const Point& p, CellWriter& cell) { write_optional(p.result.lyapunov_error, cell); },
         [](const Run&, Point& p, CellReader& cell) { p.result.lyapunov_error = read_optional(cell); }},
        {{"residual", Type::real, Unit::none, true},
         [](const Run&, const Point& p, CellWriter& cell) {
             is_periodic(p) ? cell.real(p.result.residual) : cell.nothing();
         },
         [](const Run&, Point& p, CellReader& cell) { p.result.residual = cell.number(); }},
        {{"cycles", Type::whole, Unit::none, true},
         [](const Run&, const Point& p, CellWriter& cell) { cell.whole(p.result.cycles); },
         [](const Run&, Point& p, CellReader& cell) { p.result.cycles = cell.whole(); }},
        {{"returns", Type::whole, Unit::none, true},
         [](const Run&, const Point& p, CellWriter& cell) { cell.whole(p.result.periods_run); },
         [](const Run&, Point& p, CellReader& cell) { p.result.periods_run = cell.whole(); }},
        {{"time", Type::real, Unit::time, true},
         [](const Run&, const Point& p, CellWriter& cell) { cell.real(p.result.time); },
         [](const Run&, Point& p, CellReader& cell) { p.result.time = cell.number(); }},
        {{"mode", Type::text, Unit::none, true},
         [](const Run& run, const Point& p, CellWriter& cell) {
             p.result.mode < run.modes.size() ? cell.text(run.modes[p.result.mode]) : cell.nothing();
         },
         [](const Run& run, Point& p, CellReader& cell) { p.result.mode = index_of(run.modes, cell.text()); }},
        {{"ending", Type::text, Unit::none, true},
         [](const Run&, const Point& p, CellWriter& cell) { cell.text(name_of(p.result.outcome.ending)); },
         [](const Run&, Point& p, CellReader& cell) { p.result.outcome.ending = ending_named(cell.text()); }},
        {{"ending_time", Type::real, Unit::time, true},
         [](const Run&, const Point& p, CellWriter& cell) { cell.real(p.result.outcome.time); },
         [](const Run&, Point& p, CellReader& cell) { p.result.outcome.time = cell.number(); }},
        {{"detail", Type::text},
         [](const Run&, const Point& p, CellWriter& cell) { cell.text(p.result.outcome.detail); },
         [](const Run&, Point& p, CellReader& cell) { p.result.outcome.detail = cell.text(); }},
        {{"end_", Type::real, Unit::own, false, ColumnGroup::states},
         [](const Run&, const Point& p, CellWriter& cells) {
             for (const double value : p.result.state)
                 cells.real(value);
         },
         [](const Run& run, Point& p, CellReader& cells) {
             for (std::size_t i = 0; i < run.states.size(); ++i)
                 p.result.state.push_back(cells.real());
         }},
    };
    return columns;
}

const ColumnsOf<RunRecord, SampleRow>& sample_columns() {
    static const ColumnsOf<RunRecord, SampleRow> columns{
        {{"point", Type::whole},
         [](const Run&, const SampleRow& s, CellWriter& cell) { cell.whole(s.point); },
         [](const Run&, SampleRow& s, CellReader& cell) { s.point = cell.whole(); }},
        {{"sampling", Type::text},
         [](const Run& run, const SampleRow& s, CellWriter& cell) { cell.text(run.samplings[s.sampling]); },
         [](const Run& run, SampleRow& s, CellReader& cell) { s.sampling = index_of(run.samplings, cell.text()); }},
        {{"time", Type::real, Unit::time},
         [](const Run&, const SampleRow& s, CellWriter& cell) { cell.real(s.time); },
         [](const Run&, SampleRow& s, CellReader& cell) { s.time = cell.number(); }},
        {{"", Type::real, Unit::own, false, ColumnGroup::values},
         [](const Run&, const SampleRow& s, CellWriter& cells) {
             for (const double value : s.values)
                 cells.real(value);
         },
         [](const Run& run, SampleRow& s, CellReader& cells) {
             s.values.clear();
             for (std::size_t v = 0; v < run.values.size(); ++v)
                 s.values.push_back(cells.number());
         }},
    };
    return columns;
}

const ColumnsOf<RunRecord, std::complex<double>>& multiplier_columns() {
    using Multiplier = std::complex<double>;
    static const ColumnsOf<RunRecord, Multiplier> columns{
        {{"real", Type::real},
         [](const Run&, const Multiplier& m, CellWriter& cell) { cell.extended(m.real()); },
         [](const Run&, Multiplier& m, CellReader& cell) { // missing: the infinite multiplier of a grazing orbit
             m.real(cell.is_nothing() ? std::numeric_limits<double>::infinity() : cell.number());
         }},
        {{"imaginary", Type::real},
         [](const Run&, const Multiplier& m, CellWriter& cell) { cell.extended(m.imag()); },
         [](const Run&, Multiplier& m, CellReader& cell) { m.imag(cell.number()); }},
    };
    return columns;
}

std::size_t index_of(const std::vector<std::string>& names, const std::string& name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

void throw_contradiction(const std::string& path, const std::string& what) {
    throw InputError(Place{path, 0, 0}, fmt::format("the result file contradicts itself: {}", what),
                     "it has been changed or damaged: ask for another copy, or run the study again");
}

void require_columns(const Statement& rows, std::size_t columns, const std::string& path) {
    if (static_cast<std::size_t>(rows.columns()) != columns)
        throw_contradiction(path, fmt::format("a table has {} columns instead of {}", rows.columns(), columns));
}

} // namespace graze
