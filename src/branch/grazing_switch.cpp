#include "branch/grazing_switch.hpp"

#include "base/concatenated.hpp"
#include "base/linear_systems.hpp"
#include "base/signs.hpp"
#include "branch/bounds.hpp"
#include "branch/inserted_contact.hpp"
#include "branch/orbit_problem.hpp"
#include "branch/orbit_quantity.hpp"
#include "flow/guard.hpp"
#include "flow/lie_derivative.hpp"
#include "graze/base/input_error.hpp"
#include "orbit/certify.hpp"
#include "orbit/cut.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/newton.hpp"
#include "orbit/orbit_flow.hpp"
#include "orbit/shooting.hpp"

#include <Eigen/Core>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Speeds of the new contact that are tried, as shares of the largest speed along the arc.
constexpr double speeds[] = {1e-3, 1e-4, 1e-2, 1e-5};
/// Share of the period before the next touch that is not followed: the event there is the new contact itself.
constexpr double before_next_touch = 1e-4;
constexpr int most_iterations = 20;

/// The touch: its state, with the event function and its rate.
struct Touch {
    Touch(const Simulation& in, const SpecialPoint& point)
        : simulation(in), orbit(&point.solution.orbit), mode(orbit->signature[point.segment].mode), event(point.event),
          shooting(simulation, *orbit, {}), at(shooting.evaluation()) {
        const System& system = simulation.system();
        function = system.event(event);
        rate = system.with_gradient(rate_of(system, mode, event));
        ModeFlow flow = flow_of(simulation);
        flow.set_parameters(orbit->parameters);
        state = orbit->starts[point.segment];
        const double time = std::min(point.time, orbit->durations[point.segment]);
        constexpr int parts = 64;
        for (int part = 0; part < parts; ++part) {
            flow.run(mode, state, time / parts);
            greatest_value = std::max(greatest_value, std::abs(function(inputs(state))[0]));
            greatest_speed = std::max(greatest_speed, std::abs(rate(inputs(state))[0]));
        }
        shooting.evaluate(shooting.unknowns_of(*orbit), at);
    }

    /// Returns the nearest state, in scaled states, at which function and rate have these values; cyclic, drifting and
    /// neutral states are not changed.
    std::vector<double> displaced(double wanted_value, double wanted_rate) const {
        const auto h = function(inputs(state)), r = rate(inputs(state));
        const std::size_t n = state.size();
        Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2, index(n));
        for (const std::size_t i : at.active) {
            if (simulation.model().states[i].period)
                continue;
            const double scale = shooting.scales()[index(i)];
            rows(0, index(i)) = h[1 + i] * scale;
            rows(1, index(i)) = r[1 + i] * scale;
        }
        Eigen::Vector2d wanted(wanted_value - h[0], wanted_rate - r[0]);
        for (const Eigen::Index k : {0, 1}) // normalise: value and rate have different units
            if (const double unit = rows.row(k).norm(); unit > 0) {
                rows.row(k) /= unit;
                wanted[k] /= unit;
            }
        const Eigen::VectorXd step = shortest_solution(rows, wanted);
        return numbers_of(vector_of(state) + step.cwiseProduct(shooting.scales().head(index(n))));
    }

    std::vector<double> inputs(const std::vector<double>& values) const {
        return concatenated(values, orbit->parameters);
    }

    Simulation simulation;
    const Orbit* orbit;
    std::size_t mode, event;
    Shooting shooting;
    OrbitEvaluation at;
    Function function, rate;
    std::vector<double> state;
    double greatest_speed = 0, greatest_value = 0; ///< along the arc
};

/// Returns the mode after a transition, by its guards; empty where the motion ends.
std::optional<std::size_t> mode_after(const System& model, std::size_t transition, std::span<const double> inputs) {
    std::vector<double> conditions, work(model.workspace());
    const auto* chosen = chosen_alternative(model, transition, inputs, conditions, work);
    return chosen ? chosen->mode : std::nullopt;
}

