#include "branch/equilibrium_tests.hpp"

#include "base/concatenated.hpp"
#include "base/linear_systems.hpp"
#include "base/special_numbers.hpp"
#include "branch/boundary_equilibrium.hpp"
#include "branch/bounds.hpp"
#include "graze/base/input_error.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/solve_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

using Eigenvalues = std::vector<std::complex<double>>;

/// The two eigenvalues whose sum is nearest to zero and whose product is nearest to the given one.
std::optional<std::pair<std::size_t, std::size_t>> places_of_pair(const Eigenvalues& eigenvalues, double product) {
    std::optional<std::pair<std::size_t, std::size_t>> best;
    double nearest = infinity;
    for (std::size_t i = 0; i < eigenvalues.size(); ++i)
        for (std::size_t j = i + 1; j < eigenvalues.size(); ++j) {
            const double distance =
                std::norm(eigenvalues[i] + eigenvalues[j]) + std::abs(eigenvalues[i] * eigenvalues[j] - product);
            if (distance < nearest) {
                nearest = distance;
                best = {i, j};
            }
        }
    return best;
}

/// The complex eigenvalue nearest to the imaginary axis, of those in the upper half plane.
std::optional<std::complex<double>> nearest_pair(const Eigenvalues& eigenvalues) {
    std::optional<std::complex<double>> nearest;
    for (const auto one : eigenvalues)
        if (one.imag() > 0 && (!nearest || std::abs(one.real()) < std::abs(nearest->real())))
            nearest = one;
    return nearest;
}

} // namespace

Eigenvalues without_pair(Eigenvalues eigenvalues, double product) {
    if (const auto pair = places_of_pair(eigenvalues, product)) {
        eigenvalues.erase(eigenvalues.begin() + static_cast<std::ptrdiff_t>(pair->second));
        eigenvalues.erase(eigenvalues.begin() + static_cast<std::ptrdiff_t>(pair->first));
    }
    return eigenvalues;
}

double growth_of_nearest_pair(const Eigenvalues& eigenvalues) {
    const auto nearest = nearest_pair(eigenvalues);
    return nearest ? nearest->real() : not_a_number;
}

double product_of_nearest_pair(const Eigenvalues& eigenvalues) {
    const auto nearest = nearest_pair(eigenvalues);
    return nearest ? std::norm(*nearest) : 0;
}

EquilibriumPath::EquilibriumPath(const System& system, const Orbit& candidate, const BranchSettings& settings)
    : settings_(settings), problem_(std::make_shared<EquilibriumProblem>(system, candidate, settings)),
      monitors_(system, settings.monitors) {
    for (const Monitor& monitor : settings.monitors) {
        if (!monitor.segment.empty() && monitor.segment != "1")
            throw InputError(
                fmt::format("monitor '{}': an equilibrium has no segment '{}'", monitor.name, monitor.segment),
                "leave `segment` out");
        const bool is_value = monitor.kind != Monitor::Kind::duration && monitor.kind != Monitor::Kind::multiplier;
        if (!is_value && monitor.fixed)
            throw InputError(
                fmt::format("monitor '{}' cannot be held: an equilibrium has no periods and multipliers", monitor.name),
                "hold a value of an expression");
    }
    EquilibriumEvaluation at;
    if (!problem_->describe(problem_->unknowns_of(candidate), at))
        throw InputError("the model is not defined at the equilibrium", "begin elsewhere");
    hold(at);
}

/// Adds the conditions of fixed monitors and of the kept point.
void EquilibriumPath::hold(const EquilibriumEvaluation& at) {
    for (std::size_t m = 0; m < settings_.monitors.size(); ++m) {
        Monitor& monitor = settings_.monitors[m];
        if (!monitor.fixed)
            continue;
        const Function& function = monitors_.function(m, problem_->equations().mode());
        if (!monitor.held)
            monitor.held = function(concatenated(at.state, at.parameters))[0];
        problem_->hold(std::make_unique<HeldFunction>(function, *monitor.held, at));
    }
    if (!settings_.kept)
        return;
    switch (settings_.kept->type) {
    case PointType::fold:
        fold_ = keep(std::make_unique<EquilibriumFold>(at));
        break;
    case PointType::hopf:
        hopf_ =
            keep(std::make_unique<EquilibriumHopf>(at, product_of_nearest_pair(settings_.kept->solution.eigenvalues)));
        third_ = std::make_shared<const EquilibriumThirdDerivatives>(problem_->equations());
        break;
    case PointType::boundary_equilibrium:
        problem_->hold(std::make_unique<HeldFunction>(system().event(settings_.kept->event), 0, at));
        break;
    default:
        throw InputError(fmt::format("the condition of a point of type {} cannot be held along a curve of equilibria",
                                     short_name(settings_.kept->type)),
                         "follow a fold, a Hopf point or a boundary equilibrium");
    }
}

std::optional<HopfForm> EquilibriumPath::form_at(const EquilibriumEvaluation& at, double product) const {
    return hopf_form(at, third_ ? *third_ : EquilibriumThirdDerivatives(problem_->equations()), product);
}

