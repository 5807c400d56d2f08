#include "graze/sweep/attractor.hpp"

#include "base/enumerator_name.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "sweep/attractor_setting.hpp"

#include <fmt/format.h>

namespace graze {

std::string_view name_of(Label label) {
    constexpr std::string_view names[] = {"periodic",    "quasi-periodic", "chaotic",   "transient",
                                          "equilibrium", "unbounded",      "unsettled", "escaped",
                                          "singular",    "chattering",     "ended",     "failed"};
    return enumerator_name(names, label, "unsettled");
}

namespace {

[[noreturn]] void refuse(const std::string& problem, const std::string& remedy) {
    throw InputError(problem, remedy);
}

} // namespace

void validate_bounds(const Model& model, std::span<const StateBounds> bounds) {
    for (const StateBounds& bound : bounds) {
        require_index(bound.state, model.states.size(), "state");
        if (!(bound.least < bound.greatest))
            refuse("bounds of a state are not in order", "give the least value, then the greatest");
    }
}

void AttractorOptions::validate(const Model& model) const {
    if (section.empty())
        refuse("no section says what a return is", "name one that the model declares under [sections]");
    section_probe(model, section);
    if (cycles < 1 || cycles > most_cycles)
        refuse(fmt::format("{} cycles are out of range", cycles), "give 1 to 100 million");
    if (lyapunov_cycles > most_cycles)
        refuse(fmt::format("{} cycles of an exponent are out of range", lyapunov_cycles), "give up to 100 million");
    if (chaos_cycles > most_cycles)
        refuse(fmt::format("{} cycles of chaos are out of range", chaos_cycles), "give up to 100 million");
    if (keep < 1 || keep > most_kept)
        refuse(fmt::format("{} kept returns are out of range", keep), "give 1 to a million");
    if (largest_period < 1 || largest_period > most_returns)
        refuse(fmt::format("a largest period of {} returns is out of range", largest_period), "give 1 to 1000");
    if (!(recurrence > 0 && recurrence <= most_distance))
        refuse(fmt::format("a recurrence of {} is out of range", recurrence), "give more than 0, up to 0.1");
    if (!(disturbance >= 0 && disturbance <= most_distance))
        refuse(fmt::format("a disturbance of {} is out of range", disturbance), "give 0 to 0.1");
    if (!(longest_return >= 0))
        refuse("the longest time of a return is negative", "give a positive time, or 0 for no bound");
    validate_bounds(model, bounds);
}

void TransientOptions::validate(const Model& model) const {
    if (!(skip_time >= 0) || !(time >= 0))
        refuse("a time is negative", "give 0 or more");
    if ((skip_periods > 0 || periods > 0) && section.empty())
        refuse("nothing says what a period is", "name a section whose passages are counted");
    if (!section.empty())
        section_probe(model, section);
    for (const std::size_t event : counted)
        require_index(event, model.events.size(), "event that is counted");
    validate_bounds(model, bounds);
    if (!(greatest_speed >= 0))
        refuse("the greatest speed is negative", "give 0 for any, or a positive one");
    if (!(time > 0) && periods == 0 && contacts == 0 && !(greatest_speed > 0))
        refuse("nothing ends the simulation", "give a time, a number of periods or of contacts");
}

AttractorSetting::AttractorSetting(const System& system, const AttractorOptions& given,
                                   const std::vector<Sampling>& samplings, const std::vector<Expression>& values,
                                   const SimulationOptions& simulation_options)
    : options((given.validate(system.model()), given)), layout(system, samplings, values),
      simulation(system, layout.probes(system.model(), options.section), {}, simulation_options),
      map(simulation, simulation.probes().size() - 1), field(system), variational(map) {
    const Model& model = system.model();
    if (model.symmetries.empty())
        return;
    image = system.symmetry(0).map;
    image_modes = model.symmetries.front().modes;
}

} // namespace graze
