#include "orbit/family.hpp"

#include <Eigen/Core>

namespace graze {

namespace {

double largest(const Eigen::VectorXd& step, const Eigen::VectorXd& scales) {
    return step.cwiseQuotient(scales).cwiseAbs().maxCoeff();
}

} // namespace

bool is_in_family(Shooting& equations, const OrbitEvaluation& at) {
    constexpr double distance = 1e-2,
                     // Displacement in units of the scales; share of it that must remain after the corrections.
        kept_share = 0.5;
    constexpr double solved = 1e-11;
    constexpr int iterations = 8;
    const Eigen::MatrixXd no_borders(0, static_cast<Eigen::Index>(at.system.unknowns()));
    Eigen::VectorXd direction; // null vector in units of the scales
    if (at.system.undetermined() == 0 || !at.system.null_vector(no_borders, direction))
        return false;
    const double length = direction.cwiseAbs().maxCoeff();
    Eigen::VectorXd unknowns = at.unknowns + distance / length * direction.cwiseProduct(at.scales), step;
    OrbitEvaluation there = equations.evaluation();
    std::size_t deficiency = at.system.undetermined();
    for (int i = 0; i < iterations; ++i) {
        if (!equations.evaluate(unknowns, there))
            return false;
        if (there.residual < solved)
            return there.system.undetermined() > 0 &&
                   largest(unknowns - at.unknowns, at.scales) > kept_share * distance;
        if (!equations.solve_nearest(there, step, deficiency))
            return false;
        unknowns += step;
    }
    return false;
}

} // namespace graze