/// Moves an orbit, with the parameter, to where the event of its last segment is reached at a given speed.
/// @return tangent of the branch there, towards higher speeds; empty when Newton's method fails
OrbitDirection solve_for_speed(const Simulation& simulation, Orbit& orbit, double speed,
                               const BranchSettings& settings) {
    constexpr double far = 1e3; // scaled step beyond which Newton's method has diverged
    Shooting shooting(simulation, orbit, {settings.parameter});
    OrbitQuantity condition = OrbitQuantity::of_speed(shooting, orbit.segments() - 1, speed);
    Eigen::VectorXd unknowns = shooting.unknowns_of(orbit), step;
    OrbitEvaluation at = shooting.evaluation();
    // The condition is divided by its scaled change, since its unit may make it small against the other equations.
    const auto solve = [&](double right, bool homogeneous) {
        if (!shooting.evaluate(unknowns, at) || !condition.evaluate(shooting, at))
            return false;
        const double unit = condition.gradient().cwiseAbs() * shooting.scales();
        return unit > 0 && shooting.solve(at, condition.gradient() / unit,
                                          Eigen::VectorXd::Constant(1, homogeneous ? right : -condition.value() / unit),
                                          homogeneous, step);
    };
    for (int i = 0; i < most_iterations; ++i) {
        if (!solve(0, false))
            return {};
        unknowns += step;
        const double size = step.cwiseQuotient(shooting.scales()).cwiseAbs().maxCoeff();
        if (!(size < far))
            return {};
        if (size < settings.orbit.accuracy) {
            if (!solve(-1, true))
                return {};
            orbit = shooting.orbit_of(unknowns);
            return shooting.direction_of(step);
        }
    }
    return {};
}

/// Follows the motion for one period after the contact, up to the next one.
std::optional<Orbit> followed_after_contact(const Simulation& simulation, const SpecialPoint& point,
                                            const std::vector<double>& after, std::size_t mode, const Segment& last,
                                            std::string& why) {
    const Orbit& grazing = point.solution.orbit;
    const double period = grazing.return_time();
    const FollowedMotion motion =
        follow_motion(simulation, grazing.parameters, after, mode, (1 - before_next_touch) * period);
    if (!motion.problem.empty()) {
        why = motion.problem;
        return std::nullopt;
    }
    Orbit orbit{motion.segments, grazing.parameters, motion.starts, motion.durations, grazing.symmetry};
    orbit.signature.push_back(last);
    orbit.durations.push_back(period - orbit.return_time());
    return orbit;
}

/// Makes first guesses of orbits in which a touch has become a contact of small speed.
class NewContact {
public:
    /// @throws InputError where nothing happens at the event
    NewContact(const System& system, const SpecialPoint& point, const BranchSettings& settings)
        : simulation_(system, {}, {}, integration(settings.orbit.tolerance)), point_(point), touch_(simulation_, point),
          name_(system.model().events[touch_.event].name) {
        const Model& model = system.model();
        transition_ = model.find_transition(touch_.mode, touch_.event);
        if (!transition_)
            throw InputError(fmt::format("nothing happens at event '{}'", name_), "no branch leaves there");
        first_ = static_cast<std::size_t>(transition_ - model.transitions.data());
    }
    const Simulation& simulation() const { return simulation_; }
    double greatest_speed() const { return touch_.greatest_speed; }
    const std::string& name() const { return name_; }

