#include "branch/multiplier_points.hpp"

#include "base/special_numbers.hpp"
#include "branch/branch_state.hpp"
#include "branch/missed_points.hpp"
#include "branch/normal_form.hpp"
#include "branch/other_branch.hpp"
#include "branch/singular_condition.hpp"
#include "graze/branch/curve_start.hpp"
#include "orbit/eigen_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace graze {

namespace {

bool is_flip(PointType type) {
    return type == PointType::flip || type == PointType::asymmetry;
}

/// Returns the type of a fold, flip or torus point on a curve of another kind, where it is a point of codimension two.
/// Symmetry breaking counts as a flip of the half map.
PointType where_curves_meet(const TestedPoint& point, PointType own) {
    if (!point.settings.kept)
        return own;
    const PointType kept = point.settings.kept->type;
    const auto are = [&](auto is_one, auto is_other) {
        return (is_one(own) && is_other(kept)) || (is_other(own) && is_one(kept));
    };
    const auto is_fold = [](PointType type) { return type == PointType::fold; };
    const auto is_torus = [](PointType type) { return type == PointType::torus; };
    return are(is_fold, is_flip)    ? PointType::fold_flip
           : are(is_fold, is_torus) ? PointType::fold_torus
           : are(is_flip, is_torus) ? PointType::flip_torus
                                    : own;
}

/// @param type flip or, for half orbits, asymmetry
BranchTest test_of_multiplier_minus_one(const TestedPoint& point, PointType type) {
    const bool tested =
        point.equations.symmetry().has_value() == (type == PointType::asymmetry) && !is_kept(point, type);
    if (!tested)
        return {.type = where_curves_meet(point, type), .value = not_a_number};
    const CyclicSystem::Determinant determinant = point.at.system.antiperiodic_determinant();
    return {.type = where_curves_meet(point, type), .value = determinant.value, .noise = determinant.noise};
}

/// Returns the distance of the nearest multiplier from a number.
double distance_to(const OrbitSolution& solution, double wanted) {
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t neutral = solution.neutral; // those of a family do not count
    for (const std::complex<double> one : multipliers_followed(solution))
        if (one == 1.0 && neutral > 0)
            --neutral;
        else
            nearest = std::min(nearest, std::abs(one - wanted));
    return nearest;
}

/// Returns the distance of the nearest complex pair of multipliers from the unit circle.
double pair_off_circle(const OrbitSolution& solution) {
    constexpr double complex = 1e-6;
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::complex<double> one : multipliers_followed(solution))
        if (std::abs(one.imag()) > complex)
            nearest = std::min(nearest, std::abs(std::abs(one) - 1));
    return nearest;
}

/// True when the multipliers at a located point agree with its type within their uncertainty. Near a contact of zero
/// speed they change without bound, and determinants vanish for other reasons, so such zeros are rejected.
/// @param distance distance of an orbit's multipliers from the expected ones
/// @param close distance that is always accepted
template <class Distance>
bool multipliers_agree(BranchState& state, const SpecialPoint& special, const Distance& distance, double close) {
    // Scaled arclength over which the change of multipliers is measured; accepted distance in units of this change;
    // distance that is always rejected.
    constexpr double beside = 1e-10, times = 50, far = 2;
    const LastStep step = state.last_step();
    if (number_of_multipliers(special.solution) == 0) {
        // Multipliers are undefined all along a curve of contacts of zero speed, or only here, where another contact
        // has zero speed.
        constexpr double aside = 1e-4, near = 0.1; // fraction of the step; bound of the change of multipliers over it
        const auto there = state.settings().kept
                               ? state.describe_between(step.fraction(special.arclength) - aside, special.type)
                               : std::nullopt;
        return there && (number_of_multipliers(there->point.solution) == 0 || distance(there->point.solution) < near);
    }
    const double here = distance(special.solution);
    if (here <= close || !(here < far))
        return here <= close;
    double change = 0;
    for (const double aside : {-beside, beside}) {
        const auto there = state.describe_between(step.fraction(special.arclength + aside), special.type);
        if (!there)
            return false;
        change = std::max(change, std::abs(distance(there->point.solution) - here));
    }
    return here <= times * change;
}

