#include "results/orbit_columns.hpp"

#include "base/special_numbers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace graze {

namespace {

using Context = OrbitContext;
using Type = ColumnType;
using Unit = ColumnUnit;

OrbitOutcome outcome_named(const std::string& name) {
    for (int i = 0; i <= static_cast<int>(OrbitOutcome::undefined); ++i)
        if (name == name_of(static_cast<OrbitOutcome>(i)))
            return static_cast<OrbitOutcome>(i);
    return OrbitOutcome::not_converged;
}

/// Components of a direction: for each segment those of its start and its duration, then those of the parameters.
std::vector<double> numbers_of(const OrbitDirection& direction) {
    std::vector<double> numbers;
    for (std::size_t s = 0; s < direction.starts.size(); ++s) {
        numbers.insert(numbers.end(), direction.starts[s].begin(), direction.starts[s].end());
        numbers.push_back(direction.durations[s]);
    }
    numbers.insert(numbers.end(), direction.parameters.begin(), direction.parameters.end());
    return numbers;
}

/// The direction with these components. There are fewer parameters than numbers of a segment.
OrbitDirection direction_of(const std::vector<double>& numbers, std::size_t states) {
    OrbitDirection direction;
    auto next = numbers.begin();
    for (; numbers.end() - next > static_cast<std::ptrdiff_t>(states + 1);) {
        const auto end = next + static_cast<std::ptrdiff_t>(states);
        direction.starts.emplace_back(next, end);
        direction.durations.push_back(*end);
        next = end + 1;
    }
    direction.parameters.assign(next, numbers.end());
    return direction;
}

std::vector<double> listed_numbers(const std::string& json) {
    std::istringstream text(json.substr(std::min<std::size_t>(1, json.size())));
    std::vector<double> values;
    double value = 0;
    for (char separator = ','; separator == ',' && text >> value; text >> separator)
        values.push_back(value);
    return values;
}

/// Writes a cell that is missing unless the point is of a type that an event limits.
template <class Write>
void write_of_event(const OrbitRecord& record, CellWriter& cell, Write write) {
    kind_of(record.point.type).limits ? write() : cell.nothing();
}

/// Writes a number that only touching orbits can have.
void write_touch(const OrbitRecord& record, CellWriter& cell, std::optional<double> TouchFindings::*number) {
    cell.real(record.touch ? ((*record.touch).*number).value_or(not_a_number) : not_a_number);
}
void read_touch(OrbitRecord& record, CellReader& cell, std::optional<double> TouchFindings::*number) {
    if (record.touch && !cell.is_nothing())
        (*record.touch).*number = cell.number();
}

/// Least speed at which the orbit meets an event; unknown if it meets none. It goes to zero where a contact is lost.
double slowest_approach(const OrbitSolution& solution) {
    double slowest = not_a_number;
    const std::vector<double>& speeds = solution.certificate.approach_speeds;
    for (std::size_t s = 0; s < std::min(speeds.size(), solution.orbit.segments()); ++s)
        if (solution.orbit.signature[s].end == SegmentEnd::event)
            slowest = std::fmin(slowest, speeds[s]);
    return slowest;
}

/// Index of a segment, from its number in the file, which begins at 1.
std::size_t segment_of(CellReader& cell) {
    return static_cast<std::size_t>(std::max<std::int64_t>(static_cast<std::int64_t>(cell.whole()), 1) - 1);
}

std::size_t event_named(const Model& model, const std::string& name) {
    return model.find_event(name).value_or(model.events.size());
}

} // namespace

OrbitContext::OrbitContext(const RunRecord& of_run, const Model& of_model) : run(&of_run), model(&of_model) {
    for (const ResultColumn& column : of_run.coordinates)
        parameters.push_back(of_model.independent_parameter(column.name));
}

