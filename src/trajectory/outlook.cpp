#include "graze/trajectory/outlook.hpp"

#include "graze/flow/step_check.hpp"
#include "graze/flow/step_size.hpp"

#include <algorithm>
#include <stdexcept>

namespace graze {

Outlook::Outlook(const Simulation& simulation, int width)
    : simulation_(simulation), width_(static_cast<std::size_t>(std::max(width, 1))),
      log_tolerance_(StepSize(simulation.order(), simulation.options().tolerance).log_tolerance()),
      allowance_{StepCheck::allowance * simulation.options().tolerance,
                 StepCheck::value_allowance * simulation.options().tolerance, StepCheck::smallest_size},
      lengths_(width_), states_(simulation.system().states() * width_), slopes_(states_.size()), disagreement_(width_) {
    if (width < 1)
        throw std::invalid_argument("an outlook needs at least one lane");
    std::size_t most_watched = 0;
    for (std::size_t mode = 0; mode < simulation.model().modes.size(); ++mode)
        most_watched = std::max(most_watched, simulation.system().mode(mode).watched.size());
    least_.resize(most_watched * width_);
    sizes_.resize(most_watched * width_);
}

void Outlook::find_steps(const Jet& jet) {
    jet.find_steps(log_tolerance_, lengths_, lengths_);
}

void Outlook::look(const Jet& jet, Jet& next, std::size_t mode) {
    jet.evaluate_states(lengths_, states_, slopes_);
    const std::size_t bounds = simulation_.system().mode(mode).watched.size() * width_;
    jet.bound_outputs(lengths_, std::span(least_).first(bounds), std::span(sizes_).first(bounds));
    next.begin(states_);
    jet.find_disagreement(next, allowance_, lengths_, states_, slopes_, disagreement_);
}

} // namespace graze
