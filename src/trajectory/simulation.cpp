#include "graze/trajectory/simulation.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/flow/step_size.hpp"

#include <fmt/format.h>

namespace graze {

void SimulationOptions::validate() const {
    if (!(tolerance >= smallest_tolerance && tolerance <= largest_tolerance))
        throw InputError(fmt::format("the tolerance {} is out of range", tolerance),
                         fmt::format("choose one from {} to {}", smallest_tolerance, largest_tolerance));
    if (order != 0)
        require_order(order);
    if (!(largest_step >= 0))
        throw InputError(fmt::format("the largest step {} is not a positive time", largest_step),
                         "give a positive time, or 0 for no bound");
    if (contacts_at_once < 1)
        throw InputError(fmt::format("{} events at one time are too few", contacts_at_once), "allow at least one");
    if (!(touch >= 0))
        throw InputError(fmt::format("the touch distance {} is negative", touch), "give 0 or a positive distance");
}

Simulation::Simulation(const System& system, std::vector<Probe> probes, const std::vector<Expression>& observed,
                       SimulationOptions options) {
    options.validate();
    std::vector<Expression> all;
    for (const Probe& probe : probes) {
        const bool phase = probe.kind == Probe::Kind::phase;
        if ((phase ? probe.value : probe.expression).empty())
            throw InputError(fmt::format("probe '{}' has no {}", probe.name, phase ? "value" : "expression"),
                             "say what is to be located");
        if (!phase)
            all.push_back(probe.expression);
        else if (require_index(probe.state, system.states(), "state"); !system.model().states[probe.state].period)
            throw InputError(fmt::format("probe '{}' is a phase, but state '{}' has no period", probe.name,
                                         system.model().states[probe.state].name),
                             "choose a cyclic state, or locate a crossing");
    }
    all.insert(all.end(), observed.begin(), observed.end());
    Parts parts{all.empty() ? system : system.observing(all), options, std::move(probes), {}, 0, options.order, {}};
    if (parts.order == 0)
        parts.order = order_for_tolerance(options.tolerance);
    std::vector<Expression> values;
    const Expression none = Graph::create()->number(0);
    for (const Probe& probe : parts.probes) {
        parts.series.push_back(parts.first_observed);
        if (probe.kind != Probe::Kind::phase)
            ++parts.first_observed;
        values.push_back(probe.kind == Probe::Kind::phase ? probe.value : none);
    }
    if (!values.empty())
        parts.phase_values = system.function_of_parameters(values);
    parts_ = std::make_shared<const Parts>(std::move(parts));
}

} // namespace graze
