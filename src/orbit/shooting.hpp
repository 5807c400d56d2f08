#pragma once

#include "orbit/orbit_equations.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// The equations of an orbit by multiple shooting: pieces are integrated by Taylor series, to the simulation's
/// tolerance.
class Shooting : public OrbitEquations {
public:
    /// @param simulation whose model the orbit belongs to
    /// @param free parameters that are unknown
    /// @param ranges in which they are looked at, where that is known; 0 where it is not
    /// @throws InputError when the orbit does not fit the model
    Shooting(const Simulation& simulation, const Orbit& orbit, std::vector<ParameterId> free,
             std::vector<double> ranges = {});

private:
    std::vector<std::size_t> split(const Orbit& orbit);
    bool run_noting(std::size_t mode, std::span<double> state, double duration, Eigen::MatrixXd& derivatives,
                    StateScales& sizes);
    void note_jump(std::size_t segment, const std::vector<double>& end);
    bool follow(std::size_t piece, const Eigen::VectorXd& unknowns, OrbitEvaluation& at) override;
};

} // namespace graze