bool has_multiplier(BranchState& state, const SpecialPoint& special, double wanted) {
    constexpr double close = 1e-3; // a double multiplier is known only to the square root of its uncertainty
    return multipliers_agree(
        state, special, [&](const OrbitSolution& solution) { return distance_to(solution, wanted); }, close);
}

bool has_pair_on_circle(BranchState& state, const SpecialPoint& special) {
    constexpr double close = 1e-5;
    return multipliers_agree(state, special, pair_off_circle, close);
}

std::string form_in_words(const FoldForm& form, const BranchState& state) {
    if (!form.turns)
        return "the side on which two orbits are is not decided: a is zero up to round-off";
    const std::string side = fmt::format("two orbits at {} {}", form.above ? "greater" : "smaller",
                                         state.model().independent_parameters()[state.settings().parameter.place()]);
    return form.is_simple ? fmt::format("{}, a = {:.6g}", side, form.coefficient)
                          : side + ", a has no value: two multipliers are 1";
}

/// @param supercritical sign of the coefficient for which the bifurcating orbit is stable; @param several reason why it
/// may be undefined
std::string form_in_words(const Criticality& form, const char* name, int supercritical, const char* several) {
    if (!form.is_simple)
        return fmt::format("{} has no value: {}", name, several);
    if (!form.is_decided())
        return fmt::format("criticality not decided, {} = 0 +- {:.1e}", name, form.error);
    return fmt::format("{}critical, {} = {:.6g}", form.value() * supercritical > 0 ? "super" : "sub", name,
                       form.value());
}

/// Notes that the multiplier -1 belongs to a half orbit: a symmetry breaking, not a flip.
void describe_asymmetry(const BranchState& state, SpecialPoint& special) {
    const bool of_half = special.solution.orbit.symmetry || state.settings().kept->type == PointType::asymmetry;
    special.detail = of_half ? "of a loss of symmetry" : "";
}

} // namespace

// Folds. With fixed monitors the parameter may have an extremum although no multiplier is 1, so the determinant is
// tested then.

void test_fold(const TestedPoint& point, std::vector<BranchTest>& tests) {
    constexpr double least_rise = 1e-8; // share of the parameter in the tangent: smaller values are round-off
    BranchTest test{.type = where_curves_meet(point, PointType::fold)};
    if (point.rise) {
        const Eigen::Map<const Eigen::VectorXd> tangent = vector_of(point.tangent);
        test.value = point.rise->dot(tangent);
        test.noise = least_rise * point.rise->transpose().cwiseProduct(point.at.scales).norm();
    } else if (point.settings.family && !point.settings.kept) {
        test.value = not_a_number; // nothing that is conserved is known to have an extremum
    } else if (point.settings.free.empty()) {
        const std::size_t place = point.equations.layout().parameter(0);
        test.value = point.tangent[place];
        test.noise = least_rise * point.at.scales[index(place)];
    } else {
        const bool kept = is_kept(point, PointType::fold) || is_kept(point, PointType::branch_point) ||
                          is_kept(point, PointType::homoclinic_tangency);
        const CyclicSystem::Determinant determinant = point.at.system.periodic_determinant();
        test.value = kept ? not_a_number : determinant.value;
        test.noise = determinant.noise;
    }
    tests.push_back(test);
}

/// The side with two orbits is reported for branches in one parameter only.
bool confirm_fold(BranchState& state, SpecialPoint& special, const BranchTest&) {
    const OrbitProblem& problem = state.problem();
    if (special.located && state.settings().unfolded == 0 && state.settings().free.empty())
        if (const auto form = fold_form(problem.equations(), problem.evaluation(), state.second_variation()))
            special.detail = form_in_words(*form, state);
    return special.located && has_multiplier(state, special, 1);
}

