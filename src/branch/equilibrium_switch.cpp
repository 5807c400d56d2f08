#include "branch/equilibrium_switch.hpp"

#include "base/decompositions.hpp"
#include "branch/equilibrium_tests.hpp"
#include "graze/base/input_error.hpp"
#include "orbit/eigen_index.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// The direction of the other branch through a branch point, in scaled unknowns, and the distance over which it is
/// nearly straight.
struct OtherDirection {
    Eigen::VectorXd direction;
    double length = 1;
};

OtherDirection other_direction(const EquilibriumEvaluation& at, const EquilibriumThirdDerivatives& third,
                               const Eigen::VectorXd& tangent) {
    const Eigen::Index n = at.size();
    const SingularValues parts = singular_values(at.jacobian, SingularVectors::full);
    const Eigen::MatrixXd plane = parts.right.rightCols(2); // of directions that solve the equations to first order
    const Eigen::VectorXd left = parts.left.col(n - 1);
    const Eigen::VectorXd own = (plane * (plane.transpose() * tangent)).normalized();
    Eigen::VectorXd across = plane.col(0) - own * own.dot(plane.col(0));
    if (const Eigen::VectorXd second = plane.col(1) - own * own.dot(plane.col(1)); second.norm() > across.norm())
        across = second;
    across.normalize();
    // Quadratic form of the branches: own is one of its null directions.
    const Eigen::MatrixXd along = at.second(across);
    const double mixed = left.dot(along * own), pure = left.dot(along * across);
    OtherDirection other;
    other.direction = mixed != 0 ? Eigen::VectorXd(across - pure / (2 * mixed) * own) : across;
    other.direction.normalize();
    const Eigen::VectorXd states = other.direction.head(n), sizes = at.scales.head(n);
    const double linear = at.jacobian.norm(), quadratic = (at.second(other.direction) * other.direction).norm(),
                 cubic = (third(at.state, at.parameters, states.cwiseProduct(sizes), states.cwiseProduct(sizes)) *
                          states.cwiseProduct(sizes))
                             .cwiseQuotient(sizes)
                             .norm();
    other.length = std::min(quadratic > 0 ? linear / quadratic : 1, cubic > 0 ? std::sqrt(linear / cubic) : 1);
    return other;
}

} // namespace

std::vector<BranchStart> equilibria_at_branch_point(const System& system, const SpecialPoint& point,
                                                    const BranchSettings& settings) {
    constexpr double first = 0.02;
    constexpr int most = 8;
    BranchSettings plain = settings;
    plain.monitors.clear();
    plain.free.clear();
    plain.free_bounds.clear();
    const EquilibriumProblem problem(system, point.solution.orbit, plain);
    const std::vector<double> u = problem.unknowns_of(point.solution.orbit);
    EquilibriumEvaluation at;
    problem.describe(u, at);
    const Eigen::VectorXd tangent = vector_of(problem.unknowns_of(point.tangent)).cwiseQuotient(at.scales);
    const OtherDirection other =
        other_direction(at, EquilibriumThirdDerivatives(problem.equations()), tangent.normalized());
    std::vector<BranchStart> starts;
    for (const double sign : {1.0, -1.0}) {
        double distance = first * std::min(1.0, other.length);
        for (int attempt = 0; attempt < most; ++attempt, distance *= 0.25) {
            const Eigen::VectorXd step = sign * distance * other.direction.cwiseProduct(at.scales);
            std::vector<double> beside = u;
            entries_of(beside) += step;
            // Solved in the scales of the small displacement, with its largest component held.
            auto near = std::make_shared<EquilibriumProblem>(system, problem.orbit_of(beside), plain);
            Continuation continuation(near, settings.continuation);
            Eigen::Index largest = 0;
            const Eigen::VectorXd states = other.direction.head(at.size());
            states.cwiseAbs().maxCoeff(&largest);
            if (!continuation.start(near->unknowns_of(problem.orbit_of(beside)), static_cast<std::size_t>(largest),
                                    step[largest] > 0 ? 1 : -1))
                continue;
            const double moved =
                continuation.point().u[static_cast<std::size_t>(largest)] - u[static_cast<std::size_t>(largest)];
            if (!(std::abs(moved - step[largest]) < 0.1 * std::abs(step[largest])))
                continue;
            starts.push_back({near->orbit_of(continuation.point().u), near->direction_of(continuation.point().tangent),
                              0, sign > 0 ? "other, forward" : "other, backward"});
            break;
        }
    }
    if (starts.empty())
        throw InputError("the other branch of equilibria at this point was not found", "begin on it from a state");
    return starts;
}

} // namespace graze
