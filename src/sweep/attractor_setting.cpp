#include "sweep/attractor_setting.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

namespace graze {

namespace {

std::vector<Probe> probes_of(const Model& model, const AttractorOptions& options,
                             const SampleRecorder::Layout& layout) {
    std::vector<Probe> probes = layout.probes();
    // The section's probe is last, since it ends trajectories: simultaneous passages must be reported before.
    probes.push_back(section_probe(model, options.section));
    return probes;
}

[[noreturn]] void refuse(const std::string& problem, const std::string& remedy) {
    throw InputError(problem, remedy);
}

} // namespace

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

AttractorSetting::AttractorSetting(const System& system, const AttractorOptions& given,
                                   const std::vector<Sampling>& samplings, const std::vector<Expression>& values,
                                   const SimulationOptions& simulation_options)
    : options((given.validate(system.model()), given)), layout(system, samplings, values),
      simulation(system, probes_of(system.model(), options, layout), {}, simulation_options),
      map(simulation, simulation.probes().size() - 1), field(system), variational(map) {
    const Model& model = system.model();
    if (model.symmetries.empty())
        return;
    image = system.symmetry(0).map;
    image_modes = model.symmetries.front().modes;
}

} // namespace graze
