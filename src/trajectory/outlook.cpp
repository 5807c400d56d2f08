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
    jet.find_disagreement(end_jet, lengths_, states_, slopes_, StepCheck::allowance * tolerance_,
                          StepCheck::smallest_size, disagreement_);
    compare_values(jet, end_jet, mode);
}

void Outlook::compare_values(const Jet& jet, const Jet& end_jet, std::size_t mode) {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const double allowed = StepCheck::value_allowance * tolerance_;
    const std::span<const Series> series = jet.series().subspan(simulation_->compiled().states());
    const std::span<const Series> truth = end_jet.series().subspan(simulation_->compiled().states());
    const auto compare = [&](std::size_t output, std::size_t l, double value, double sum) {
        const double* c = series[output].first + l;
        const double h = lengths_[l];
        const double size = std::abs(c[0]) + h * (std::abs(c[width_]) + h * std::abs(c[2 * width_]));
        note(l, std::abs(value - truth[output].first[l]) - (allowed * size + 8 * epsilon * sum));
    };
    const std::size_t watched = simulation_->compiled().mode(mode).watched.size();
    for (std::size_t w = 0; w < watched; ++w)
        for (std::size_t l = 0; l < width_; ++l)
            compare(w, l, ends_[w * width_ + l], sizes_[w * width_ + l]);
    // Sections and observed quantities are few.
    for (std::size_t o = watched; o < watched + simulation_->compiled().observed(); ++o)
        for (std::size_t l = 0; l < width_; ++l) {
            const double* c = series[o].first;
            double value = 0, sum = 0;
            for (auto k = static_cast<std::size_t>(jet.order()) + 1; k-- > 0;) {
                value = value * lengths_[l] + c[k * width_ + l];
                sum = sum * lengths_[l] + std::abs(c[k * width_ + l]);
            }
            compare(o, l, value, sum);
        }
}

} // namespace graze
