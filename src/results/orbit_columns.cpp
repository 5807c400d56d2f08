#include "results/orbit_columns.hpp"

#include "base/enumerator_name.hpp"
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

/// Whether the point is of a type that an event limits.
constexpr auto has_event = [](const OrbitRecord& record) { return kind_of(record.point.type).limits; };

/// A number that only touching orbits can have.
template <std::optional<double> TouchFindings::*number>
ColumnOf<Context, OrbitRecord> touch_number(const char* name, const char* former = "") {
    return {added(shown(name), former),
            [](const Context&, const OrbitRecord& r, CellWriter& cell) {
                cell.optional(r.touch ? (*r.touch).*number : std::nullopt);
            },
            [](const Context&, OrbitRecord& r, CellReader& cell) {
                if (r.touch)
                    (*r.touch).*number = cell.optional();
            }};
}

template <std::string TouchFindings::*text>
ColumnOf<Context, OrbitRecord> touch_text(const char* name) {
    return {added({name, ColumnType::text, ColumnUnit::none, true}),
            [](const Context&, const OrbitRecord& r, CellWriter& cell) { cell.word(r.touch ? (*r.touch).*text : ""); },
            [](const Context&, OrbitRecord& r, CellReader& cell) {
                if (r.touch)
                    (*r.touch).*text = cell.text();
            }};
}

/// A number that only tori have, besides their rotation number.
template <double TorusRecord::*number>
ColumnOf<Context, OrbitRecord> torus_number(const char* name) {
    return {added(shown(name)),
            [](const Context&, const OrbitRecord& r, CellWriter& cell) {
                r.torus ? cell.real((*r.torus).*number) : cell.nothing();
            },
            [](const Context&, OrbitRecord& r, CellReader& cell) {
                if (r.torus)
                    (*r.torus).*number = cell.number();
            }};
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

} // namespace

OrbitContext::OrbitContext(const RunRecord& of_run, const Model& of_model) : run(&of_run), model(&of_model) {
    for (const ResultColumn& column : of_run.coordinates)
        parameters.push_back(of_model.independent_parameter(column.name));
}

