#include "branch/other_branch.hpp"

#include "branch/orbit_quantity.hpp"
#include "branch/point_rules.hpp"
#include "graze/base/input_error.hpp"
#include "orbit/newton.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace graze {

namespace {

/// Scaled distance of the first point on another branch.
constexpr double first_distance = 1e-2;
/// Distances that are tried, in units of the given one.
constexpr double factors_of_distance[] = {1, 0.1, 4, 0.01};
/// Half orders of magnitude that are tried for states that leave zero: 15 decades below and above the other states.
constexpr int half_decades = 30;

/// Returns 1 for the unknowns whose scales are their own size, 0 for others.
Eigen::VectorXd sized_unknowns(const OrbitEquations& equations) {
    const OrbitLayout& layout = equations.layout();
    Eigen::VectorXd result = Eigen::VectorXd::Ones(index(layout.unknowns()));
    for (std::size_t i = 0; i < layout.states(); ++i) {
        for (std::size_t k = 0; k < layout.pieces(); ++k)
            result[index(layout.start_of(k) + i)] = equations.has_size(i) ? 1 : 0;
        for (std::size_t j = i; j < layout.pieces() * layout.inner(); j += layout.states())
            result[index(layout.inner_of(0) + j)] = equations.has_size(i) ? 1 : 0;
    }
    return result;
}

/// Returns the parameter that unfolds a family, if the branch is one.
std::optional<ParameterId> unfolding_of(const Model& model, const BranchSettings& settings) {
    if (settings.unfolded == 0)
        return std::nullopt;
    return model.independent_parameter(model.independent_parameters().back());
}

/// Returns the change of a family's coordinate with the unknowns: zero on the direction in which orbits of another kind
/// leave the family, but not along the family itself.
Eigen::RowVectorXd rise_along_family(const OrbitProblem& problem, const BranchSettings& settings) {
    const Monitor& coordinate = settings.monitors.back();
    const std::optional<std::size_t> first =
        coordinate.kind == Monitor::Kind::conserved ? std::optional(std::size_t{0}) : std::nullopt;
    OrbitQuantity quantity = OrbitQuantity::of_monitor(problem.equations(), coordinate, first, 0);
    if (!quantity.evaluate(problem.equations(), problem.evaluation()))
        throw InputError(
            fmt::format("'{}', along which the family is followed, has no value at this orbit", coordinate.name),
            "start from another orbit nearby, by its number");
    return quantity.gradient();
}

} // namespace

Orbit twice(const Orbit& orbit) {
    Orbit result = orbit;
    result.signature.insert(result.signature.end(), orbit.signature.begin(), orbit.signature.end());
    result.starts.insert(result.starts.end(), orbit.starts.begin(), orbit.starts.end());
    result.durations.insert(result.durations.end(), orbit.durations.begin(), orbit.durations.end());
    return result;
}

std::vector<BranchStart> along_null_vector(const System& system, Orbit orbit, const BranchSettings& settings,
                                           const OrbitDirection& along, const std::string& how, bool second) {
    const Simulation simulation(system, {}, {}, integration(settings.orbit.tolerance));
    join_drifts(simulation, orbit);
    const ParameterId parameter = unfolding_of(system.model(), settings).value_or(settings.parameter);
    OrbitProblem problem(simulation, orbit, parameter);
    const auto fail = [] {
        throw InputError("the direction of the other branch could not be found", "try another point");
    };
    if (!problem.evaluate(problem.unknowns_of(orbit)))
        fail();
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(index(problem.unknowns()));
    if (!along.is_empty())
        row = vector_of(problem.row_of(problem.unknowns_of(along))).transpose();
    else if (settings.unfolded > 0)
        row = rise_along_family(problem, settings);
    else
        row[index(problem.parameter_place())] = 1;
    Eigen::VectorXd vector;
    if (!problem.equations().null_vector(problem.evaluation(), row, vector))
        fail();
    const OrbitDirection direction = problem.equations().direction_of(vector);
    std::vector<BranchStart> result{{orbit, direction, first_distance, how}};
    if (second)
        result.push_back({orbit, direction, -first_distance, how + ", the other way"});
    return result;
}

