#pragma once

#include "orbit/orbit_equations.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// The equations of an orbit by multiple shooting: pieces are integrated by Taylor series, to the simulation's
/// tolerance.
class Shooting : public OrbitEquations {
public:
    /// @param simulation of the orbit's model, with the tolerance of the integration
    /// @param parameters that are unknowns of the equations
    /// @param ranges lengths of the intervals in which the free parameters vary; 0 where unknown
    /// @throws InputError when the orbit does not fit the model
    Shooting(const Simulation& simulation, const Orbit& orbit, std::vector<ParameterId> free,
             std::vector<double> ranges = {});

private:
    std::vector<std::size_t> split(const Orbit& orbit);
    bool run_recorded(std::size_t mode, std::span<double> state, double duration, Eigen::MatrixXd& derivatives,
                      StateScales& sizes);
    void note_contacts(std::size_t segment, StateScales& sizes);
    void note_jump(std::size_t segment, const std::vector<double>& end);
    bool follow(std::size_t piece, const Eigen::VectorXd& unknowns, OrbitEvaluation& at) override;
};

} // namespace graze
