#pragma once

#include "graze/branch/monitor.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// Evaluates monitors at equilibria, which have no extent: all values of an expression are those of its state.
class EquilibriumMonitors {
public:
    EquilibriumMonitors(const System& system, std::vector<Monitor> monitors);

    /// One value per monitor; 0 for durations, NaN for multipliers.
    std::vector<double> operator()(const Orbit& orbit) const;
    /// Value of a monitor's expression in a mode, then its derivatives with respect to states and parameters.
    const Function& function(std::size_t monitor, std::size_t mode) const {
        const std::vector<Function>& own = functions_[monitor];
        return own[own.size() > 1 ? mode : 0];
    }

private:
    std::vector<Monitor> monitors_;
    std::vector<std::vector<Function>> functions_; ///< of each: one, or one a mode; none for durations and multipliers
};

} // namespace graze
