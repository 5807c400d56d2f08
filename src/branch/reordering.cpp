#include "branch/reordering.hpp"

#include "branch/bounds.hpp"
#include "branch/inserted_contact.hpp"
#include "graze/base/input_error.hpp"
#include "orbit/certify.hpp"
#include "orbit/cut.hpp"
#include "orbit/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace graze {

namespace {

/// Scaled distances beyond the point at which the motion of the model is tried.
constexpr double distances[] = {1e-4, 1e-5, 1e-3, 1e-6};

/// The part of the motion that is taken as an orbit, in periods of the old orbit.
struct PeriodsTaken {
    int before; ///< periods that are skipped: beyond a guard the first one still begins in the old mode
    int taken;  ///< old periods per new period: at a border collision the new orbit may have twice
                ///< the period
};
constexpr PeriodsTaken next_period{0, 1};
constexpr PeriodsTaken all_choices[] = {next_period, {1, 1}, {2, 1}, {1, 2}, {2, 2}};

/// Follows the motion from the middle of the longest segment of an orbit, and returns it as an orbit.
std::optional<Orbit> followed_motion(const Simulation& simulation, const Orbit& orbit, const PeriodsTaken& periods,
                                     std::string& why) {
    const double period = orbit.return_time() * periods.taken;
    // Not in a chatter sequence, which is no motion in one mode.
    std::vector<double> lengths = orbit.durations;
    Accumulations accumulations = Accumulations::end;
    for (std::size_t s = 0; s < orbit.segments(); ++s)
        if (orbit.signature[s].end == SegmentEnd::chatter) {
            lengths[s] = 0;
            accumulations = Accumulations::segments;
        }
    const auto longest = static_cast<std::size_t>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
    std::vector<double> state = orbit.starts[longest];
    std::size_t mode = orbit.signature[longest].mode;
    ModeFlow flow = flow_of(simulation);
    flow.set_parameters(orbit.parameters);
    if (flow.run(mode, state, 0.5 * orbit.durations[longest]) != ModeFlow::Ending::done) {
        why = "the orbit cannot be followed";
        return std::nullopt;
    }
    if (periods.before > 0) {
        const FollowedMotion before = follow_motion(simulation, orbit.parameters, state, mode,
                                                    orbit.return_time() * periods.before, accumulations);
        why = before.problem;
        if (!why.empty())
            return std::nullopt;
        state = before.final_state;
        mode = before.final_mode;
    }
    const FollowedMotion motion = follow_motion(simulation, orbit.parameters, state, mode, period, accumulations);
    why = motion.problem;
    if (!why.empty())
        return std::nullopt;
    Orbit like = orbit;
    if (periods.taken > 1)
        like.symmetry.reset(); // taken twice, a half orbit is a whole one, which needs no symmetry
    return motion.segments.empty()
               ? close_at_section(simulation.system(), orbit.parameters, state, mode, period, "", like.symmetry)
               : std::optional(begun_after_first_contact(simulation.system(), like, motion, period));
}

/// True when an orbit has the segments of another, once or repeatedly, up to a cyclic shift: then it belongs to the
/// branch of the other.
bool have_same_segments(const Orbit& one, const Orbit& other) {
    const std::size_t count = other.signature.size();
    Signature signature = other.signature;
    for (std::size_t k = 0; k < count; ++k) {
        bool same = one.signature.size() % count == 0;
        for (std::size_t s = 0; same && s < one.signature.size(); ++s)
            same = one.signature[s] == signature[s % count];
        if (same)
            return true;
        std::rotate(signature.begin(), signature.begin() + 1, signature.end());
    }
    return false;
}

/// Returns the scaled unit tangent of the branch in the first parameter alone; empty at its folds.
std::optional<Eigen::VectorXd> along_branch(const Simulation& simulation, const Orbit& orbit,
                                            const BranchSettings& settings, const OrbitProblem& with_all) {
    OrbitProblem problem(simulation, orbit, settings.parameter);
    const auto tangent = problem.tangent_at(orbit, 1);
    if (!tangent)
        return std::nullopt;
    const Eigen::VectorXd result = vector_of(with_all.unknowns_of(*tangent));
    return result / result.cwiseQuotient(vector_of(with_all.scales())).norm();
}

/// Returns the motion of the model for one period near a point of a curve, as a first guess; it need not close.
/// @param distance along the curve, in units of its tangent; negative: backwards
/// @param aside offset from the curve in the first parameter, in the same units, so that the kept touch is missed or
/// made
/// @return empty where the motion cannot be followed or has the signature of the point
std::optional<Orbit> reordered_beyond(const System& system, const SpecialPoint& point, const BranchSettings& settings,
                                      double distance, double aside) {
    const Simulation simulation(system, {}, {}, integration(settings.orbit.tolerance));
    const Orbit& orbit = point.solution.orbit;
    OrbitProblem problem(simulation, orbit, settings);
    const std::vector<double> u = problem.unknowns_of(orbit);
    if (point.tangent.is_empty() || !problem.evaluate(u))
        return std::nullopt;
    const std::vector<double> tangent = problem.unknowns_of(point.tangent);
    Eigen::VectorXd there = vector_of(u) + distance * vector_of(tangent);
    if (aside != 0) {
        const auto off = along_branch(simulation, orbit, settings, problem);
        if (!off)
            return std::nullopt;
        there += aside * *off;
    }
    std::string why;
    auto candidate = followed_motion(simulation, problem.equations().orbit_of(there), next_period, why);
    return candidate && !have_same_segments(*candidate, orbit) ? candidate : std::nullopt;
}

/// Solves for an orbit from a guess; empty, with the reason set, if it is not admissible.
std::optional<Orbit> admissible_from(const Simulation& simulation, const Orbit& guess, const OrbitOptions& options,
                                     std::string& why) {
    OrbitSolution solution;
    try {
        solution = solve_orbit(simulation.system(), guess, options);
    } catch (const InputError& error) { // the motion does not give a possible signature
        why = error.problem();
        return std::nullopt;
    }
    if (solution.outcome != OrbitOutcome::converged)
        why = solution.detail;
    else if (is_admissible(simulation, solution.orbit, why))
        return solution.orbit;
    return std::nullopt;
}

/// Solves for an orbit from a guess beyond a point, with the direction of its branch away from the point. At a
/// nonsmooth fold both orbits lie on the side from which the branch came, so the mirrored parameter is tried too.
std::optional<BranchStart> start_from(const Simulation& simulation, const Orbit& guess, const BranchSettings& settings,
                                      double parameter_there, std::string& why) {
    OrbitOptions options = settings.orbit;
    options.error_estimate = false;
    const std::size_t place = settings.parameter.place();
    auto orbit = admissible_from(simulation, guess, options, why);
    if (!orbit) {
        Orbit mirrored = guess;
        mirrored.parameters[place] = 2 * parameter_there - guess.parameters[place];
        std::string of_mirrored;
        orbit = admissible_from(simulation, mirrored, options, of_mirrored);
    }
    if (!orbit)
        return std::nullopt;
    OrbitProblem problem(simulation, *orbit, settings.parameter);
    const auto onward = problem.tangent_at(*orbit, orbit->parameters[place] < parameter_there ? -1 : 1);
    if (!onward)
        return std::nullopt;
    return BranchStart{*orbit, *onward, 0, "with events in another order"};
}

} // namespace

