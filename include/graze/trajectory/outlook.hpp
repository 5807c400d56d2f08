#pragma once

#include "graze/tape/jet.hpp"
#include "graze/trajectory/simulation.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Where steps of the proposed lengths lead to, computed for all lanes of a jet at once: the states at their ends, and
/// bounds that show which watched events cannot happen within. Nearly all steps need no more than this.
class Outlook {
public:
    Outlook(const Simulation& simulation, int width);

    /// Proposed lengths, one for each lane: to be filled before `compute`.
    std::span<double> lengths() { return lengths_; }
    void compute(const Jet& jet, std::size_t mode);

    double length(std::size_t lane) const { return lengths_[lane]; }
    double state(std::size_t index, std::size_t lane) const { return states_[index * width_ + lane]; }
    /// Lower bound of the function of a watched event of the mode.
    double least(std::size_t watched, std::size_t lane) const { return least_[watched * width_ + lane]; }
    /// Size of its series: sum |c_k| length^k.
    double size(std::size_t watched, std::size_t lane) const { return sizes_[watched * width_ + lane]; }

private:
    const Simulation* simulation_;
    std::size_t width_;
    std::vector<double> lengths_, states_, least_, sizes_;
};

} // namespace graze
