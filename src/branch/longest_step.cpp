#include "branch/longest_step.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

bool is_straight(const ContinuationProblem& problem, const ContinuationPoint& from, const ContinuationPoint& to) {
    constexpr double little = 0.1, nothing = 1e-7; // share of the tangent; round-off of constant unknowns
    const auto scales = problem.scales(), weights = problem.weights();
    const double before = problem.length_of(from.tangent), after = problem.length_of(to.tangent);
    for (std::size_t i = 0; i < to.tangent.size(); ++i) {
        const double old = from.tangent[i] / (scales[i] * before), now = to.tangent[i] / (scales[i] * after);
        if ((weights.empty() || weights[i] > 0) && !(std::abs(now - old) <= little * std::abs(old) + nothing))
            return false;
    }
    return true;
}

} // namespace

double longest_step(const ContinuationProblem& problem, const ContinuationPoint& from, const ContinuationPoint& to,
                    double largest) {
    constexpr double most = 10;
    if (from.arclength == to.arclength || !is_straight(problem, from, to))
        return largest;
    const auto scales = problem.scales(), weights = problem.weights();
    double sum = 0;
    for (std::size_t i = 0; i < to.u.size(); ++i) {
        const double change = to.tangent[i] / std::max(scales[i], std::abs(to.u[i]));
        sum += change * change * (weights.empty() ? 1 : weights[i]);
    }
    const double factor = problem.length_of(to.tangent) / std::sqrt(sum);
    return largest * (std::isfinite(factor) ? std::clamp(factor, 1.0, most) : 1);
}

} // namespace graze
