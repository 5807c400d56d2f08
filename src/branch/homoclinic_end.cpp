#include "branch/homoclinic_end.hpp"

#include "branch/bounds.hpp"
#include "flow/cyclic.hpp"
#include "graze/base/input_error.hpp"
#include "graze/branch/curve_start.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/homoclinic_candidate.hpp"
#include "orbit/solve_homoclinic.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

namespace graze {

namespace {

/// True when derivatives grow along an orbit as beside a saddle, which costs less to see than where it passes one.
bool expands(const OrbitEquations& equations, const OrbitEvaluation& at) {
    constexpr double much = 100;
    const OrbitLayout& layout = equations.layout();
    const Eigen::VectorXd sizes = at.scales.head(index(layout.states()));
    return layout.pieces() > layout.segments() ||
           std::ranges::any_of(at.pieces, [&](const OrbitEvaluation::Piece& piece) {
               const Eigen::MatrixXd flow = piece.flow.leftCols(sizes.size());
               return (sizes.cwiseInverse().asDiagonal() * flow * sizes.asDiagonal()).norm() > much;
           });
}

std::string in_words(const System& system, const SpecialPoint& point, const HomoclinicSolution& found,
                     ParameterId parameter) {
    const Model& model = system.model();
    const std::vector<double> periods = system.periods()(point.solution.orbit.parameters);
    std::vector<std::string> place;
    for (std::size_t i = 0; i < found.saddle.size(); ++i)
        place.push_back(fmt::format("{} = {:.6g}", model.states[i].name, within_period(found.saddle[i], periods[i])));
    const auto& eigenvalues = point.solution.eigenvalues;
    const auto growing = std::ranges::find_if(eigenvalues, [](auto one) { return one.real() < 0; });
    return fmt::format("{} +- {:.1e}; saddle {}; {}; saddle quantity {:.6g}",
                       model.independent_parameters()[parameter.place()], found.error, fmt::join(place, ", "),
                       multipliers_in_words(point), growing->real() + std::prev(growing)->real());
}

class HomoclinicCondition : public OrbitCondition {
public:
    bool evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) override {
        value_ = at.departure;
        gradient_ = equations.departure_row(at);
        return true;
    }
};

} // namespace

bool HomoclinicEnd::is_sought(const BranchSettings& settings, const BranchPoint& here) {
    const std::vector<double>& rises = here.tangent.durations;
    return !settings.kept && !settings.family && settings.free.empty() && !here.solution.orbit.cycle &&
           std::accumulate(rises.begin(), rises.end(), 0.0) > 0;
}

std::optional<SpecialPoint> HomoclinicEnd::find(BranchState& state, const BranchPoint& here) {
    // Distance from the saddle, in units of the orbit's extent, below which the homoclinic orbit is sought; share of it
    // after which it is sought again; largest change from the periodic orbit, in the same units.
    constexpr double near = 3e-3, nearer = 0.7, farthest = 0.05;
    const BranchSettings& settings = state.settings();
    const OrbitEquations& equations = state.problem().equations();
    const OrbitEvaluation& at = state.problem().evaluation();
    const Orbit& orbit = here.solution.orbit;
    if (!expands(equations, at))
        return std::nullopt;
    const auto candidate = homoclinic_candidate(state.system(), orbit, settings.orbit.tolerance);
    if (!candidate || candidate->distance > std::min(near, nearer * sought_))
        return std::nullopt;
    sought_ = candidate->distance;
    OrbitOptions options = settings.orbit;
    options.accuracy = settings.continuation.accuracy;
    const HomoclinicSolution found = solve_homoclinic(state.system(), candidate->orbit, settings.parameter, options);
    if (found.solution.outcome != OrbitOutcome::converged || !(found.moved < farthest) ||
        (here.solution.certificate.admissible && !found.solution.certificate.admissible) ||
        is_outside(settings, found.parameter))
        return std::nullopt;
    SpecialPoint point = special_of_type(PointType::homoclinic, here);
    point.solution = found.solution;
    point.parameter = found.parameter;
    point.bracket = std::minmax(here.parameter, found.parameter);
    point.tangent = {};
    if (!settings.monitors.empty() && !refer_to_segments(settings.monitors)) // of which it has others
        point.monitors = OrbitMonitors(state.system(), found.solution.orbit.signature, settings.monitors,
                                       settings.orbit.tolerance)(found.solution.orbit);
    point.detail = in_words(state.system(), point, found, settings.parameter);
    return point;
}

std::unique_ptr<OrbitCondition> condition_of_homoclinic(const OrbitEquations& equations, const OrbitEvaluation&,
                                                        const SpecialPoint&) {
    return equations.homoclinic_ends() ? std::make_unique<HomoclinicCondition>() : nullptr;
}

std::optional<Orbit> at_suitable_distances(BranchState& state, const Orbit& orbit, const OrbitDirection& tangent) {
    const OrbitEquations& equations = state.problem().equations();
    const Eigen::VectorXd& scales = equations.scales();
    // Across the curve the parameter that changes least along it determines the orbit best.
    std::size_t steady = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t f = 0; f < tangent.parameters.size(); ++f)
        if (const double rise = std::abs(tangent.parameters[f]) / scales[index(equations.layout().parameter(f))];
            rise < least) {
            least = rise;
            steady = f;
        }
    OrbitOptions options = state.settings().orbit;
    options.accuracy = state.settings().continuation.accuracy;
    const HomoclinicSolution found = solve_homoclinic(state.system(), orbit, equations.free()[steady], options);
    constexpr double near = 0.05;
    return found.solution.outcome == OrbitOutcome::converged && found.moved < near ? std::optional(found.solution.orbit)
                                                                                   : std::nullopt;
}

void require_kept_homoclinic(const Orbit& candidate, const BranchSettings& settings) {
    const bool homoclinic = is_homoclinic(candidate.signature),
               kept = settings.kept && settings.kept->type == PointType::homoclinic;
    if (homoclinic && !kept)
        throw InputError("a homoclinic orbit exists at one value of a parameter only",
                         "follow it in two parameters: kind = \"curve\", free = { PARAMETER = [..] }");
    if (kept && !homoclinic)
        throw InputError("the orbit is not homoclinic", "start from a point HC");
}

} // namespace graze
