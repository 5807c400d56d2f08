#include "graze/trajectory/step_preview.hpp"

#include "graze/base/input_error.hpp"
#include "graze/flow/roots.hpp"
#include "graze/flow/step_check.hpp"
#include "graze/flow/step_size.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace graze {

namespace {

/// For at most this many events the tighter bounds are as fast as any.
constexpr std::size_t few_events = 2;

/// Number of terms that are summed side by side.
constexpr std::size_t block = 4;

using Block = std::array<double, block>;

/// Returns the sum of |c_k| weights_k over whole blocks, and over the last coefficients with separate weights, which
/// are 0 where the last block overlaps the one before.
double sum_of_sizes(std::span<const double> c, const double* weights, const Block& last_weights) {
    double part[block] = {};
    const double *all = c.data(), *last = all + c.size() - block;
    for (std::size_t k = 0; k + block <= c.size(); k += block)
        for (std::size_t j = 0; j < block; ++j)
            part[j] += std::abs(all[k + j]) * weights[k + j];
    for (std::size_t j = 0; j < block; ++j)
        part[j] += std::abs(last[j]) * last_weights[j];
    return (part[0] + part[1]) + (part[2] + part[3]);
}

} // namespace

StepPreview::StepPreview(const Simulation& simulation, int width)
    : simulation_(simulation), width_(static_cast<std::size_t>(std::max(width, 1))),
      log_tolerance_(StepSize(simulation.order(), simulation.options().tolerance).log_tolerance()),
      allowance_{StepCheck::allowance * simulation.options().tolerance,
                 StepCheck::value_allowance * simulation.options().tolerance, StepCheck::smallest_size},
      lengths_(width_), states_(simulation.system().states() * width_), slopes_(states_.size()), disagreement_(width_) {
    if (width < 1)
        throw InputError("a preview needs at least one lane", "");
    std::size_t most_watched = 0;
    for (std::size_t mode = 0; mode < simulation.model().modes.size(); ++mode)
        most_watched = std::max(most_watched, simulation.system().mode(mode).watched.size());
    least_.resize(most_watched * width_);
    sizes_.resize(most_watched * width_);
    powers_.resize(static_cast<std::size_t>(simulation.order()) + 1);
}

void StepPreview::find_steps(const Jet& jet) {
    jet.find_steps(log_tolerance_, lengths_, lengths_);
}

void StepPreview::evaluate_ends(Jet& jet, Jet& next, std::size_t mode) {
    jet_ = &jet;
    next_ = &next;
    jet.evaluate_states(lengths_, states_, slopes_);
    const std::size_t watched = simulation_.system().mode(mode).watched.size(), bounds = watched * width_;
    if (width_ == 1 && watched > few_events)
        bound_events(jet, watched);
    else if (watched > 0)
        jet.bound_outputs(lengths_, std::span(least_).first(bounds), std::span(sizes_).first(bounds));
    next.begin(states_);
    jet.find_disagreement(next, allowance_, lengths_, states_, slopes_, disagreement_);
}

/// The same bounds for a single lane. Most of many events are far away: then the sizes of terms without signs are
/// enough; the others get the tighter bounds. Both include the round-off of terms and sums: see RootFinder::enclosure.
void StepPreview::bound_events(const Jet& jet, std::size_t watched) {
    const std::size_t size = powers_.size();
    const double length = lengths_[0], share = 0x1p-53 * static_cast<double>(2 * size + 8);
    double power = length;
    powers_[0] = 0; // the first coefficient is used with its sign
    for (std::size_t k = 1; k < size; ++k, power *= length)
        powers_[k] = power;
    Block last_powers{};
    for (std::size_t k = size / block * block; k < size && size > block; ++k)
        last_powers[k + block - size] = powers_[k];
    const std::span<const Series> events = jet.series().subspan(simulation_.system().states(), watched);
    for (std::size_t w = 0; w < watched; ++w) {
        const std::span<const double> c{events[w].first, size};
        if (size > block) {
            const double rest = sum_of_sizes(c, powers_.data(), last_powers);
            sizes_[w] = std::abs(c[0]) + rest;
            least_[w] = c[0] - rest - share * sizes_[w];
            if (least_[w] > 0)
                continue;
        }
        const auto [least, sum] = RootFinder::enclosure(c, length, RootStart::as_is);
        least_[w] = least;
        sizes_[w] = sum;
    }
}

} // namespace graze