OtherBranchSearch::OtherBranchSearch(BranchState& state, const Orbit& orbit, std::vector<double> direction,
                                     double distance)
    : state_(state), u_(state.problem().unknowns_of(orbit)), direction_(std::move(direction)), distance_(distance),
      length_(state.problem().length_of(direction_)), sized_(sized_unknowns(state.problem().equations())),
      scales_(state.problem().equations().memory_of_scales()), was_simpler_(is_degenerate(state, orbit, same_orbit)) {
    const auto whole = vector_of(direction_).cwiseQuotient(vector_of(state.problem().scales())).norm();
    leaves_zero_ = size_of(vector_of(direction_)) < 0.5 * whole;
}

/// Returns the scaled length of a change of the unknowns that have sizes.
double OtherBranchSearch::size_of(const Eigen::VectorXd& change) const {
    return change.cwiseQuotient(vector_of(state_.problem().scales())).cwiseProduct(sized_).norm();
}

bool OtherBranchSearch::next() {
    while (!leaves_zero_ && tried_ < static_cast<int>(std::size(factors_of_distance)))
        if (reaches_other(direction_, factors_of_distance[tried_++] * distance_))
            return true;
    OrbitProblem& problem = state_.problem();
    // Where the nearest suitable distance leads to no orbit, or to one beyond a bound, shorter ones may do.
    constexpr double suitable = 1e-2, most = 10, measurable = 1e-6;
    constexpr int lengths = 2 * half_decades + 1;
    while (leaves_zero_ && tried_ < 2 * lengths) {
        const bool again = tried_ >= lengths;
        const int exponent = (again ? 2 * lengths - 1 - tried_ : tried_) - half_decades;
        ++tried_;
        const Eigen::VectorXd move = std::pow(10, 0.5 * exponent) * distance_ / length_ * vector_of(direction_);
        problem.equations().set_scales(vector_of(u_) + move, scales_);
        const std::vector<double> there = numbers_of(move);
        if (!reaches_other(there, problem.length_of(there)))
            continue;
        const double change = change_of_others();
        if (again ? change > measurable && change <= suitable : change > suitable && change < most)
            return true;
    }
    if (leaves_zero_)
        problem.equations().set_scales(vector_of(u_), scales_);
    return false;
}

std::string OtherBranchSearch::why() const {
    return leaves_zero_ ? "no orbit on another branch was found at any distance from the original one"
           : came_back_ ? "Newton's method returns to the original branch"
                        : "";
}

bool OtherBranchSearch::reaches_other(const std::vector<double>& direction, double distance) {
    if (!state_.continuation().start_along(u_, direction, distance))
        return false;
    // From a flip or symmetry breaking the new branch leaves the simpler orbits, or it returns to them.
    const double resolved = 0.01 * std::abs(distance);
    const auto displaced = [&] {
        const double length = state_.problem().length_of(direction);
        return state_.problem().equations().orbit_of(vector_of(u_) + distance * vector_of(direction) / length);
    };
    const bool from_simpler = was_simpler_ && !is_degenerate(state_, displaced(), resolved);
    const bool is_old =
        from_simpler ? is_degenerate(state_, state_.orbit(), resolved) : bends_back(direction, distance);
    came_back_ = came_back_ || is_old;
    return !is_old;
}

/// True when the point found lies on the original branch, which bends towards the direction of the other one: its
/// distance then scales with the square root of the step; on a crossing branch it is proportional to the step.
bool OtherBranchSearch::bends_back(const std::vector<double>& direction, double distance) {
    constexpr double far = 5, nearer = 0.25, between_root_and_proportion = 0.36;
    const double off = state_.distance_from(u_);
    if (off < far * std::abs(distance))
        return false;
    Continuation& continuation = state_.continuation();
    const bool bends = continuation.start_along(u_, direction, nearer * distance) &&
                       state_.distance_from(u_) > between_root_and_proportion * off;
    return bends || !continuation.start_along(u_, direction, distance);
}

/// Returns by how much the other states and the parameter have changed, in units of their scales: that tells the
/// distance from the original branch, which the states that leave zero cannot tell.
double OtherBranchSearch::change_of_others() const {
    return size_of(vector_of(u_) - vector_of(state_.continuation().point().u));
}

} // namespace graze