    /// @param inserted true: insert the contact into the segments of the grazing orbit; false: follow the motion after
    /// it for a whole period
    std::optional<Orbit> with_speed(double speed, bool inserted, std::string& why) const {
        const System& compiled = simulation_.system();
        std::vector<double> state = touch_.displaced(0, -speed), work(compiled.workspace()), conditions;
        const auto chosen = chosen_transition(compiled, first_, {}, touch_.inputs(state), conditions, work);
        if (!chosen) {
            why = "no transition of the contact is possible there";
            return std::nullopt;
        }
        Segment last{touch_.mode, SegmentEnd::event, *chosen};
        if (const Orbit& grazing = point_.solution.orbit; grazing.symmetry)
            last = image_of(compiled, *grazing.symmetry, last, grazing);
        const System::CompiledJump& jump = compiled.jump(compiled.transition(*chosen).jump);
        if (!jump.identity)
            jump.map.evaluate(touch_.inputs(state), state, work);
        const auto mode = mode_after(compiled, *chosen, touch_.inputs(state));
        if (!mode) {
            why = "the motion ends there";
            return std::nullopt;
        }
        auto orbit = inserted ? with_contact_inserted(simulation_, point_, state, *mode, last)
                              : followed_after_contact(simulation_, point_, state, *mode, last, why);
        if (orbit)
            join_drifts(simulation_, *orbit);
        return orbit;
    }

private:
    Simulation simulation_;
    const SpecialPoint& point_;
    Touch touch_;
    const std::string& name_;
    const Transition* transition_ = nullptr;
    std::size_t first_ = 0; ///< transition of the touching event
};

/// True when the determinant of folds or that of flips changes its sign between two orbits of a branch. Neither has a
/// pole at contacts of zero speed.
bool have_bifurcation_between(const Simulation& simulation, const Orbit& one, const Orbit& other) {
    if (one.signature != other.signature)
        return false;
    Shooting first(simulation, one, {}), second(simulation, other, {});
    OrbitEvaluation here = first.evaluation(), there = second.evaluation();
    return first.layout().pieces() == second.layout().pieces() && first.evaluate(first.unknowns_of(one), here) &&
           second.evaluate(second.unknowns_of(other), there) &&
           (have_opposite_signs(here.system.periodic_determinant().value, there.system.periodic_determinant().value) ||
            have_opposite_signs(here.system.antiperiodic_determinant().value,
                                there.system.antiperiodic_determinant().value));
}

/// Cuts off a motion where it returns to the contact that the orbit shall not have. It may reach it early, by a time
/// that grows with the square root of the clearance.
void cut_off_return(const System& system, FollowedMotion& motion, const Orbit& old, std::size_t segment,
                    double period) {
    constexpr double earliest = 0.02; // share of the period
    const double early = std::min(earliest * period, 0.5 * old.durations[segment]);
    Segment contact = old.signature[segment];
    if (old.symmetry)
        contact = image_of(system, *old.symmetry, contact, old);
    double time = 0;
    for (std::size_t k = 0; k < motion.segments.size(); ++k) {
        time += motion.durations[k];
        if (motion.segments[k].end == SegmentEnd::event && motion.segments[k].index == contact.index &&
            time > period - early) {
            motion.segments.resize(k);
            motion.durations.resize(k);
            motion.starts.resize(k + 1);
            return;
        }
    }
}

} // namespace

BranchStart with_one_more_contact(const System& system, const SpecialPoint& point, const BranchSettings& settings) {
    const NewContact contact(system, point, settings);
    std::string why = "Newton's method does not find it";
    const auto with_share = [&](double share) -> std::optional<BranchStart> {
        const double speed = share * contact.greatest_speed();
        for (const bool inserted : {true, false}) {
            auto orbit = contact.with_speed(speed, inserted, why);
            if (!orbit)
                continue;
            const OrbitDirection direction = solve_for_speed(contact.simulation(), *orbit, speed, settings);
            if (direction.is_empty())
                continue;
            if (is_outside(settings, orbit->parameters[settings.parameter.place()])) // near a touch close to a bound
                why = "it lies outside the branch's bounds";
            else if (is_admissible(contact.simulation(), *orbit, why))
                return BranchStart{*orbit, direction, 0, fmt::format("with one more contact at '{}'", contact.name())};
        }
        return std::nullopt;
    };
    for (const double share : speeds) {
        const auto start = with_share(share);
        if (!start)
            continue;
        // Start nearer to the touch if a fold or flip lies in between.
        for (const double nearer : {1e-4, 1e-2})
            if (const auto near = with_share(nearer * share);
                near && have_bifurcation_between(contact.simulation(), near->orbit, start->orbit))
                return *near;
        return *start;
    }
    throw InputError(fmt::format("no orbit with one more contact at '{}' was found: {}", contact.name(), why),
                     "the motion after the contact may accumulate contacts, or not come back");
}