bool continue_reordered_curve(BranchState& state, const SpecialPoint& point) {
    constexpr double lengths[] = {1e-4, 1e-5, 1e-3}; // in units of the scales
    constexpr double share = 0.1;                    // offset from the curve, as a share of the distance
    const double rise = point.tangent.parameters.empty() ? 0 : point.tangent.parameters.front();
    // Guesses lie beside a curve of touches, on both sides, because on it round-off decides whether the surface is
    // reached.
    const std::vector<double> beside = keeps_touch(state.settings()) ? std::vector{share, -share} : std::vector{0.0};
    for (const double distance : lengths)
        for (const int side : {1, -1})
            for (const double aside : beside) {
                const auto guess =
                    reordered_beyond(state.system(), point, state.settings(), side * distance, aside * distance);
                if (!guess || !state.continue_curve(*guess, side * rise < 0 ? -1 : 1, point.arclength))
                    continue;
                const auto there = state.describe(state.continuation().point());
                if (there && !is_beyond_bounds(there->tests) && there->point.solution.certificate.admissible)
                    return true;
            }
    return false;
}

std::string touch_at_edge(const BranchSettings& settings, const Orbit& orbit) {
    constexpr double at_edge = 1e-3; // share of the segment; the steps become very small before
    if (!keeps_touch(settings))
        return "";
    const SpecialPoint& kept = *settings.kept;
    const double duration = orbit.durations[kept.segment];
    const bool at_start = kept.time < at_edge * duration;
    return at_start || kept.time > (1 - at_edge) * duration
               ? fmt::format("the touch has come to the {} of segment {}", at_start ? "start" : "end", kept.segment + 1)
               : "";
}

