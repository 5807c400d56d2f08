#include "graze/trajectory/outlook.hpp"

#include "graze/flow/step_size.hpp"

#include <algorithm>

namespace graze {

Outlook::Outlook(const Simulation& simulation, int width)
    : simulation_(&simulation), width_(static_cast<std::size_t>(width)),
      log_tolerance_(StepSize(simulation.order(), simulation.options().tolerance).log_tolerance()), lengths_(width_),
      states_(simulation.compiled().states() * width_) {
    std::size_t most_watched = 0;
    for (std::size_t mode = 0; mode < simulation.model().modes.size(); ++mode)
        most_watched = std::max(most_watched, simulation.compiled().mode(mode).watched.size());
    least_.resize(most_watched * width_);
    sizes_.resize(most_watched * width_);
}

void Outlook::find_steps(const Jet& jet) {
    jet.find_steps(log_tolerance_, lengths_, lengths_);
}

void Outlook::look(const Jet& jet, std::size_t mode) {
    jet.evaluate_states(lengths_, states_);
    for (std::size_t w = 0; w < simulation_->compiled().mode(mode).watched.size(); ++w)
        jet.bound_output(w, lengths_, std::span(least_).subspan(w * width_, width_),
                         std::span(sizes_).subspan(w * width_, width_));
}

} // namespace graze
