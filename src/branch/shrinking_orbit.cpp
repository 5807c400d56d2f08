#include "branch/shrinking_orbit.hpp"

#include "branch/crossing.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/orbit_flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace graze {

namespace {

/// Share of the distance to an equilibrium that the last regular step covers.
constexpr double approach_share = 0.75;

/// Returns the scaled rates at the start of a segment.
Eigen::VectorXd motion_at(BranchState& state, const Orbit& orbit, std::size_t segment) {
    const std::vector<double> rates = state.rates_at(orbit, segment);
    return vector_of(rates).cwiseQuotient(vector_of(state.problem().scales().first(rates.size())));
}

/// Returns the largest scaled rate at the starts of all segments.
double largest_motion(BranchState& state, const Orbit& orbit) {
    double largest = 0;
    for (std::size_t s = 0; s < orbit.segments(); ++s)
        largest = std::max(largest, motion_at(state, orbit, s).cwiseAbs().maxCoeff());
    return largest;
}

/// Returns a description of the surface on which an orbit with contacts shrinks.
std::string surface_of(const Model& model, const Orbit& orbit) {
    for (const Segment& segment : orbit.signature)
        if (ends_by_transition(segment))
            return fmt::format(" on the surface of event '{}'",
                               model.events[model.transitions[segment.index].event].name);
    return "";
}

/// @param error of the parameter
SpecialPoint hopf_at(BranchState& state, const BranchPoint& there, double arclength, double error) {
    SpecialPoint special = special_of_type(PointType::hopf, there);
    special.arclength = arclength;
    special.detail = fmt::format("{} +- {:.1e}: the orbit shrinks to an equilibrium{}",
                                 state.model().independent_parameters()[state.settings().parameter.place()], error,
                                 surface_of(state.model(), there.solution.orbit));
    special.solution.error = error / state.problem().scales()[state.problem().parameter_place()];
    return special;
}

/// True when the scaled rates at the first start have reversed between two orbits of the branch. Between nearby points
/// this happens where the orbits shrink to an equilibrium.
bool has_reversed(BranchState& state, const Orbit& before, const Orbit& now) {
    return before.signature == now.signature && motion_at(state, before, 0).dot(motion_at(state, now, 0)) < 0;
}

/// Locates the equilibrium to which the orbits of the last step shrink, from points at a distance on both sides: the
/// equations are singular there, since an equilibrium is an orbit of any period.
/// @return empty if the orbits do not shrink
std::optional<SpecialPoint> locate_equilibrium(BranchState& state, const Orbit& before) {
    // Parameter and period change with the square of the orbit's size, so distant points are accurate too. Nearer
    // points have more round-off, farther ones a larger interpolation error: the choice with the smaller difference is
    // used.
    constexpr double nearer[] = {1, 0.5};
    constexpr double at_rest = 1e-2; // share of the rates at the start of the step
    // Both locations share errors, which in tests are up to four times their difference.
    constexpr double times = 10, round_off = 1e-13;
    const Eigen::VectorXd first = motion_at(state, before, 0);
    const auto value = [&](const ContinuationPoint& point) {
        return first.dot(motion_at(state, state.problem().orbit_of(point.u), 0));
    };
    const TestValue begin{0, first.squaredNorm()}, end{1, value(state.continuation().point())};
    const std::size_t place = state.problem().parameter_place();
    std::optional<ContinuationPoint> found;
    double differ = 0;
    for (const double scale : nearer) {
        const auto located = [&](std::array<double, 8> offsets) {
            for (double& offset : offsets)
                offset *= scale;
            return locate_crossing(state.continuation(), value, begin, end, 1, offsets);
        };
        const auto one = located({-0.4, -0.3, -0.2, -0.1, 0.1, 0.2, 0.3, 0.4}),
                   other = located({-0.44, -0.34, -0.22, -0.12, 0.12, 0.22, 0.34, 0.44});
        if (!one || !other)
            continue;
        const double error = std::abs(one->u[place] - other->u[place]);
        if (found && !(error < differ))
            continue;
        found = one;
        differ = error;
    }
    const auto there = found ? state.describe(*found) : std::nullopt;
    if (!there || largest_motion(state, there->point.solution.orbit) > at_rest * largest_motion(state, before))
        return std::nullopt;
    const double error =
        times * differ + round_off * std::max(std::abs(found->u[place]), state.problem().scales()[place]);
    return hopf_at(state, there->point, there->point.arclength, error);
}

bool is_without_contacts(const Orbit& orbit) {
    return std::all_of(orbit.signature.begin(), orbit.signature.end(), [&](const Segment& segment) {
        return !ends_by_transition(segment) && segment.mode == orbit.signature[0].mode;
    });
}

/// Returns states along an orbit without contacts, at equal time intervals; empty where it cannot be followed.
std::vector<std::vector<double>> states_along(BranchState& state, const Orbit& orbit) {
    constexpr int count = 64;
    ModeFlow flow = flow_of(state.problem().equations().simulation());
    flow.set_parameters(orbit.parameters);
    std::vector<std::vector<double>> result{orbit.starts[0]};
    for (int i = 1; i < count; ++i) {
        result.push_back(result.back());
        if (flow.run(orbit.signature[0].mode, result.back(), orbit.return_time() / count) != ModeFlow::Ending::done)
            return {};
    }
    return result;
}

/// Returns an orbit of the current problem that rests at a Hopf point.
Orbit at_rest_in(const Orbit& orbit, const HopfPoint& hopf, ParameterId parameter) {
    Orbit result = orbit;
    for (double& duration : result.durations)
        duration *= hopf.period / orbit.period();
    std::fill(result.starts.begin(), result.starts.end(), hopf.state);
    result.parameters[parameter.place()] = hopf.parameter;
    return result;
}

/// Returns the arclength between a point of the current problem and the orbit at rest.
double distance_to_equilibrium(BranchState& state, const ContinuationPoint& from, const HopfPoint& hopf) {
    OrbitProblem& problem = state.problem();
    const std::vector<double> rest =
        problem.unknowns_of(at_rest_in(problem.orbit_of(from.u), hopf, state.settings().parameter));
    return problem.length_of(numbers_of(vector_of(rest) - vector_of(from.u)));
}

/// Computes the Hopf point ahead on a branch of orbits without contacts, after a step in which a section or cut was
/// touched, from the equations of the equilibrium, which do not involve sections.
/// @param from start of that step; @param length of that step
/// @return empty where no such equilibrium exists, or it lies much farther away than the length of the step
std::optional<HopfPoint> hopf_ahead(BranchState& state, const ContinuationPoint& from, double length) {
    // An oblique cut of an ellipse may be touched at a considerable distance from its centre.
    constexpr double farthest = 4, same_period = 0.25;
    const Orbit orbit = state.problem().orbit_of(from.u);
    const std::vector<std::vector<double>> along =
        is_without_contacts(orbit) ? states_along(state, orbit) : std::vector<std::vector<double>>();
    if (along.empty())
        return std::nullopt;
    std::vector<double> mean(orbit.starts[0].size(), 0.0);
    for (const std::vector<double>& one : along)
        entries_of(mean) += vector_of(one) / static_cast<double>(along.size());
    const auto hopf =
        hopf_near(state.system(), orbit.signature[0].mode, mean, orbit.parameters, state.settings().parameter,
                  orbit.period(), state.problem().scales().first(mean.size()));
    if (!hopf || std::abs(hopf->period - orbit.period()) > same_period * orbit.period() ||
        !(distance_to_equilibrium(state, from, *hopf) < farthest * length))
        return std::nullopt;
    return hopf;
}

/// Returns an orbit that starts where it is farthest from the Hopf point and ends at a cut whose plane contains that
/// point, so that all smaller orbits cross it, and the direction in which the orbits shrink.
/// @return empty where the orbit cannot be followed
std::optional<UncutOrbit> begun_for_shrinking(BranchState& state, const Orbit& orbit, const HopfPoint& hopf) {
    const std::vector<std::vector<double>> along = states_along(state, orbit);
    if (along.empty())
        return std::nullopt;
    const Eigen::VectorXd scales = vector_of(state.problem().scales().first(hopf.state.size()));
    const auto error = [&](const std::vector<double>& one) {
        return (vector_of(one) - vector_of(hopf.state)).cwiseQuotient(scales).squaredNorm();
    };
    const auto farthest =
        std::max_element(along.begin(), along.end(), [&](const auto& a, const auto& b) { return error(a) < error(b); });
    UncutOrbit result{orbit, {}};
    result.orbit.signature = {{orbit.signature[0].mode, SegmentEnd::cut, 0}};
    result.orbit.starts = {*farthest};
    result.orbit.durations = {orbit.return_time()};
    const ParameterId parameter = state.settings().parameter;
    const Orbit rest = at_rest_in(result.orbit, hopf, parameter);
    result.direction = {{numbers_of(vector_of(rest.starts[0]) - vector_of(*farthest))},
                        {rest.durations[0] - result.orbit.durations[0]},
                        {rest.parameters[parameter.place()] - orbit.parameters[parameter.place()]}};
    return result;
}

/// True when the parameter approaches that of the Hopf point with the square of the orbit's size.
bool shrinks_to(const HopfPoint& hopf, ParameterId parameter, const Orbit& before, const Orbit& now) {
    constexpr double share = 0.3, round_off = 1e-9;
    const auto error = [&](const Orbit& orbit) {
        return std::abs(orbit.parameters[parameter.place()] - hopf.parameter);
    };
    const auto off_period = [&](const Orbit& orbit) { return std::abs(orbit.period() - hopf.period); };
    return error(now) <= share * error(before) + round_off * std::abs(hopf.parameter) &&
           off_period(now) <= share * off_period(before) + round_off * hopf.period;
}

/// Returns the end of the branch at a Hopf point.
std::optional<SpecialPoint> end_in(BranchState& state, const HopfPoint& hopf) {
    constexpr double round_off = 1e-13;
    ContinuationPoint at = state.continuation().point();
    const double arclength = state.arclength(at.arclength) + distance_to_equilibrium(state, at, hopf);
    at.u = state.problem().unknowns_of(at_rest_in(state.orbit(), hopf, state.settings().parameter));
    const auto there = state.describe(at);
    if (!there)
        return std::nullopt;
    const double scale = state.problem().scales()[state.problem().parameter_place()];
    return hopf_at(state, there->point, arclength, hopf.error + round_off * std::max(std::abs(hopf.parameter), scale));
}

} // namespace

