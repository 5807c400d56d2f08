#include "branch/turning_pair.hpp"

#include "base/decompositions.hpp"
#include "graze/base/input_error.hpp"

#include <cmath>
#include <optional>

namespace graze {

TurningPair turning_pair(const Eigen::MatrixXd& derivatives) {
    constexpr double near = 1e-3, real = 1e-6; // located points are far more accurate
    const auto system = eigensystem(derivatives);
    std::optional<Eigen::Index> nearest;
    for (Eigen::Index i = 0; system && i < system->values.size(); ++i) {
        const auto off = [&](Eigen::Index k) { return std::abs(std::abs(system->values[k]) - 1); };
        if (system->values[i].imag() > real && (!nearest || off(i) < off(*nearest)))
            nearest = i;
    }
    if (!nearest || !(std::abs(std::abs(system->values[*nearest]) - 1) < near))
        throw InputError("the orbit has no complex pair of multipliers on the unit circle",
                         "start from a torus point (NS) of a branch of orbits");
    return {system->values[*nearest], system->vectors.col(*nearest)};
}

} // namespace graze
