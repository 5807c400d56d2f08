#pragma once

#include "graze/orbit/orbit.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// A torus of quasi-periodic motion, by the circle in which it is met by the surface on which the first segment of its
/// motion begins. The return to that surface turns the circle by the rotation number:
///
///     return(state_at(turns)) = state_at(turns + rotation).
struct Torus {
    std::vector<double> parameters; ///< the independent parameters, in the model's order
    double rotation = 0;            ///< rotation number, in turns per return
    /// Fourier series of the states around the circle: the mean, then for k = 1, 2, ... the factors of cos(2 pi k
    /// turns), and those of sin(2 pi k turns).
    std::vector<std::vector<double>> terms;

    std::size_t harmonics() const { return terms.size() / 2; }
    std::vector<double> state_at(double turns) const;
};

/// What is known of a torus besides itself.
struct TorusFacts {
    double tail = 0; ///< largest of the last two harmonics, relative to the largest of all
    double defect =
        0; ///< largest error of the equation between the angles at which it is solved, in the states' scales
    /// Mean factor per return by which the slowest deviation from the torus, away from it, grows or decays.
    double growth = 0;
    bool admissible = true; ///< whether the model would follow the motion from all angles that were looked at
    std::string reason;     ///< why not
    /// For each segment of the motion, the least speed with which it comes to its end.
    std::vector<double> approach_speeds;
};

/// A rotation number of few returns: numerator / denominator turns per return.
struct Resonance {
    static constexpr std::size_t largest_strong = 4;
    static constexpr std::size_t largest = 12; ///< denominator of those that branches of tori look at
    long numerator = 0;
    std::size_t denominator = 1;
    /// True for those near which there may be no torus even where it is small.
    bool is_strong() const { return denominator <= largest_strong; }
    double value() const { return static_cast<double>(numerator) / static_cast<double>(denominator); }
    bool operator==(const Resonance&) const = default;
};

} // namespace graze