const ColumnsOf<OrbitContext, OrbitRecord>& orbit_columns() {
    using Record = OrbitRecord;
    static const ColumnsOf<OrbitContext, OrbitRecord> columns{
        {{"number", Type::whole, Unit::none, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.whole(r.number); },
         [](const Context&, Record& r, CellReader& cell) { r.number = cell.whole(); }},
        {{"part", Type::text, Unit::none, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.text(r.part); },
         [](const Context&, Record& r, CellReader& cell) { r.part = cell.text(); }},
        {{"step", Type::whole, Unit::none, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.whole(r.point.step); },
         [](const Context&, Record& r, CellReader& cell) { r.point.step = cell.whole(); }},
        {{"type", Type::text, Unit::none, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.text(short_name(r.point.type)); },
         [](const Context&, Record& r, CellReader& cell) {
             r.point.type = point_type(cell.text()).value_or(PointType::regular);
         }},
        {{"label", Type::text, Unit::none, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.word(r.label); },
         [](const Context&, Record& r, CellReader& cell) { r.label = cell.text(); }},
        {{"", Type::real, Unit::own, true, ColumnGroup::coordinates},
         [](const Context& context, const Record& r, CellWriter& cells) {
             for (const ParameterId one : context.parameters)
                 cells.real(r.point.solution.orbit.parameters[one.place()]);
         },
         [](const Context& context, Record& r, CellReader& cells) {
             std::vector<double>& parameters = r.point.solution.orbit.parameters;
             parameters = context.model->parameter_values();
             for (const ParameterId one : context.parameters)
                 parameters[one.place()] = cells.number();
             r.point.parameter = context.parameters.empty() ? 0 : parameters[context.parameters.front().place()];
         }},
        {{"period", Type::real, Unit::time, true}, // derived from the segments
         [](const Context&, const Record& r, CellWriter& cell) { cell.real(r.point.solution.orbit.period()); }},
        {{"", Type::real, Unit::own, false, ColumnGroup::values},
         [](const Context& context, const Record& r, CellWriter& cells) {
             for (std::size_t m = 0; m < context.run->values.size(); ++m)
                 cells.extended(m < r.point.monitors.size() ? r.point.monitors[m] : not_a_number);
         },
         [](const Context& context, Record& r, CellReader& cells) {
             for (std::size_t m = 0; m < context.run->values.size(); ++m)
                 r.point.monitors.push_back(cells.real());
         }},
        {{"signature", Type::text, Unit::none, true}, // derived from the segments
         [](const Context& context, const Record& r, CellWriter& cell) {
             cell.text(to_string(*context.model, r.point.solution.orbit.signature));
         }},
        {{"symmetry", Type::text, Unit::none, true},
         [](const Context& context, const Record& r, CellWriter& cell) {
             const auto& symmetry = r.point.solution.orbit.symmetry;
             symmetry ? cell.word(context.model->symmetries[*symmetry].name) : cell.nothing();
         },
         [](const Context& context, Record& r, CellReader& cell) {
             const std::string name = cell.text();
             for (std::size_t i = 0; i < context.model->symmetries.size() && !name.empty(); ++i)
                 if (context.model->symmetries[i].name == name)
                     r.point.solution.orbit.symmetry = i;
         }},
        {{"stable", Type::whole, Unit::none, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.truth(r.stable); },
         [](const Context&, Record& r, CellReader& cell) { r.stable = cell.truth(); }},
        {added({"unstable", Type::whole, Unit::none, true}), // and this from the multipliers
         [](const Context&, const Record& r, CellWriter& cell) { cell.whole(unstable_directions(r.point.solution)); }},
        {added({"slowest_approach", Type::real, Unit::none, true}), // this from the segments again
         [](const Context&, const Record& r, CellWriter& cell) { cell.real(slowest_approach(r.point.solution)); }},
        {{"admissible", Type::whole, Unit::none, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.truth(r.point.solution.certificate.admissible); },
         [](const Context&, Record& r, CellReader& cell) { r.point.solution.certificate.admissible = cell.truth(); }},
        {{"reason", Type::text, Unit::none, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.word(r.point.solution.certificate.reason); },
         [](const Context&, Record& r, CellReader& cell) { r.point.solution.certificate.reason = cell.text(); }},
        {{"outcome", Type::text, Unit::none, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.text(name_of(r.point.solution.outcome)); },
         [](const Context&, Record& r, CellReader& cell) { r.point.solution.outcome = outcome_named(cell.text()); }},
        {{"detail", Type::text, Unit::none, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.word(r.point.detail); },
         [](const Context&, Record& r, CellReader& cell) { r.point.detail = cell.text(); }},
        {{"residual", Type::real, Unit::none, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.real(r.point.solution.residual); },
         [](const Context&, Record& r, CellReader& cell) { r.point.solution.residual = cell.real(); }},
        {added({"error", Type::real, Unit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) {
             cell.real(r.point.solution.error.value_or(not_a_number));
         },
         [](const Context&, Record& r, CellReader& cell) {
             if (!cell.is_nothing())
                 r.point.solution.error = cell.number();
         }},
        {{"iterations", Type::whole},
         [](const Context&, const Record& r, CellWriter& cell) { cell.whole(r.point.solution.iterations); },
         [](const Context&, Record& r, CellReader& cell) { r.point.solution.iterations = cell.whole(); }},
        {{"arclength", Type::real, Unit::none, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.real(r.point.arclength); },
         [](const Context&, Record& r, CellReader& cell) { r.point.arclength = cell.number(); }},
        {{"located", Type::whole, Unit::none, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.truth(r.point.located); },
         [](const Context&, Record& r, CellReader& cell) { r.point.located = cell.truth(); }},
        {{"bracket_low", Type::real, Unit::followed, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.real(r.point.bracket.first); },
         [](const Context&, Record& r, CellReader& cell) { r.point.bracket.first = cell.real(); }},
        {{"bracket_high", Type::real, Unit::followed, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.real(r.point.bracket.second); },
         [](const Context&, Record& r, CellReader& cell) { r.point.bracket.second = cell.real(); }},
        {{"event", Type::text},
         [](const Context& context, const Record& r, CellWriter& cell) {
             write_of_event(r, cell, [&] { cell.text(context.model->events[r.point.event].name); });
         },
         [](const Context& context, Record& r, CellReader& cell) {
             if (const auto event = context.model->find_event(cell.text()))
                 r.point.event = *event;
         }},
        {{"event_segment", Type::whole},
         [](const Context&, const Record& r, CellWriter& cell) {
             write_of_event(r, cell, [&] { cell.whole(r.point.segment + 1); });
         },
         [](const Context&, Record& r, CellReader& cell) { r.point.segment = segment_of(cell); }},
        {{"event_time", Type::real, Unit::time},
         [](const Context&, const Record& r, CellWriter& cell) {
             write_of_event(r, cell, [&] { cell.real(r.point.time); });
         },
         [](const Context&, Record& r, CellReader& cell) { r.point.time = cell.number(); }},
        {{"at_end", Type::whole},
         [](const Context&, const Record& r, CellWriter& cell) {
             write_of_event(r, cell, [&] { cell.truth(r.point.at_end); });
         },
         [](const Context&, Record& r, CellReader& cell) { r.point.at_end = cell.truth(); }},
        {added({"touch_map", Type::text, Unit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) { cell.word(r.touch ? r.touch->map : ""); },
         [](const Context&, Record& r, CellReader& cell) {
             if (!cell.is_nothing())
                 r.touch.emplace().map = cell.text();
         }},
        {added({"touch_verdict", Type::text, Unit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) { cell.word(r.touch ? r.touch->verdict : ""); },
         [](const Context&, Record& r, CellReader& cell) {
             if (r.touch)
                 r.touch->verdict = cell.text();
         }},
        {added({"touch_verdict_reason", Type::text, Unit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) { cell.word(r.touch ? r.touch->reason : ""); },
         [](const Context&, Record& r, CellReader& cell) {
             if (r.touch)
                 r.touch->reason = cell.text();
         }},
        {added({"touch_next_contact", Type::whole, Unit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) {
             r.touch&& r.touch->next_contact > 0 ? cell.whole(r.touch->next_contact) : cell.nothing();
         },
         [](const Context&, Record& r, CellReader& cell) {
             if (r.touch)
                 r.touch->next_contact = cell.whole();
         }},
        {added({"touch_projection_1", Type::real, Unit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) { write_touch(r, cell, &TouchFindings::projection); },
         [](const Context&, Record& r, CellReader& cell) { read_touch(r, cell, &TouchFindings::projection); }},
        {added({"touch_growth", Type::real, Unit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) { write_touch(r, cell, &TouchFindings::growth); },
         [](const Context&, Record& r, CellReader& cell) { read_touch(r, cell, &TouchFindings::growth); }},
        {added({"touch_jump_growth", Type::real, Unit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) { write_touch(r, cell, &TouchFindings::jump_growth); },
         [](const Context&, Record& r, CellReader& cell) { read_touch(r, cell, &TouchFindings::jump_growth); }},
        {added({"touch_reach", Type::real, Unit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) { write_touch(r, cell, &TouchFindings::reach); },
         [](const Context&, Record& r, CellReader& cell) { read_touch(r, cell, &TouchFindings::reach); }},
        {added({"touch_clearance_rate", Type::real, Unit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) {
             write_touch(r, cell, &TouchFindings::clearance_rate);
         },
         [](const Context&, Record& r, CellReader& cell) { read_touch(r, cell, &TouchFindings::clearance_rate); }},
        {added({"touch_speed_factor", Type::real, Unit::none, true}, "touch_first_speed"),
         [](const Context&, const Record& r, CellWriter& cell) { write_touch(r, cell, &TouchFindings::speed_factor); },
         [](const Context&, Record& r, CellReader& cell) { read_touch(r, cell, &TouchFindings::speed_factor); }},
        {added({"touch_fold_distance", Type::real, Unit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) { write_touch(r, cell, &TouchFindings::fold_distance); },
         [](const Context&, Record& r, CellReader& cell) { read_touch(r, cell, &TouchFindings::fold_distance); }},
        {{"tangent", Type::text}, // as JSON
         [](const Context&, const Record& r, CellWriter& cell) {
             cell.text(fmt::format("[{}]", fmt::join(numbers_of(r.point.tangent), ",")));
         },
         [](const Context& context, Record& r, CellReader& cell) {
             r.point.tangent = direction_of(listed_numbers(cell.text()), context.model->states.size());
         }},
    };
    return columns;
}

const ColumnsOf<OrbitContext, SegmentRow>& segment_columns() {
    using Row = SegmentRow;
    static const ColumnsOf<OrbitContext, SegmentRow> columns{
        {{"point", Type::whole},
         [](const Context&, const Row& s, CellWriter& cell) { cell.whole(s.point); },
         [](const Context&, Row& s, CellReader& cell) { s.point = cell.whole(); }},
        {{"segment", Type::whole},
         [](const Context&, const Row& s, CellWriter& cell) { cell.whole(s.number); },
         [](const Context&, Row& s, CellReader& cell) { s.number = cell.whole(); }},
        {{"mode", Type::text},
         [](const Context&, const Row& s, CellWriter& cell) { cell.text(s.mode); },
         [](const Context&, Row& s, CellReader& cell) { s.mode = cell.text(); }},
        {{"ending", Type::text},
         [](const Context&, const Row& s, CellWriter& cell) { cell.text(s.ending); },
         [](const Context&, Row& s, CellReader& cell) { s.ending = cell.text(); }},
        {{"duration", Type::real, Unit::time},
         [](const Context&, const Row& s, CellWriter& cell) { cell.real(s.duration); },
         [](const Context&, Row& s, CellReader& cell) { s.duration = cell.real(); }},
        {{"approach_speed", Type::real},
         [](const Context&, const Row& s, CellWriter& cell) { cell.real(s.approach_speed); },
         [](const Context&, Row& s, CellReader& cell) { s.approach_speed = cell.real(); }},
        {{"departure", Type::real},
         [](const Context&, const Row& s, CellWriter& cell) { cell.real(s.departure); },
         [](const Context&, Row& s, CellReader& cell) { s.departure = cell.real(); }},
        {{"guard_margin", Type::real}, // missing if infinite: no other transition is possible
         [](const Context&, const Row& s, CellWriter& cell) { cell.real(s.guard_margin); },
         [](const Context&, Row& s, CellReader& cell) {
             s.guard_margin = cell.is_nothing() ? std::numeric_limits<double>::infinity() : cell.number();
         }},
        {{"start_", Type::real, Unit::own, false, ColumnGroup::states},
         [](const Context&, const Row& s, CellWriter& cells) {
             for (const double value : s.start)
                 cells.real(value);
         },
         [](const Context& context, Row& s, CellReader& cells) {
             s.start.clear();
             for (std::size_t i = 0; i < context.run->states.size(); ++i)
                 s.start.push_back(cells.real());
         }},
    };
    return columns;
}

const ColumnsOf<OrbitContext, OrbitMinimum>& minimum_columns() {
    using Row = OrbitMinimum;
    static const ColumnsOf<OrbitContext, OrbitMinimum> columns{
        {{"segment", Type::whole},
         [](const Context&, const Row& m, CellWriter& cell) { cell.whole(m.segment + 1); },
         [](const Context&, Row& m, CellReader& cell) { m.segment = segment_of(cell); }},
        {{"event", Type::text},
         [](const Context& context, const Row& m, CellWriter& cell) { cell.text(context.model->events[m.event].name); },
         [](const Context& context, Row& m, CellReader& cell) { m.event = event_named(*context.model, cell.text()); }},
        {{"time", Type::real, Unit::time},
         [](const Context&, const Row& m, CellWriter& cell) { cell.real(m.time); },
         [](const Context&, Row& m, CellReader& cell) { m.time = cell.number(); }},
        {{"value", Type::real},
         [](const Context&, const Row& m, CellWriter& cell) { cell.extended(m.value); },
         [](const Context&, Row& m, CellReader& cell) { m.value = cell.number(); }},
        {{"size", Type::real},
         [](const Context&, const Row& m, CellWriter& cell) { cell.real(m.size); },
         [](const Context&, Row& m, CellReader& cell) { m.size = cell.number(); }},
    };
    return columns;
}

const ColumnsOf<OrbitContext, EndValue>& end_value_columns() {
    using Row = EndValue;
    static const ColumnsOf<OrbitContext, EndValue> columns{
        {{"segment", Type::whole},
         [](const Context&, const Row& e, CellWriter& cell) { cell.whole(e.segment + 1); },
         [](const Context&, Row& e, CellReader& cell) { e.segment = segment_of(cell); }},
        {{"event", Type::text},
         [](const Context& context, const Row& e, CellWriter& cell) { cell.text(context.model->events[e.event].name); },
         [](const Context& context, Row& e, CellReader& cell) { e.event = event_named(*context.model, cell.text()); }},
        {{"value", Type::real},
         [](const Context&, const Row& e, CellWriter& cell) { cell.extended(e.value); },
         [](const Context&, Row& e, CellReader& cell) { e.value = cell.number(); }},
        {{"rate", Type::real},
         [](const Context&, const Row& e, CellWriter& cell) { cell.extended(e.rate); },
         [](const Context&, Row& e, CellReader& cell) { e.rate = cell.number(); }},
    };
    return columns;
}

} // namespace graze