const ColumnsOf<OrbitContext, OrbitRecord>& orbit_columns() {
    using Record = OrbitRecord;
    static const ColumnsOf<OrbitContext, OrbitRecord> columns{
        whole_column(shown("number"), [](auto& r) { return &r.number; }),
        text_column(shown("part"), [](auto& r) { return &r.part; }),
        whole_column(shown("step"), [](auto& r) { return &r.point.step; }),
        {{"type", ColumnType::text, ColumnUnit::none, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.text(short_name(r.point.type)); },
         [](const Context&, Record& r, CellReader& cell) {
             r.point.type = point_type(cell.text()).value_or(PointType::regular);
         }},
        word_column(shown("label"), [](auto& r) { return &r.label; }),
        {{"", ColumnType::real, ColumnUnit::own, true, ColumnGroup::coordinates},
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
        {{"period", ColumnType::real, ColumnUnit::time, true}, // derived from the segments
         [](const Context&, const Record& r, CellWriter& cell) { cell.real(r.point.solution.orbit.period()); }},
        {{"", ColumnType::real, ColumnUnit::own, false, ColumnGroup::values},
         [](const Context& context, const Record& r, CellWriter& cells) {
             for (std::size_t m = 0; m < context.run->values.size(); ++m)
                 cells.extended(m < r.point.monitors.size() ? r.point.monitors[m] : not_a_number);
         },
         [](const Context& context, Record& r, CellReader& cells) {
             for (std::size_t m = 0; m < context.run->values.size(); ++m)
                 r.point.monitors.push_back(cells.real());
         }},
        {{"signature", ColumnType::text, ColumnUnit::none, true}, // derived from the segments
         [](const Context& context, const Record& r, CellWriter& cell) {
             cell.text(to_string(*context.model, r.point.solution.orbit.signature));
         }},
        {{"symmetry", ColumnType::text, ColumnUnit::none, true},
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
        {added({"cycle_segments", ColumnType::whole, ColumnUnit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) {
             const auto& cycle = r.point.solution.orbit.cycle;
             cycle ? cell.whole(*cycle) : cell.nothing();
         },
         [](const Context&, Record& r, CellReader& cell) {
             if (!cell.is_nothing())
                 r.point.solution.orbit.cycle = cell.whole();
         }},
        truth_column(shown("stable"), [](auto& r) { return &r.stable; }),
        {added({"unstable", ColumnType::whole, ColumnUnit::none, true}), // and this from the multipliers
         [](const Context&, const Record& r, CellWriter& cell) {
             r.torus ? cell.nothing() : cell.whole(unstable_directions(r.point.solution));
         }},
        {added({"other_multipliers", ColumnType::whole, ColumnUnit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) {
             const OrbitSolution& solution = r.point.solution;
             solution.other_multipliers > 0 ? cell.whole(solution.other_multipliers) : cell.nothing();
         },
         [](const Context&, Record& r, CellReader& cell) {
             if (!cell.is_nothing())
                 r.point.solution.other_multipliers = cell.whole();
         }},
        {added(shown("others_within")),
         [](const Context&, const Record& r, CellWriter& cell) {
             const OrbitSolution& solution = r.point.solution;
             solution.other_multipliers > 0 ? cell.real(solution.others_within) : cell.nothing();
         },
         [](const Context&, Record& r, CellReader& cell) {
             if (!cell.is_nothing())
                 r.point.solution.others_within = cell.number();
         }},
        {added(shown("slowest_approach")), // this from the segments again
         [](const Context&, const Record& r, CellWriter& cell) { cell.real(slowest_approach(r.point.solution)); }},
        truth_column(shown("admissible"), [](auto& r) { return &r.point.solution.certificate.admissible; }),
        word_column(shown("reason"), [](auto& r) { return &r.point.solution.certificate.reason; }),
        {{"outcome", ColumnType::text, ColumnUnit::none, true},
         [](const Context&, const Record& r, CellWriter& cell) { cell.text(name_of(r.point.solution.outcome)); },
         [](const Context&, Record& r, CellReader& cell) {
             r.point.solution.outcome =
                 enumerator_named(cell.text(), OrbitOutcome::undefined).value_or(OrbitOutcome::not_converged);
         }},
        word_column(shown("detail"), [](auto& r) { return &r.point.detail; }),
        real_column(shown("residual"), [](auto& r) { return &r.point.solution.residual; }),
        optional_column(added(shown("error")), [](auto& r) { return &r.point.solution.error; }),
        whole_column(kept("iterations"), [](auto& r) { return &r.point.solution.iterations; }),
        number_column(shown("arclength"), [](auto& r) { return &r.point.arclength; }),
        truth_column(shown("located"), [](auto& r) { return &r.point.located; }),
        real_column(shown("bracket_low", ColumnUnit::followed), [](auto& r) { return &r.point.bracket.first; }),
        real_column(shown("bracket_high", ColumnUnit::followed), [](auto& r) { return &r.point.bracket.second; }),
        {{"event", ColumnType::text},
         [](const Context& context, const Record& r, CellWriter& cell) {
             has_event(r) ? cell.text(context.model->events[r.point.event].name) : cell.nothing();
         },
         [](const Context& context, Record& r, CellReader& cell) {
             if (const auto event = context.model->find_event(cell.text()))
                 r.point.event = *event;
         }},
        only_if(has_event, position_column(kept("event_segment"), [](auto& r) { return &r.point.segment; })),
        only_if(has_event, number_column(kept("event_time", ColumnUnit::time), [](auto& r) { return &r.point.time; })),
        only_if(has_event, truth_column(kept("at_end"), [](auto& r) { return &r.point.at_end; })),
        {added({"touch_map", ColumnType::text, ColumnUnit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) { cell.word(r.touch ? r.touch->map : ""); },
         [](const Context&, Record& r, CellReader& cell) {
             if (!cell.is_nothing())
                 r.touch.emplace().map = cell.text();
         }},
        touch_text<&TouchFindings::verdict>("touch_verdict"),
        touch_text<&TouchFindings::reason>("touch_verdict_reason"),
        {added({"touch_next_contact", ColumnType::whole, ColumnUnit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) {
             r.touch&& r.touch->next_contact > 0 ? cell.whole(r.touch->next_contact) : cell.nothing();
         },
         [](const Context&, Record& r, CellReader& cell) {
             if (r.touch)
                 r.touch->next_contact = cell.whole();
         }},
        touch_number<&TouchFindings::projection>("touch_projection_1"),
        touch_number<&TouchFindings::growth>("touch_growth"),
        touch_number<&TouchFindings::jump_growth>("touch_jump_growth"),
        touch_number<&TouchFindings::reach>("touch_reach"),
        touch_number<&TouchFindings::clearance_rate>("touch_clearance_rate"),
        touch_number<&TouchFindings::speed_factor>("touch_speed_factor", "touch_first_speed"),
        touch_number<&TouchFindings::fold_distance>("touch_fold_distance"),
        {added(shown("rotation_number")),
         [](const Context&, const Record& r, CellWriter& cell) {
             r.torus ? cell.real(r.torus->rotation) : cell.nothing();
         },
         [](const Context&, Record& r, CellReader& cell) {
             if (!cell.is_nothing())
                 r.torus.emplace().rotation = cell.number();
         }},
        torus_number<&TorusRecord::growth>("torus_growth"),
        {added({"torus_harmonics", ColumnType::whole, ColumnUnit::none, true}),
         [](const Context&, const Record& r, CellWriter& cell) {
             r.torus ? cell.whole(r.torus->harmonics) : cell.nothing();
         },
         [](const Context&, Record& r, CellReader& cell) {
             if (r.torus)
                 r.torus->harmonics = cell.whole();
         }},
        torus_number<&TorusRecord::tail>("torus_tail"),
        {{"tangent", ColumnType::text}, // as JSON
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
        whole_column(kept("point"), [](auto& s) { return &s.point; }),
        whole_column(kept("segment"), [](auto& s) { return &s.number; }),
        text_column(kept("mode"), [](auto& s) { return &s.mode; }),
        text_column(kept("ending"), [](auto& s) { return &s.ending; }),
        real_column(kept("duration", ColumnUnit::time), [](auto& s) { return &s.duration; }),
        real_column(kept("approach_speed"), [](auto& s) { return &s.approach_speed; }),
        real_column(kept("departure"), [](auto& s) { return &s.departure; }),
        {{"guard_margin", ColumnType::real}, // missing if infinite: no other transition is possible
         [](const Context&, const Row& s, CellWriter& cell) { cell.real(s.guard_margin); },
         [](const Context&, Row& s, CellReader& cell) {
             s.guard_margin = cell.is_nothing() ? std::numeric_limits<double>::infinity() : cell.number();
         }},
        {{"start_", ColumnType::real, ColumnUnit::own, false, ColumnGroup::states},
         [](const Context&, const Row& s, CellWriter& cells) { cells.reals(s.start); },
         [](const Context& context, Row& s, CellReader& cells) { cells.reals(s.start, context.run->states.size()); }},
    };
    return columns;
}

namespace {

/// Of what has an event of the model.
template <class Row>
ColumnOf<Context, Row> event_column() {
    return {{"event", ColumnType::text},
            [](const Context& context, const Row& one, CellWriter& cell) {
                cell.text(context.model->events[one.event].name);
            },
            [](const Context& context, Row& one, CellReader& cell) {
                one.event = context.model->find_event(cell.text()).value_or(context.model->events.size());
            }};
}

} // namespace

const ColumnsOf<OrbitContext, OrbitMinimum>& minimum_columns() {
    static const ColumnsOf<OrbitContext, OrbitMinimum> columns{
        position_column(kept("segment"), [](auto& m) { return &m.segment; }),
        event_column<OrbitMinimum>(),
        number_column(kept("time", ColumnUnit::time), [](auto& m) { return &m.time; }),
        extended_column(kept("value"), [](auto& m) { return &m.value; }),
        number_column(kept("size"), [](auto& m) { return &m.size; }),
    };
    return columns;
}

const ColumnsOf<OrbitContext, EndValue>& end_value_columns() {
    static const ColumnsOf<OrbitContext, EndValue> columns{
        position_column(kept("segment"), [](auto& e) { return &e.segment; }),
        event_column<EndValue>(),
        extended_column(kept("value"), [](auto& e) { return &e.value; }),
        extended_column(kept("rate"), [](auto& e) { return &e.rate; }),
    };
    return columns;
}

const ColumnsOf<OrbitContext, CircleTerm>& circle_columns() {
    static const ColumnsOf<OrbitContext, CircleTerm> columns{
        whole_column(kept("harmonic"), [](auto& t) { return &t.harmonic; }),
        {{"state", ColumnType::text},
         [](const Context& context, const CircleTerm& term, CellWriter& cell) {
             cell.text(context.model->states[term.state].name);
         },
         [](const Context& context, CircleTerm& term, CellReader& cell) {
             term.state = context.model->find_state(cell.text()).value_or(context.model->states.size());
         }},
        number_column(kept("cosine"), [](auto& t) { return &t.even; }),
        number_column(kept("sine"), [](auto& t) { return &t.odd; }),
    };
    return columns;
}

} // namespace graze
