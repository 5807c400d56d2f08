#include "graze/trajectory/outlook.hpp"

#include "graze/flow/step_check.hpp"
#include "graze/flow/step_size.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

Outlook::Outlook(const Simulation& simulation, int width)
    : simulation_(&simulation), width_(static_cast<std::size_t>(width)),
      log_tolerance_(StepSize(simulation.order(), simulation.options().tolerance).log_tolerance()),
      tolerance_(simulation.options().tolerance), lengths_(width_), states_(simulation.compiled().states() * width_),
      slopes_(states_.size()), disagreement_(width_) {
    std::size_t most_watched = 0;
    for (std::size_t mode = 0; mode < simulation.model().modes.size(); ++mode)
        most_watched = std::max(most_watched, simulation.compiled().mode(mode).watched.size());
    least_.resize(most_watched * width_);
    sizes_.resize(most_watched * width_);
    ends_.resize(most_watched * width_);
}

void Outlook::find_steps(const Jet& jet) {
    jet.find_steps(log_tolerance_, lengths_, lengths_);
    if (std::all_of(lengths_.begin(), lengths_.end(), [](double length) { return std::isfinite(length); }))
        return jet.guard_steps(lengths_);
    // Where nothing limits a step, or nothing is finite, the trajectory decides.
    std::vector<double>& guarded = disagreement_;
    for (std::size_t l = 0; l < width_; ++l)
        guarded[l] = std::isfinite(lengths_[l]) ? lengths_[l] : 0;
    jet.guard_steps(guarded);
    for (std::size_t l = 0; l < width_; ++l)
        lengths_[l] = std::isfinite(lengths_[l]) ? guarded[l] : lengths_[l];
}

void Outlook::look(const Jet& jet, Jet& end_jet, std::size_t mode) {
    jet.evaluate_states(lengths_, states_, slopes_);
    for (std::size_t w = 0; w < simulation_->compiled().mode(mode).watched.size(); ++w)
        jet.bound_output(w, lengths_, std::span(least_).subspan(w * width_, width_),
                         std::span(sizes_).subspan(w * width_, width_), std::span(ends_).subspan(w * width_, width_));
    end_jet.compute_values(states_);
    const std::size_t states = simulation_->compiled().states();
    const std::size_t watched = simulation_->compiled().mode(mode).watched.size();
    EndCheck check;
    check.states = states;
    check.outputs = watched;
    check.series = jet.series().data();
    check.truth = end_jet.series().data();
    check.values = states_.data();
    check.slopes = slopes_.data();
    check.ends = ends_.data();
    check.sizes = sizes_.data();
    check.rate_allowance = StepCheck::allowance * tolerance_;
    check.value_allowance = StepCheck::value_allowance * tolerance_;
    check.smallest = StepCheck::smallest_size;
    jet.find_disagreement(check, lengths_, disagreement_);
    if (simulation_->compiled().observed() > 0)
        compare_observed(check);
}

/// Sections and observed quantities are few.
void Outlook::compare_observed(EndCheck check) {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const auto terms = static_cast<std::size_t>(simulation_->order()) + 1;
    const std::size_t first = check.states + check.outputs;
    for (std::size_t o = first; o < first + simulation_->compiled().observed(); ++o)
        for (std::size_t l = 0; l < width_; ++l) {
            const double* c = check.series[o].first + l;
            const double h = lengths_[l];
            double value = 0, sum = 0;
            for (std::size_t k = terms; k-- > 0;) {
                value = value * h + c[k * width_];
                sum = sum * h + std::abs(c[k * width_]);
            }
            const double size = std::abs(c[0]) + h * (std::abs(c[width_]) + h * std::abs(c[2 * width_]));
            note(l, std::abs(value - check.truth[o].first[l]) - (check.value_allowance * size + 8 * epsilon * sum));
        }
}

} // namespace graze
