#include "graze/branch/torus.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace graze {

std::vector<double> Torus::state_at(double turns) const {
    if (terms.empty())
        return {};
    std::vector<double> state = terms[0];
    for (std::size_t k = 1; k <= harmonics(); ++k) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(k) * turns, even = std::cos(angle),
                     odd = std::sin(angle);
        for (std::size_t i = 0; i < state.size(); ++i)
            state[i] += even * terms[2 * k - 1][i] + odd * terms[2 * k][i];
    }
    return state;
}

} // namespace graze