std::optional<DescribedEquilibrium> EquilibriumPath::describe(const ContinuationPoint& at) const {
    DescribedEquilibrium there;
    there.at = at;
    if (!problem_->describe(at.u, there.evaluation))
        return std::nullopt;
    BranchPoint& point = there.point;
    OrbitSolution& solution = point.solution;
    solution.orbit = problem_->orbit_of(at.u);
    solution.outcome = OrbitOutcome::converged;
    solution.iterations = at.iterations;
    solution.residual = there.evaluation.rates.size() > 0 ? there.evaluation.rates.cwiseAbs().maxCoeff() /
                                                                std::max(there.evaluation.field.norm(), 1e-300)
                                                          : 0;
    solution.eigenvalues = sorted_eigenvalues(problem_->equations(), there.evaluation.field);
    solution.certificate = certify_equilibrium(problem_->equations(), solution.orbit);
    there.unstable = unstable_directions(solution);
    point.parameter = solution.orbit.parameters[settings_.parameter.place()];
    point.arclength = at.arclength;
    point.stable = is_stable(solution);
    point.iterations = at.iterations;
    point.tangent = problem_->direction_of(at.tangent);
    point.monitors = monitors_(solution.orbit);
    add_tests(there);
    return there;
}

void EquilibriumPath::add_tests(DescribedEquilibrium& there) const {
    const Eigenvalues& eigenvalues = there.point.solution.eigenvalues;
    const auto add = [&](PointType type, double value) { there.tests.push_back({.type = type, .value = value}); };
    if (!settings_.kept && settings_.free.empty()) {
        add(PointType::fold, there.at.tangent[problem_->parameter_place()]);
        there.tests.push_back({.type = PointType::branch_point, .value = there.at.determinant, .singular = true});
        add(PointType::hopf, growth_of_nearest_pair(eigenvalues));
    } else if (keeps(PointType::fold) || keeps(PointType::hopf)) {
        add_tests_of_kept(there);
    } else {
        const double size = there.evaluation.jacobian.norm();
        add(PointType::fold, size > 0 ? determinant(there.evaluation.field / size) : not_a_number);
        add(PointType::hopf, growth_of_nearest_pair(eigenvalues));
    }
    add_events(there);
    if (settings_.kept || !settings_.free.empty())
        add_extrema(there);
    add_crossings(there);
    for (BranchTest& test : tests_of_bounds(settings_, there.point.solution.orbit.parameters, there.point.monitors))
        there.tests.push_back(test);
}

/// The points of codimension two on a curve of folds or of Hopf points.
void EquilibriumPath::add_tests_of_kept(DescribedEquilibrium& there) const {
    const auto add = [&](PointType type, double value) { there.tests.push_back({.type = type, .value = value}); };
    const Eigen::Index n = there.evaluation.size();
    const Eigenvalues& eigenvalues = there.point.solution.eigenvalues;
    if (keeps(PointType::fold)) {
        const auto null = fold_->borders().at(there.evaluation.field);
        const auto bend = [&] {
            return null->left.dot(there.evaluation.second(null->right).leftCols(n) * null->right);
        };
        add(PointType::cusp, null ? bend() : not_a_number);
        add(PointType::takens_bogdanov, null && n > 1 ? null->left.dot(null->right) : not_a_number);
        add(PointType::zero_hopf, growth_of_nearest_pair(eigenvalues));
        return;
    }
    const double product = hopf_->product();
    const auto form = form_at(there.evaluation, product);
    const auto pair = eigenvalue_pair(there.evaluation.field, product);
    const Eigenvalues others = without_pair(eigenvalues, product);
    std::complex<double> rest = 1;
    for (const auto one : others)
        rest *= one / there.evaluation.field.norm();
    add(PointType::generalised_hopf, form ? form->lyapunov : not_a_number);
    add(PointType::takens_bogdanov, pair ? pair->product : not_a_number);
    add(PointType::zero_hopf, others.empty() ? not_a_number : rest.real());
    add(PointType::double_hopf, growth_of_nearest_pair(others));
}

void EquilibriumPath::add_events(DescribedEquilibrium& there) const {
    const std::size_t mode = problem_->equations().mode();
    const std::vector<double> inputs = concatenated(there.evaluation.state, there.evaluation.parameters);
    for (const std::size_t event : model().modes[mode].watched) {
        if (!changes_motion(model(), mode, event) ||
            (keeps(PointType::boundary_equilibrium) && settings_.kept->event == event))
            continue;
        const Function& function = system().event(event);
        const std::vector<double> values = function(inputs);
        there.tests.push_back({.type = PointType::boundary_equilibrium,
                               .event = event,
                               .value = values[0],
                               .noise = event_round_off(function, inputs, values, there.evaluation.state.size())});
    }
}

void EquilibriumPath::add_extrema(DescribedEquilibrium& there) const {
    constexpr double least_rise = 1e-8; // share of a parameter in the tangent
    for (std::size_t f = 0; f < problem_->equations().free().size(); ++f) {
        const std::size_t place = problem_->parameter_place() + f;
        there.tests.push_back({.type = PointType::extremum,
                               .value = there.at.tangent[place],
                               .noise = least_rise * problem_->scales()[place],
                               .parameter = f});
    }
}

void EquilibriumPath::add_crossings(DescribedEquilibrium& there) const {
    for (std::size_t m = 0; m < settings_.monitors.size(); ++m)
        for (std::size_t c = 0; c < settings_.monitors[m].crossings.size(); ++c)
            there.tests.push_back({.type = PointType::crossing,
                                   .value = there.point.monitors[m] - settings_.monitors[m].crossings[c],
                                   .monitor = m,
                                   .crossing = c});
}

} // namespace graze
