#include "results/point_columns.hpp"

#include "base/enumerator_name.hpp"
#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

constexpr auto is_periodic = [](const PointRecord& point) { return point.result.label == Label::periodic; };

using Run = RunRecord;
using Point = PointRecord;
using Type = ColumnType;
using Unit = ColumnUnit;

} // namespace

const ColumnsOf<RunRecord, PointRecord>& point_columns() {
    static const ColumnsOf<RunRecord, PointRecord> columns{
        whole_column(shown("number"), [](auto& p) { return &p.number; }),
        whole_column(shown("chain"), [](auto& p) { return &p.chain; }),
        {{"direction", Type::text, Unit::none, true},
         [](const Run& run, const Point& p, CellWriter& cell) {
             cell.text(p.direction < run.directions.size() ? run.directions[p.direction] : "");
         },
         [](const Run& run, Point& p, CellReader& cell) { p.direction = index_of(run.directions, cell.text()); }},
        {{"", Type::real, Unit::own, true, ColumnGroup::coordinates},
         [](const Run&, const Point& p, CellWriter& cells) { cells.reals(p.coordinates); },
         [](const Run& run, Point& p, CellReader& cells) {
             for (std::size_t i = 0; i < run.coordinates.size(); ++i)
                 p.coordinates.push_back(cells.number());
         }},
        {{"label", Type::text, Unit::none, true},
         [](const Run&, const Point& p, CellWriter& cell) { cell.text(name_of(p.result.label)); },
         [](const Run&, Point& p, CellReader& cell) {
             p.result.label = enumerator_named(cell.text(), Label::failed).value_or(Label::failed);
         }},
        only_if(is_periodic, whole_column(shown("period"), // number of returns
                                          [](auto& p) { return &p.result.period; })),
        only_if(is_periodic, number_column(shown("duration", Unit::time), [](auto& p) { return &p.result.duration; })),
        only_if(is_periodic, text_column(shown("signature"), [](auto& p) { return &p.result.signature; })),
        {added({"symmetric", Type::whole, Unit::none, true}),
         [](const Run&, const Point& p, CellWriter& cell) {
             p.result.symmetric ? cell.truth(*p.result.symmetric) : cell.nothing();
         },
         [](const Run&, Point& p, CellReader& cell) {
             if (!cell.is_nothing())
                 p.result.symmetric = cell.truth();
         }},
        {added(shown("multiplier")),
         [](const Run&, const Point& p, CellWriter& cell) {
             p.result.multipliers.empty() ? cell.nothing() : cell.extended(std::abs(p.result.multipliers.front()));
         }},
        optional_column(added(shown("lyapunov", Unit::per_time)), [](auto& p) { return &p.result.lyapunov; }),
        optional_column(added(shown("lyapunov_error", Unit::per_time)),
                        [](auto& p) { return &p.result.lyapunov_error; }),
        only_if(is_periodic, number_column(shown("residual"), [](auto& p) { return &p.result.residual; })),
        whole_column(shown("cycles"), [](auto& p) { return &p.result.cycles; }),
        whole_column(shown("returns"), [](auto& p) { return &p.result.periods_run; }),
        number_column(shown("time", Unit::time), [](auto& p) { return &p.result.time; }),
        {{"mode", Type::text, Unit::none, true},
         [](const Run& run, const Point& p, CellWriter& cell) {
             p.result.mode < run.modes.size() ? cell.text(run.modes[p.result.mode]) : cell.nothing();
         },
         [](const Run& run, Point& p, CellReader& cell) { p.result.mode = index_of(run.modes, cell.text()); }},
        {{"ending", Type::text, Unit::none, true},
         [](const Run&, const Point& p, CellWriter& cell) { cell.text(name_of(p.result.outcome.ending)); },
         [](const Run&, Point& p, CellReader& cell) {
             p.result.outcome.ending = enumerator_named(cell.text(), Ending::step_limit).value_or(Ending::running);
         }},
        number_column(shown("ending_time", Unit::time), [](auto& p) { return &p.result.outcome.time; }),
        text_column(kept("detail"), [](auto& p) { return &p.result.outcome.detail; }),
        {{"end_", Type::real, Unit::own, false, ColumnGroup::states},
         [](const Run&, const Point& p, CellWriter& cells) { cells.reals(p.result.state); },
         [](const Run& run, Point& p, CellReader& cells) { cells.reals(p.result.state, run.states.size()); }},
    };
    return columns;
}

const ColumnsOf<RunRecord, SampleRow>& sample_columns() {
    static const ColumnsOf<RunRecord, SampleRow> columns{
        whole_column(kept("point"), [](auto& s) { return &s.point; }),
        {{"sampling", Type::text},
         [](const Run& run, const SampleRow& s, CellWriter& cell) { cell.text(run.samplings[s.sampling]); },
         [](const Run& run, SampleRow& s, CellReader& cell) { s.sampling = index_of(run.samplings, cell.text()); }},
        number_column(kept("time", Unit::time), [](auto& s) { return &s.time; }),
        {{"", Type::real, Unit::own, false, ColumnGroup::values},
         [](const Run&, const SampleRow& s, CellWriter& cells) { cells.reals(s.values); },
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