std::unique_ptr<OrbitCondition> condition_of_fold(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                  const SpecialPoint&) {
    return SingularCondition::of_multiplier(equations, at, 1);
}

// Tangencies of manifolds: folds of the equations of orbits that are homoclinic to a cycle. No multiplier is 1 there.

void test_homoclinic_tangency(const TestedPoint& point, std::vector<BranchTest>& tests) {
    test_fold(point, tests);
    tests.back().type = PointType::homoclinic_tangency;
}

bool confirm_homoclinic_tangency(BranchState& state, SpecialPoint& special, const BranchTest&) {
    special.detail = multipliers_in_words(special);
    return special.located && state.settings().unfolded == 0;
}

// Flips. A multiplier -1 of the half map of a symmetric orbit breaks the symmetry instead of doubling the period.

void test_flip(const TestedPoint& point, std::vector<BranchTest>& tests) {
    tests.push_back(test_of_multiplier_minus_one(point, PointType::flip));
}

void test_asymmetry(const TestedPoint& point, std::vector<BranchTest>& tests) {
    tests.push_back(test_of_multiplier_minus_one(point, PointType::asymmetry));
}

bool confirm_flip(BranchState& state, SpecialPoint& special, const BranchTest&) {
    if (state.settings().unfolded > 0) // both multipliers of the pair are -1
        return special.located && has_multiplier(state, special, -1);
    const OrbitProblem& problem = state.problem();
    if (const auto form = flip_criticality(problem.equations(), problem.evaluation(), state.second_variation()))
        special.detail = form_in_words(*form, "c", 1, "two multipliers are -1");
    return special.located && has_multiplier(state, special, -1);
}

std::unique_ptr<OrbitCondition> condition_of_flip(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                  const SpecialPoint&) {
    return SingularCondition::of_multiplier(equations, at, -1);
}

std::vector<BranchStart> leave_flip(const System& system, const SpecialPoint& point, const BranchSettings& settings) {
    return along_null_vector(system, twice(point.solution.orbit), settings, {}, "doubled", false);
}

std::vector<BranchStart> leave_asymmetry(const System& system, const SpecialPoint& point,
                                         const BranchSettings& settings) {
    return along_null_vector(system, whole_orbit(system, point.solution.orbit), settings, {}, "without the symmetry",
                             true);
}

void test_branch_point(const TestedPoint& point, std::vector<BranchTest>& tests) {
    tests.push_back({.type = PointType::branch_point,
                     .value = is_kept(point, PointType::branch_point) ? not_a_number : point.determinant,
                     .singular = true});
}

/// True when the kept pair of multipliers meets the multiplier 1 of a family of orbits, behind which it is real. The
/// equations are singular there, since the plane of the pair cannot be told from the family, whether or not other
/// orbits branch off.
bool is_resonance_in_family(const BranchState& state, const SpecialPoint& special) {
    constexpr double near = 1e-3; // a triple multiplier is known only to the cube root of its uncertainty
    const BranchSettings& settings = state.settings();
    return settings.kept && settings.kept->type == PointType::torus && settings.unfolded > 0 &&
           std::ranges::count_if(multipliers_followed(special.solution), [](auto one) {
               return std::abs(one - 1.0) < near;
           }) > static_cast<std::ptrdiff_t>(settings.unfolded) + 1;
}

/// With fixed monitors branches may cross although no multiplier is 1.
bool confirm_branch_point(BranchState& state, SpecialPoint& special, const BranchTest&) {
    if (special.located && is_resonance_in_family(state, special))
        special.type = PointType::resonance_1;
    return special.located && (!state.settings().free.empty() || has_multiplier(state, special, 1));
}

