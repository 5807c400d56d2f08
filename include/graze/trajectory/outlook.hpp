#pragma once

#include "graze/tape/jet.hpp"
#include "graze/trajectory/jet_set.hpp"
#include "graze/trajectory/simulation.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// What the lanes of a jet lead to, computed for all of them at once: the lengths of steps; where steps of given
/// lengths end, and whether the model agrees with the polynomials there (see StepCheck); and bounds that show which
/// watched events cannot happen within. Nearly all steps need no more than this.
class Outlook {
public:
    Outlook(const Simulation& simulation, int width);

    /// Lengths of the last steps, one for each lane: to be filled before `find_steps`, which replaces them.
    /// Then what `find_steps` has found: lengths to be looked at, to be adjusted before `look`.
    std::span<double> lengths() { return lengths_; }
    void find_steps(const Jet& jet);
    /// @param next jet of the same mode, lanes and parameters, which is begun at the ends
    void look(Jet& jet, Jet& next, std::size_t mode);
    /// The jets that it has looked at last, which are somebody else's: null before.
    Jet* jet() const { return jet_; }
    Jet* next() const { return next_; }

    // What follows is asked at every step, and unchecked: lanes below the width, what `look` has looked at.
    double length(std::size_t lane) const { return lengths_[lane]; }
    double state(std::size_t index, std::size_t lane) const { return states_[index * width_ + lane]; }
    /// Whether polynomials and model agree at the end of the step.
    bool agrees(std::size_t lane) const { return disagreement_[lane] <= 0; }
    /// Lower bound of the function of a watched event of the mode.
    double least(std::size_t watched, std::size_t lane) const { return least_[watched * width_ + lane]; }
    /// Size of its series: sum |c_k| length^k.
    double size(std::size_t watched, std::size_t lane) const { return sizes_[watched * width_ + lane]; }

private:
    void bound_events(const Jet& jet, std::size_t watched);

    Simulation simulation_;
    std::size_t width_;
    double log_tolerance_;
    Jet *jet_ = nullptr, *next_ = nullptr;
    EndAllowance allowance_;
    std::vector<double> lengths_, states_, slopes_, least_, sizes_, disagreement_;
    std::vector<double> powers_; ///< of the length of a single lane
};

} // namespace graze
