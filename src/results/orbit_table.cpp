#include "graze/results/orbit_table.hpp"

#include "base/special_numbers.hpp"

#include <cstddef>

namespace graze {

Table orbit_table(const Model& model, const std::vector<SegmentMotion>& motion,
                  const std::vector<NamedValue>& quantities) {
    StateColumns states(model, quantities);
    Table table(states.after({{"segment", ""}, {"mode", ""}, {"end", ""}, {"t", model.time_unit}}));
    for (std::size_t s = 0; s < motion.size(); ++s)
        for (std::size_t i = 0; i < motion[s].times.size(); ++i) {
            table.add(s + 1, model.modes[motion[s].mode].name, motion[s].end, motion[s].times[i]);
            states.add(table, motion[s].states[i]);
        }
    return table;
}

Table segment_table(const Model& model, const OrbitSolution& solution) {
    const Certificate& certificate = solution.certificate;
    const auto at = [](const std::vector<double>& values, std::size_t s) {
        return s < values.size() ? values[s] : not_a_number;
    };
    Table table{{"segment", ""},        {"end", ""},       {"duration", model.time_unit},
                {"approach_speed", ""}, {"departure", ""}, {"guard_margin", ""}};
    for (std::size_t s = 0; s < solution.orbit.segments(); ++s)
        table.add(s + 1, end_name(model, solution.orbit.signature[s]), solution.orbit.durations[s],
                  at(certificate.approach_speeds, s), at(certificate.departures, s), at(certificate.guard_margins, s));
    return table;
}

Table minimum_table(const Model& model, const OrbitSolution& solution) {
    Table table{{"segment", ""}, {"event", ""}, {"time", model.time_unit}, {"value", ""}, {"size", ""}};
    for (const OrbitMinimum& one : solution.certificate.minima)
        table.add(one.segment + 1, model.events[one.event].name, one.time, one.value, one.size);
    return table;
}

Table end_value_table(const Model& model, const OrbitSolution& solution) {
    Table table{{"segment", ""}, {"event", ""}, {"value", ""}, {"rate", ""}};
    for (const EndValue& one : solution.certificate.end_values)
        table.add(one.segment + 1, model.events[one.event].name, one.value, one.rate);
    return table;
}

} // namespace graze
