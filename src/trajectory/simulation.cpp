#include "graze/trajectory/simulation.hpp"

#include "graze/flow/step_size.hpp"
#include "graze/symbolic/input_error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

void SimulationOptions::validate() const {
    if (!(tolerance >= smallest_tolerance && tolerance <= largest_tolerance))
        throw InputError(fmt::format("the tolerance {} is out of range", tolerance),
                         fmt::format("choose one from {} to {}", smallest_tolerance, largest_tolerance));
    if (order != 0 && (order < 4 || order > highest_order))
        throw InputError(fmt::format("the order {} is out of range", order),
                         fmt::format("choose 4 to {}, or 0 to let the tolerance decide", highest_order));
    if (!(largest_step >= 0))
        throw InputError(fmt::format("the largest step {} is not a positive time", largest_step),
                         "give a positive time, or 0 for no bound");
    if (contacts_at_once < 1)
        throw InputError(fmt::format("{} events at one time are too few", contacts_at_once), "allow at least one");
    if (!(touch >= 0))
        throw InputError(fmt::format("the touch distance {} is negative", touch), "give 0 or a positive distance");
}

namespace {

SimulationOptions validated(SimulationOptions options) {
    options.validate();
    return options;
}

std::vector<Expression> all_observed(const std::vector<Probe>& probes, const std::vector<Expression>& observed) {
    std::vector<Expression> all;
    for (const Probe& probe : probes)
        if (probe.kind != Probe::Kind::phase)
            all.push_back(probe.expression);
    all.insert(all.end(), observed.begin(), observed.end());
    return all;
}

} // namespace

Simulation::Simulation(const Model& model, std::vector<Probe> probes, const std::vector<Expression>& observed,
                       SimulationOptions options)
    : options_(validated(options)), probes_(std::move(probes)),
      order_(options.order != 0 ? options.order : order_for_tolerance(options.tolerance)),
      compiled_(model, all_observed(probes_, observed)) {
    std::vector<Expression> values;
    for (const Probe& probe : probes_) {
        series_.push_back(first_observed_);
        if (probe.kind != Probe::Kind::phase)
            ++first_observed_;
        values.push_back(probe.kind == Probe::Kind::phase ? probe.value : model.graph->number(0));
    }
    const Model& own = compiled_.model();
    phase_values_ = Function(own.parameter_symbols(), own.expand(values));
}

} // namespace graze