/// True when the end was located at a Hopf point, within the errors of both.
bool ShrinkingOrbit::is_located(const HopfPoint& hopf) const {
    const double unit = state_->problem().scales()[state_->problem().parameter_place()];
    return std::abs(end_->parameter - hopf.parameter) <= end_->solution.error.value_or(0) * unit + hopf.error;
}

bool ShrinkingOrbit::step(const std::function<bool()>& make, const BranchPoint& from,
                          const std::vector<double>& rates) {
    Continuation& continuation = state_->continuation();
    const Continuation before = continuation;
    const Orbit orbit = state_->orbit();
    if (!make())
        return false;
    hopf_.reset();
    if (state_->settings().kept)
        return true;
    const bool reversed = has_reversed(*state_, orbit, state_->orbit());
    if (!reversed && !reversed_section(rates, state_->rates_at_sections()))
        return true;
    hopf_ = hopf_ahead(*state_, before.point(), continuation.point().arclength - before.point().arclength);
    end_ = reversed ? locate_equilibrium(*state_, orbit) : std::nullopt;
    if (end_ && ((hopf_ && !is_located(*hopf_)) || // the section does not pass through the equilibrium
                 !(end_->arclength > from.arclength)))
        end_.reset();
    if (!end_)
        return true;
    const Continuation across = continuation;
    continuation = before;
    continuation.set_next_step(approach_share * (end_->arclength - from.arclength));
    if (!make() || has_reversed(*state_, orbit, state_->orbit()))
        continuation = across;
    return true;
}

bool ShrinkingOrbit::turn(const BranchPoint& from) {
    const bool again = approached_ || (tried_ && !(from.arclength > *tried_));
    approached_.reset();
    if (!hopf_ || again)
        return false;
    tried_ = from.arclength;
    const auto begun = begun_for_shrinking(*state_, from.solution.orbit, *hopf_);
    if (!begun || !state_->replace_orbit(from, *begun))
        return false;
    approached_ = hopf_;
    Continuation& continuation = state_->continuation();
    continuation.set_next_step(approach_share * distance_to_equilibrium(*state_, continuation.point(), *hopf_));
    return true;
}

void ShrinkingOrbit::update(const Orbit& before) {
    if (approached_ && shrinks_to(*approached_, state_->settings().parameter, before, state_->orbit()))
        end_ = end_in(*state_, *approached_);
    approached_.reset();
}

} // namespace graze