std::vector<BranchStart> leave_branch_point(const System& system, const SpecialPoint& point,
                                            const BranchSettings& settings) {
    return along_null_vector(system, point.solution.orbit, settings, point.tangent, "other branch", true);
}

/// Tests the product over all pairs of multipliers of mu_i mu_j - 1, which vanishes where two multipliers are
/// reciprocal, in conservative models on whole branches.
void test_torus(const TestedPoint& point, std::vector<BranchTest>& tests) {
    constexpr double least_growth = 1e-9; // noise of the product of a pair minus one
    const auto& multipliers = multipliers_followed(point.solution);
    BranchTest test{.type = where_curves_meet(point, PointType::torus), .value = not_a_number};
    std::complex<double> product = 1;
    double smallest = 1, others = 1;
    for (std::size_t i = 0; i < multipliers.size(); ++i)
        for (std::size_t j = i + 1; j < multipliers.size(); ++j) {
            const std::complex<double> both = multipliers[i] * multipliers[j],
                                       factor = (both - 1.0) / (1 + std::abs(both));
            product *= factor;
            others *= std::max(std::abs(factor), smallest);
            smallest = std::min(std::abs(factor), smallest);
        }
    // The factors of pairs with a multiplier that is not computed count as -1: it is small.
    const auto pairs = [](std::size_t count) { return count * (count - 1) / 2; };
    const std::size_t all = number_of_multipliers(point.solution);
    if ((pairs(all) - pairs(multipliers.size())) % 2 == 1)
        product = -product;
    // Where something is conserved, multipliers come in reciprocal pairs: the product is zero everywhere.
    if (all >= 2 && std::isfinite(product.real()) && !is_kept(point, PointType::torus) && point.settings.unfolded == 0)
        test.value = product.real();
    test.noise = least_growth * others;
    tests.push_back(test);
}

bool confirm_torus(BranchState& state, SpecialPoint& special, const BranchTest&) {
    if (!special.located || !has_pair_on_circle(state, special))
        return false; // as where two real multipliers are reciprocal
    OrbitProblem& problem = state.problem();
    if (!problem.evaluate(problem.unknowns_of(special.solution.orbit))) // multipliers may have been compared beside it
        return true;
    if (const auto form = torus_criticality(problem.equations(), problem.evaluation(), state.second_variation()))
        special.detail = form_in_words(*form, "d", -1, "two pairs are one");
    return true;
}

bool confirm_beside_flip(BranchState& state, SpecialPoint& special, const BranchTest&) {
    describe_asymmetry(state, special);
    return special.located;
}

bool confirm_with_torus(BranchState& state, SpecialPoint& special, const BranchTest&) {
    if (special.type == PointType::flip_torus)
        describe_asymmetry(state, special);
    return special.located && has_pair_on_circle(state, special);
}

std::unique_ptr<OrbitCondition> condition_of_torus(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                   const SpecialPoint&) {
    return TorusCondition::of_pair(equations, at);
}

/// Confirms that two multipliers are equal. Near a contact of zero speed other multipliers diverge, and the test
/// vanishes for that reason.
bool confirm_resonance(BranchState&, SpecialPoint& special, const BranchTest& test) {
    constexpr double near = 0.01; // a double multiplier is known only to the square root of its uncertainty
    const double wanted = test.type == PointType::resonance_1 ? 1 : -1;
    const auto& multipliers = multipliers_followed(special.solution);
    return special.located && std::count_if(multipliers.begin(), multipliers.end(),
                                            [&](auto one) { return std::abs(one - wanted) < near; }) >= 2;
}

bool confirm_cusp(BranchState& state, SpecialPoint& special, const BranchTest&) {
    const OrbitProblem& problem = state.problem();
    if (const auto coefficient = cusp_coefficient(problem.equations(), problem.evaluation(), state.second_variation()))
        special.detail = fmt::format("c = {:.6g}", *coefficient);
    return special.located;
}

} // namespace graze