std::optional<DescribedPoint> continue_in_next_segment(BranchState& state, const BranchPoint& from) {
    constexpr double lengths[] = {1e-4, 1e-3, 1e-2}; // in units of the scales
    constexpr double first_step = 1e-3;
    OrbitProblem& problem = state.problem();
    const Orbit& here = from.solution.orbit;
    const std::size_t old = state.settings().kept->segment;
    const double share = state.settings().kept->time / here.durations[old];
    const bool closes = share < 0.5 ? old == 0 : old + 1 == here.segments();
    const std::vector<double> u = problem.unknowns_of(here);
    if (!problem.evaluate(u) || (here.symmetry && closes && !state.keep_image_of_touch(here)))
        return std::nullopt;
    const std::vector<double> tangent = problem.unknowns_of(from.tangent);
    std::vector<Orbit> guesses;
    for (const double distance : lengths)
        guesses.push_back(problem.equations().orbit_of(vector_of(u) + distance * vector_of(tangent)));
    for (const Orbit& guess : guesses) {
        if (!state.continue_curve(guess, from.tangent.parameters.front() < 0 ? -1 : 1, from.arclength))
            continue;
        // The touch must continue at the opposite end, in the neighbouring segment or, if there is only one, in the
        // same.
        const SpecialPoint& kept = *state.settings().kept;
        if ((kept.time / guess.durations[kept.segment] < 0.5) == (share < 0.5) && kept.segment == old)
            continue;
        auto beyond = state.describe(state.continuation().point());
        if (!beyond || !beyond->point.solution.certificate.admissible || is_beyond_bounds(beyond->tests))
            continue;
        state.continuation().set_next_step(first_step);
        return beyond;
    }
    return std::nullopt;
}

BranchStart with_events_reordered(const System& system, const SpecialPoint& point, const BranchSettings& settings) {
    const Simulation simulation(system, {}, {}, integration(settings.orbit.tolerance));
    const Orbit& orbit = point.solution.orbit;
    std::string why = "the branch's direction is not known";
    OrbitProblem problem(simulation, orbit, settings.parameter);
    const std::vector<double> u = problem.unknowns_of(orbit);
    if (!point.tangent.is_empty() && problem.evaluate(u)) {
        const std::vector<double> tangent = problem.unknowns_of(point.tangent);
        why = "the motion there has the same events in the same order";
        for (const PeriodsTaken& periods : all_choices)
            for (const double distance : distances)
                for (const double side : {1.0, -1.0}) {
                    const Eigen::VectorXd there = vector_of(u) + side * distance * vector_of(tangent);
                    const Orbit beyond = problem.equations().orbit_of(there);
                    std::string reason;
                    const auto candidate = followed_motion(simulation, beyond, periods, reason);
                    const auto start = candidate && !have_same_segments(*candidate, orbit)
                                           ? start_from(simulation, *candidate, settings,
                                                        orbit.parameters[settings.parameter.place()], reason)
                                           : std::nullopt;
                    if (start)
                        return *start;
                    if (!reason.empty())
                        why = reason;
                }
    }
    throw InputError(fmt::format("no orbit was found beyond the point: {}", why), "the branch may end here");
}

} // namespace graze