Orbit with_contact_of_no_speed(const System& system, const SpecialPoint& point, const BranchSettings& settings) {
    // Shares of the largest speed: a small speed is needed to follow the motion after the contact.
    constexpr double shares[] = {1e-6, 1e-5, 1e-4};
    const NewContact contact(system, point, settings);
    std::string why = "Newton's method does not find it";
    for (const double share : shares)
        for (const bool inserted : {true, false}) {
            auto orbit = contact.with_speed(share * contact.greatest_speed(), inserted, why);
            if (!orbit || solve_for_speed(contact.simulation(), *orbit, 0, settings).is_empty())
                continue;
            orbit->parameters = point.solution.orbit.parameters; // equal up to round-off
            return *orbit;
        }
    throw InputError(fmt::format("no orbit with a contact more at '{}' was found: {}", contact.name(), why),
                     "the motion after the contact may accumulate contacts, or not come back");
}

BranchStart with_one_contact_fewer(const System& system, const SpecialPoint& point, const BranchSettings& settings) {
    const Model& model = system.model();
    constexpr double clearance = 1e-6; // share of the largest gap by which the contact is missed
    const Simulation simulation(system, {}, {}, integration(settings.orbit.tolerance));
    const Orbit& old = point.solution.orbit;
    const Touch touch(simulation, point);
    const std::string& name = model.events[touch.event].name;
    const double period = old.return_time();
    const std::vector<double> state = touch.displaced(clearance * touch.greatest_value, 0);
    FollowedMotion motion =
        follow_motion(simulation, old.parameters, state, touch.mode, (1 - before_next_touch) * period);
    cut_off_return(system, motion, old, point.segment, period);
    const auto fail = [&](const std::string& why) {
        throw InputError(fmt::format("no orbit with one contact fewer at '{}' was found: {}", name, why),
                         "the branch may end here");
    };
    if (!motion.problem.empty())
        fail(motion.problem);
    std::optional<Orbit> orbit =
        motion.segments.empty() ? close_at_section(system, old.parameters, state, touch.mode, period, "", old.symmetry)
                                : std::optional(begun_after_first_contact(system, old, motion, period));
    if (!orbit)
        fail("it passes none of the model's sections");
    const OrbitSolution solution = solve_orbit(system, *orbit, settings.orbit);
    if (solution.outcome != OrbitOutcome::converged)
        fail(solution.detail);
    // Choose the direction along the branch in which the event is not reached.
    BranchSettings trial = settings;
    trial.continuation.first_step = 1e-3;
    trial.stop_when_unphysical = false;
    OrbitDirection direction;
    for (const int sign : {1, -1}) {
        OrbitProblem problem(simulation, solution.orbit, settings.parameter);
        const auto tangent = problem.tangent_at(solution.orbit, sign);
        if (!tangent)
            fail("the branch has a fold there");
        direction = *tangent;
        OrbitBranch branch(system, solution.orbit, trial);
        if (branch.start_along(direction, 0) && branch.step() && branch.point().solution.certificate.admissible)
            break;
    }
    // Start at a small distance from the touching orbit, whose admissibility round-off would decide.
    constexpr double away = 1e-3;
    return {solution.orbit, direction, away, fmt::format("with one contact fewer at '{}'", name)};
}

} // namespace graze
