#pragma once

#include "graze/tape/jet.hpp"
#include "graze/trajectory/jet_set.hpp"
#include "graze/trajectory/simulation.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Evaluates the next steps of all lanes of a jet at once: the lengths of steps; the states at the ends of steps of
/// given lengths, and whether the model agrees with the polynomials there (see graze/flow/step_check.hpp); and bounds
/// that exclude watched events within the steps. In nearly all steps the bounds exclude all events, and a trajectory
/// needs nothing else.
class StepPreview {
public:
    StepPreview(const Simulation& simulation, int width);

    /// Lengths of the last steps, one for each lane, to be set before `find_steps`, which replaces them by the lengths
    /// found. The caller may shorten them before `evaluate_ends`.
    std::span<double> lengths() { return lengths_; }
    void find_steps(const Jet& jet);
    /// Evaluates the ends of the steps. @param next another jet of the same mode, lanes and
    /// parameters, whose series then begin at these ends
    void evaluate_ends(Jet& jet, Jet& next, std::size_t mode);
    /// The jets of the last `evaluate_ends`, which belong to the caller; null before.
    Jet* jet() const { return jet_; }
    Jet* next() const { return next_; }

    // The following functions are called at every step and unchecked: lane < width, after `evaluate_ends`.
    double length(std::size_t lane) const { return lengths_[lane]; }
    double state(std::size_t index, std::size_t lane) const { return states_[index * width_ + lane]; }
    /// True when polynomials and model agree at the end of the step.
    bool agrees(std::size_t lane) const { return disagreement_[lane] <= 0; }
    /// Lower bound of a watched event's function over the step.
    double least(std::size_t watched, std::size_t lane) const { return least_[watched * width_ + lane]; }
    /// Size of the function's series: sum |c_k| length^k.
    double size(std::size_t watched, std::size_t lane) const { return sizes_[watched * width_ + lane]; }

private:
    void bound_events(const Jet& jet, std::size_t watched);

    Simulation simulation_;
    std::size_t width_;
    double log_tolerance_;
    Jet *jet_ = nullptr, *next_ = nullptr;
    EndAllowance allowance_;
    std::vector<double> lengths_, states_, slopes_, least_, sizes_, disagreement_;
    std::vector<double> powers_; ///< powers of the step length of a single lane
};

} // namespace graze
