#include "graze/branch/orbit_branch.hpp"

#include "branch/bounds.hpp"
#include "branch/curve_begin.hpp"
#include "branch/point_locator.hpp"
#include "branch/point_rules.hpp"
#include "branch/reordering.hpp"
#include "branch/shrinking_orbit.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/branch/switching.hpp"
#include "orbit/cut.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace graze {

namespace {

/// Largest scaled difference, due to round-off, between a solution and its repetition or image.
constexpr double same_orbit = 1e-6;

/// Orders of magnitude above and below the other states that are tried for the size of a state that leaves zero.
constexpr int most_decades = 15;

const char* const returned_to_simpler = "back on the branch of simpler orbits";

bool is_among(PointType type, const std::vector<PointType>& types) {
    return std::find(types.begin(), types.end(), type) != types.end();
}

} // namespace

class OrbitBranch::Follower {
public:
    Follower(const System& system, const Orbit& candidate, const BranchSettings& settings)
        : state_(system, candidate, settings), candidate_(candidate), locator_(state_, point, tests_),
          is_kept_point_(settings.kept && settings.free.size() == (settings.kept_too ? 2U : 1U) &&
                         settings.kept->solution.orbit.parameters == candidate.parameters) {}

    bool start() {
        constexpr double near = 1e-2; // scaled distance: a curve must begin at its kept point
        const std::vector<double> u = state_.problem().unknowns_of(candidate_);
        if (state_.is_in_family(candidate_)) {
            begin(false);
            detail = family_in_words();
            return false;
        }
        const bool begun =
            state_.continuation().start(u, state_.problem().parameter_place(), state_.settings().direction);
        // At changed parameters the orbit may no longer cross its section.
        if (!begun && !is_kept_point_ && state_.begin_without_sections(candidate_))
            return begin(true);
        if (!begun || !is_kept_point_ || distance_from(u) < near)
            return begin(begun);
        const double off = distance_from(u);
        begin(false);
        detail =
            fmt::format("Newton's method leads to another orbit, {:.3g} away in units of the unknowns' sizes", off);
        return false;
    }

    bool start_along(const OrbitDirection& given, double distance) {
        OrbitProblem& problem = state_.problem();
        if (given.parameters.size() > problem.equations().free().size())
            throw InputError("the direction has more parameters than vary", "leave out those that stay");
        const std::vector<double> u = problem.unknowns_of(candidate_);
        if (!problem.evaluate(u))
            return begin(false);
        const std::vector<double> direction = problem.unknowns_of(given);
        if (distance != 0)
            return start_on_other(u, direction, distance);
        return begin(state_.continuation().start_at(u, problem.row_of(direction)));
    }

    bool step() {
        found.clear();
        if (ended_)
            return false;
        if (point.step >= state_.settings().steps)
            return end(BranchOutcome::steps, "");
        if (equilibrium_)
            return end_at_equilibrium();
        if (state_.pieces_need_renewal() ||
            cuts_are_oblique(state_.problem().equations(), state_.problem().evaluation())) {
            state_.renew_pieces(point);
            renewed();
        }
        const std::vector<double> rates = rates_here();
        if (const auto touched = touched_section(rates)) {
            if (!state_.leave_sections(point))
                return end(BranchOutcome::undefined, touch_in_words(*touched));
            renewed();
        }
        const Continuation here = state_.continuation();
        const BranchPoint before = point;
        const std::vector<BranchTest> tests_before = tests_;
        const std::size_t work_before = state_.problem().equations().work();
        if (!step_on_branch(rates)) {
            if (const std::string edge = touch_at_edge(); !edge.empty()) {
                if (!continue_in_next_segment())
                    return end(BranchOutcome::undefined, edge);
                ++point.step;
                return true;
            }
            return end(state_.continuation().outcome() == ContinuationOutcome::undefined
                           ? BranchOutcome::undefined
                           : BranchOutcome::no_convergence,
                       state_.problem().problem());
        }
        if (reversed_section(rates, rates_here()) || (hopf_ && !equilibrium_))
            return step_without_touch(here);
        update_approach(before.solution.orbit);
        describe_here();
        const std::size_t work = state_.problem().equations().work() - work_before;
        ++point.step;
        point.iterations = state_.continuation().point().iterations;
        if (point.step == 1 && is_unphysical_curve(before)) {
            point = before;
            return end(BranchOutcome::unphysical, before.solution.certificate.reason);
        }
        if (point.step == 1 && is_beyond_torus(tests_before)) {
            point = before;
            return end(BranchOutcome::stopped, "in this direction the two multipliers are real");
        }
        if (point.step == 1 && has_no_contact(before)) {
            point = before;
            return end(BranchOutcome::stopped, "in this direction the new contact has a negative speed");
        }
        if (equilibrium_ && point.arclength > equilibrium_->arclength) {
            point = before;
            return end_at_equilibrium();
        }
        found = locator_.locate_all(before, tests_before);
        if (has_jumped() && attempts_ < most_attempts)
            return step_again(here, before, tests_before);
        if (!returned_)
            locator_.add_missed(found, before, tests_before);
        if (locator_.misses_bound(found, tests_before))
            return step_to_bound(here, before, tests_before);
        attempts_ = 0;
        drop_points_at_start(point.arclength - before.arclength);
        end_or_reorder(before.solution.certificate.admissible);
        if (!ended_ && returned_)
            finish(BranchOutcome::returned, returned_to_simpler);
        if (!ended_ && state_.continuation().outcome() == ContinuationOutcome::closed)
            finish(BranchOutcome::closed, "");
        if (!ended_ && work > state_.settings().work)
            finish(BranchOutcome::too_long,
                   fmt::format("the last point took {} steps of integration, at period {:.6g}: bounds of what varies "
                               "would end it before",
                               work, point.solution.orbit.period()));
        return true;
    }

    BranchPoint point;
    std::vector<SpecialPoint> found;
    BranchOutcome outcome = BranchOutcome::no_start;
    std::string detail;

private:
    /// Largest number of repetitions of a step.
    static constexpr int most_attempts = 8;
    /// Share of the distance to an equilibrium that the last regular step covers.
    static constexpr double approach_share = 0.75;

    /// Makes a step. If it leads through an equilibrium to which the orbits shrink, the equilibrium is located, and the
    /// step is repeated to end just before it, so that special points on the way are separated from the singularity.
    bool step_on_branch(const std::vector<double>& rates) {
        Continuation& continuation = state_.continuation();
        const Continuation before = continuation;
        const Orbit from = orbit_here();
        if (!step_before_simpler())
            return false;
        hopf_.reset();
        if (state_.settings().kept)
            return true;
        const bool reversed = has_reversed(state_, from, orbit_here());
        if (!reversed && !reversed_section(rates, rates_here()))
            return true;
        const double length = continuation.point().arclength - before.point().arclength;
        hopf_ = hopf_ahead(state_, before.point(), length);
        equilibrium_ = reversed ? locate_equilibrium(state_, from) : std::nullopt;
        if (equilibrium_ && hopf_ && !locations_agree(*equilibrium_, *hopf_))
            equilibrium_.reset(); // the section does not pass through the equilibrium
        if (!equilibrium_)
            return true;
        const double distance = equilibrium_->arclength - point.arclength;
        if (!(distance > 0)) {
            equilibrium_.reset();
            return true;
        }
        const Continuation across = continuation;
        continuation = before;
        continuation.set_next_step(approach_share * distance);
        if (step_before_simpler() && !has_reversed(state_, from, orbit_here()))
            return true;
        continuation = across;
        return true;
    }
    /// True when two locations of an equilibrium agree within their errors.
    bool locations_agree(const SpecialPoint& located, const HopfPoint& hopf) {
        const double unit = state_.problem().scales()[state_.problem().parameter_place()];
        return std::abs(located.parameter - hopf.parameter) <= located.solution.error.value_or(0) * unit + hopf.error;
    }
    /// After a step towards a Hopf point: if the orbits shrink to it, the branch ends there with the next step.
    void update_approach(const Orbit& before) {
        if (approached_ && shrinks_to(*approached_, state_.settings().parameter, before, orbit_here()))
            equilibrium_ = end_in(state_, *approached_, state_.arclength(state_.continuation().point().arclength),
                                  distance_to(state_, state_.continuation().point(), *approached_));
        approached_.reset();
    }
    /// Moves the start of the orbit to where it is farthest from the Hopf point ahead, and sets the length of the next
    /// step accordingly; at most once per point.
    bool turn_to_hopf() {
        const bool again = approached_ || (tried_ && !(point.arclength > *tried_));
        approached_.reset();
        if (!hopf_ || again)
            return false;
        tried_ = point.arclength;
        const auto begun = begun_for_shrinking(state_, point.solution.orbit, *hopf_);
        if (!begun || !state_.replace_orbit(point, *begun))
            return false;
        renewed();
        approached_ = hopf_;
        state_.continuation().set_next_step(approach_share *
                                            distance_to(state_, state_.continuation().point(), *hopf_));
        return true;
    }
    /// Ends the branch in the equilibrium to which its orbits shrink.
    bool end_at_equilibrium() {
        equilibrium_->bracket = std::minmax(point.parameter, equilibrium_->parameter);
        equilibrium_->step = ++point.step;
        found = {*equilibrium_};
        end_at(0);
        finish(BranchOutcome::shrunk, "");
        return true;
    }
    /// Makes a step. If it ends on a branch of simpler orbits (half the period, or symmetric), it has passed the
    /// crossing with that branch and is repeated with a shorter step.
    bool step_before_simpler() {
        constexpr double shorter = 0.25;
        Continuation& continuation = state_.continuation();
        const Continuation before = continuation;
        for (int attempt = 0;; ++attempt) {
            if (!continuation.step())
                return false;
            returned_ = !starts_simpler_ && is_degenerate(state_, orbit_here(), same_orbit);
            if (!returned_ || attempt >= most_attempts)
                return true;
            const double length = continuation.point().arclength - continuation.previous().arclength;
            continuation = before;
            continuation.set_next_step(shorter * length);
        }
    }

    /// True when an orbit on another branch has a suitable distance: the other states and the parameter must have
    /// changed measurably, but not too much. The states that leave zero cannot tell.
    bool has_suitable_distance(std::vector<double> u, const std::vector<bool>& sized) {
        constexpr double least = 1e-2, most = 10; // in units of the scales
        for (std::size_t i = 0; i < u.size(); ++i)
            u[i] -= state_.continuation().point().u[i];
        const double bent = size_of(u, sized);
        return bent > least && bent < most;
    }
    /// Returns which unknowns have scales that are their own size.
    std::vector<bool> sized_unknowns() {
        const OrbitEquations& equations = state_.problem().equations();
        const OrbitLayout& layout = equations.layout();
        std::vector<bool> result(layout.unknowns(), true);
        for (std::size_t i = 0; i < layout.states(); ++i) {
            for (std::size_t k = 0; k < layout.pieces(); ++k)
                result[layout.start_of(k) + i] = equations.has_size(i);
            for (std::size_t j = i; j < layout.pieces() * layout.inner(); j += layout.states())
                result[layout.inner_of(0) + j] = equations.has_size(i);
        }
        return result;
    }
    /// Returns the scaled length of the chosen unknowns; of all if `chosen` is empty.
    double size_of(const std::vector<double>& unknowns, const std::vector<bool>& chosen) {
        double sum = 0;
        for (std::size_t i = 0; i < unknowns.size(); ++i) {
            const double one = unknowns[i] / state_.problem().scales()[i];
            sum += chosen.empty() || chosen[i] ? one * one : 0;
        }
        return std::sqrt(sum);
    }
    /// Result of Newton's method at a distance from the original branch.
    enum class Found { nothing, left_branch, other_branch };
    Found search_other_branch(const std::vector<double>& u, const std::vector<double>& direction, double distance,
                              bool was_simpler) {
        if (!state_.continuation().start_along(u, direction, distance))
            return Found::nothing;
        // From a flip or symmetry breaking the new branch leaves the simpler orbits, or it returns to them.
        const double resolved = 0.01 * std::abs(distance);
        const bool from_simpler = was_simpler && !is_degenerate(state_, displaced(u, direction, distance), resolved);
        const bool is_old =
            from_simpler ? is_degenerate(state_, orbit_here(), resolved) : bends_back(u, direction, distance);
        return is_old ? Found::left_branch : Found::other_branch;
    }
    /// Starts on another branch. Newton's method may return to the original branch; then other distances are tried.
    bool start_on_other(const std::vector<double>& u, const std::vector<double>& direction, double distance) {
        constexpr double factors[] = {1, 0.1, 4, 0.01};
        const std::vector<bool> sized = sized_unknowns();
        if (size_of(direction, sized) < 0.5 * size_of(direction, {}))
            return start_off_zero(u, direction, distance, sized);
        const bool was_simpler = is_degenerate(state_, candidate_, same_orbit);
        bool came_back = false, beyond = false;
        for (const double factor : factors) {
            const Found here = search_other_branch(u, direction, factor * distance, was_simpler);
            if (here == Found::other_branch && begin(true))
                return true;
            beyond = beyond || here == Found::other_branch;
            came_back = came_back || here == Found::left_branch;
        }
        if (beyond)
            return false;
        begin(false);
        if (came_back)
            detail = "Newton's method returns to the original branch";
        return false;
    }
    /// Starts on another branch where states leave zero that are zero all along the original branch. Their size is
    /// unknown, so many orders of magnitude are tried, each with its own scales.
    bool start_off_zero(const std::vector<double>& u, const std::vector<double>& direction, double distance,
                        const std::vector<bool>& sized) {
        OrbitProblem& problem = state_.problem();
        const bool was_simpler = is_degenerate(state_, candidate_, same_orbit);
        const double length = length_of(direction);
        for (int half_decades = -2 * most_decades; half_decades <= 2 * most_decades; ++half_decades) {
            std::vector<double> move = direction, there = u;
            for (std::size_t i = 0; i < u.size(); ++i) {
                move[i] *= std::pow(10, 0.5 * half_decades) * distance / length;
                there[i] += move[i];
            }
            problem.equations().set_scales(vector_of(there));
            if (search_other_branch(u, move, length_of(move), was_simpler) == Found::other_branch &&
                has_suitable_distance(u, sized) && begin(true))
                return true;
        }
        problem.equations().set_scales(vector_of(u));
        begin(false);
        detail = "no orbit on another branch was found at any distance from the original one";
        return false;
    }
    /// Returns the length of a direction in the norm of the continuation.
    double length_of(const std::vector<double>& direction) {
        const std::vector<double> row = state_.problem().row_of(direction);
        return std::sqrt(std::inner_product(row.begin(), row.end(), direction.begin(), 0.0));
    }
    Orbit displaced(std::vector<double> u, const std::vector<double>& direction, double distance) {
        const double length = length_of(direction);
        for (std::size_t i = 0; i < u.size(); ++i)
            u[i] += distance * direction[i] / length;
        return state_.problem().orbit_of(u);
    }
    Orbit orbit_here() { return state_.problem().orbit_of(state_.continuation().point().u); }
    double distance_from(std::vector<double> u) {
        for (std::size_t i = 0; i < u.size(); ++i)
            u[i] -= state_.continuation().point().u[i];
        return size_of(u, {});
    }
    /// True when the point found lies on the original branch, which bends towards the direction of the other one: its
    /// distance then scales with the square root of the step; on a crossing branch it is proportional to the step.
    bool bends_back(const std::vector<double>& u, const std::vector<double>& direction, double distance) {
        constexpr double far = 5, nearer = 0.25, between_root_and_proportion = 0.36;
        const double off = distance_from(u);
        if (off < far * std::abs(distance))
            return false;
        Continuation& continuation = state_.continuation();
        const bool bends = continuation.start_along(u, direction, nearer * distance) &&
                           distance_from(u) > between_root_and_proportion * off;
        return bends || !continuation.start_along(u, direction, distance);
    }

    /// Returns the rates at which the current orbit crosses its sections.
    std::vector<double> rates_here() {
        state_.problem().evaluate(state_.continuation().point().u);
        return passing_rates(state_.problem().equations(), state_.problem().evaluation());
    }
    /// Resets what depends on the equations, after they were replaced.
    void renewed() {
        locator_.forget();
        describe_here();
    }
    /// Repeats the last step: towards an equilibrium to which the orbits shrink, without the section that was touched
    /// within the step, or with a shorter step if the section is needed or a cut was touched.
    bool step_without_touch(const Continuation& before) {
        constexpr double shorter = 0.25;
        const double length = state_.continuation().point().arclength - state_.continuation().previous().arclength;
        state_.continuation() = before;
        state_.problem().evaluate(state_.continuation().point().u);
        if (turn_to_hopf())
            return step();
        if (state_.leave_sections(point))
            renewed();
        else if (shorter * length > state_.settings().continuation.smallest_step)
            state_.continuation().set_next_step(shorter * length);
        else
            return end(BranchOutcome::no_convergence, "the orbit is tangent to the plane of its cut");
        return step();
    }
    /// Repeats a step that passed a bound which could not be located, with a shorter step; after several attempts the
    /// branch ends before the bound.
    bool step_to_bound(const Continuation& before, const BranchPoint& from, const std::vector<BranchTest>& tests) {
        if (attempts_ < most_attempts)
            return step_again(before, from, tests);
        found.clear();
        point = from;
        return end(BranchOutcome::bound, "no orbit was found on the bound itself");
    }
    /// True when the last step has jumped to a nearby branch that does not cross this one: the determinant has changed
    /// its sign, but no branch point or limit point was found.
    bool has_jumped() {
        const Continuation& continuation = state_.continuation();
        return !state_.settings().kept && !returned_ &&
               continuation.previous().determinant * continuation.point().determinant < 0 &&
               std::none_of(found.begin(), found.end(), [](const SpecialPoint& one) {
                   return one.type == PointType::branch_point || kind_of(one.type).limits;
               });
    }
    /// Repeats the last step with a shorter one.
    bool step_again(const Continuation& before, const BranchPoint& from, const std::vector<BranchTest>& tests) {
        constexpr double shorter = 0.25;
        const double length = state_.continuation().point().arclength - state_.continuation().previous().arclength;
        ++attempts_;
        found.clear();
        point = from;
        tests_ = tests;
        locator_.forget();
        state_.continuation() = before;
        state_.problem().evaluate(state_.continuation().point().u);
        state_.continuation().set_next_step(shorter * length);
        return step();
    }
    /// Returns the message for a candidate in a family of orbits, for which no branch is defined.
    std::string family_in_words() const {
        const Model& model = state_.model();
        return fmt::format(
            "the orbit is one of a family at the same '{}' (a multiplier is 1: something is conserved). "
            "Hold one of its numbers, such as monitors = {{ reach = {{ maximum = \"{}\", fixed = true }} "
            "}}, with a parameter in `free` that ends the family, such as a damping of 0 (the model needs "
            "one); `along` that parameter is the family itself",
            model.independent_parameters()[state_.settings().parameter.place()], model.states.front().name);
    }
    std::string touch_in_words(std::size_t segment) const {
        return fmt::format("the orbit only touches the section '{}', at which monitors are taken or a touch is kept: "
                           "choose another section, or monitors along the whole orbit",
                           end_name(state_.model(), point.solution.orbit.signature[segment]));
    }

    void describe_here() {
        state_.describe(state_.continuation().point(), point, tests_);
        if (!is_beyond_bounds(tests_)) {
            put_on_bounds(state_.settings(), point.solution.orbit);
            point.parameter = point.solution.orbit.parameters[state_.settings().parameter.place()];
        }
    }

    bool begin(bool begun) {
        ended_ = !begun;
        if (!begun) {
            outcome = BranchOutcome::no_start;
            detail = state_.problem().problem();
            if (detail.empty())
                detail = fmt::format("{} from the orbit that was given", name_of(state_.continuation().outcome()));
            return false;
        }
        point = {};
        describe_here();
        if (is_beyond_bounds(tests_)) {
            outcome = BranchOutcome::bound;
            detail = "at the first orbit " + beyond_in_words(state_, point);
            ended_ = true;
            return false;
        }
        starts_simpler_ = is_degenerate(state_, orbit_here(), same_orbit);
        if (begins_at_bound())
            finish(BranchOutcome::bound, "");
        return true;
    }
    /// True when the first point lies on a bound of a parameter and the branch leads across it.
    bool begins_at_bound() {
        const BranchSettings& settings = state_.settings();
        const OrbitLayout& layout = state_.problem().equations().layout();
        const ContinuationPoint& begun = state_.continuation().point();
        const auto leaves = [&](std::size_t which, const auto& least, const auto& greatest) {
            const double rise = begun.tangent[layout.parameter(which)], value = begun.u[layout.parameter(which)];
            return (least && (value < *least || (rise < 0 && value <= *least))) ||
                   (greatest && (value > *greatest || (rise > 0 && value >= *greatest)));
        };
        if (leaves(0, settings.least, settings.greatest))
            return true;
        for (const FreeBounds& bounds : settings.free_bounds) {
            const auto at = std::find(settings.free.begin(), settings.free.end(), bounds.parameter);
            if (leaves(1 + static_cast<std::size_t>(at - settings.free.begin()), bounds.least, bounds.greatest))
                return true;
        }
        return false;
    }

    bool end(BranchOutcome how, std::string why) {
        finish(how, std::move(why));
        return false;
    }
    void finish(BranchOutcome how, std::string why) {
        ended_ = true;
        outcome = how;
        detail = std::move(why);
    }

    /// Continues a curve beyond a reordering from the motion of the model near the kept point. Guesses lie beside a
    /// curve of touches, on both sides, because on the curve round-off decides whether the surface is reached.
    bool continue_curve(const SpecialPoint& special) {
        constexpr double distances[] = {1e-4, 1e-5, 1e-3}; // in units of the scales
        constexpr double share = 0.1;                      // offset from the curve, as a share of the distance
        const double rise = special.tangent.parameters.empty() ? 0 : special.tangent.parameters.front();
        const std::vector<double> beside = keeps_touch() ? std::vector{share, -share} : std::vector{0.0};
        for (const double distance : distances)
            for (const int side : {1, -1})
                for (const double aside : beside) {
                    const auto guess = reordered_beyond(state_.system(), special, state_.settings(), side * distance,
                                                        aside * distance);
                    if (!guess || !state_.continue_curve(*guess, side * rise < 0 ? -1 : 1, special.arclength))
                        continue;
                    describe_here();
                    if (is_beyond_bounds(tests_))
                        continue;
                    if (point.solution.certificate.admissible)
                        return true;
                }
        return false;
    }
    /// Returns a message if the kept touch has reached an edge of its segment, beyond which it belongs to another
    /// segment; empty otherwise.
    std::string touch_at_edge() const {
        constexpr double at_edge = 1e-3; // share of the segment; the steps become very small before
        if (!keeps_touch())
            return "";
        const SpecialPoint& kept = *state_.settings().kept;
        const double duration = point.solution.orbit.durations[kept.segment];
        const bool at_start = kept.time < at_edge * duration;
        return at_start || kept.time > (1 - at_edge) * duration
                   ? fmt::format("the touch has come to the {} of segment {}", at_start ? "start" : "end",
                                 kept.segment + 1)
                   : "";
    }
    /// Continues a curve with the kept touch in the neighbouring segment. There the second derivative of the event
    /// function jumps, while its value and rate are continuous. Beyond the ends of a half orbit its image touches the
    /// image of the event.
    bool continue_in_next_segment() {
        constexpr double distances[] = {1e-4, 1e-3, 1e-2}; // in units of the scales
        constexpr double first_step = 1e-3;
        constexpr std::size_t most = 100;
        if (++reorderings_ > most)
            return false;
        OrbitProblem& problem = state_.problem();
        const std::size_t steps = point.step, old = state_.settings().kept->segment;
        const double share = state_.settings().kept->time / point.solution.orbit.durations[old];
        const Orbit& here = point.solution.orbit;
        const bool closes = share < 0.5 ? old == 0 : old + 1 == here.segments();
        const std::vector<double> u = problem.unknowns_of(here);
        if (!problem.evaluate(u) || (here.symmetry && closes && !state_.keep_image_of_touch(here)))
            return false;
        const std::vector<double> tangent = problem.unknowns_of(point.tangent);
        const double rise = point.tangent.parameters.front(), arclength = point.arclength;
        std::vector<Orbit> guesses;
        for (const double distance : distances) {
            std::vector<double> there = u;
            for (std::size_t i = 0; i < there.size(); ++i)
                there[i] += distance * tangent[i];
            guesses.push_back(problem.orbit_of(there));
        }
        for (const Orbit& guess : guesses) {
            if (!state_.continue_curve(guess, rise < 0 ? -1 : 1, arclength))
                continue;
            // The touch must continue at the opposite end, in the neighbouring segment or, if there is only one, in the
            // same.
            const SpecialPoint& kept = *state_.settings().kept;
            const bool at_other_end =
                (kept.time / guess.durations[kept.segment] < 0.5) != (share < 0.5) || kept.segment != old;
            if (!at_other_end)
                continue;
            BranchPoint beyond;
            std::vector<BranchTest> tests;
            if (!state_.describe(state_.continuation().point(), beyond, tests) ||
                !beyond.solution.certificate.admissible || is_beyond_bounds(tests))
                continue;
            point = std::move(beyond);
            point.step = steps;
            tests_ = std::move(tests);
            locator_.forget();
            state_.continuation().set_next_step(first_step);
            return true;
        }
        return false;
    }
    bool keeps_touch() const {
        const auto& kept = state_.settings().kept;
        return kept && kept->type == PointType::grazing && !kept->at_end;
    }

    /// Continues with orbits of another signature beyond a point. @return false when none are found
    bool continue_reordered(SpecialPoint& special) {
        constexpr std::size_t most = 100;
        if (++reorderings_ > most)
            return false;
        try {
            if (state_.settings().kept) {
                if (!continue_curve(special))
                    return false;
            } else {
                const BranchStart start = branches_at(state_.system(), special, state_.settings()).front();
                state_.continue_on(start, special.arclength);
            }
        } catch (const InputError& error) { // no orbit beyond: the branch ends
            special.detail += fmt::format("; {}", error.problem());
            return false;
        }
        locator_.forget();
        special.detail +=
            fmt::format("; goes on as {}", to_string(state_.model(), state_.problem().equations().signature()));
        describe_here();
        starts_simpler_ = is_degenerate(state_, orbit_here(), same_orbit);
        return true;
    }

    /// Removes points found at the start of a branch: a branch that begins at a special point of another must not
    /// report that point.
    void drop_points_at_start(double length) {
        constexpr double same_place = 1e-6;
        if (point.step == 1)
            std::erase_if(found, [&](const SpecialPoint& special) {
                return special.type != PointType::bound && special.arclength < same_place * length;
            });
    }

    /// True when a curve begins with inadmissible orbits, unless its first orbit is the limit of admissible ones.
    bool is_unphysical_curve(const BranchPoint& before) const {
        return state_.settings().kept && state_.settings().stop_when_unphysical &&
               !before.solution.certificate.admissible && !point.solution.certificate.admissible;
    }

    /// True when a curve of torus points that starts at a resonance goes to the side where the pair is real.
    bool is_beyond_torus(const std::vector<BranchTest>& at_start) const {
        const auto& kept = state_.settings().kept;
        if (!kept || kept->type != PointType::torus)
            return false;
        const auto value = [](const std::vector<BranchTest>& tests, PointType type) {
            const auto test =
                std::find_if(tests.begin(), tests.end(), [&](const auto& one) { return one.type == type; });
            return test == tests.end() ? 0 : test->value;
        };
        // The tests are the sum of the pair minus 2 and minus -2; the other resonance may be passed within one step.
        const bool from_one =
            std::abs(value(at_start, PointType::resonance_1)) < std::abs(value(at_start, PointType::resonance_2));
        return from_one ? value(tests_, PointType::resonance_1) > 0 : value(tests_, PointType::resonance_2) < 0;
    }

    /// True when a curve that starts at a contact of zero speed goes to the side of negative speeds.
    bool has_no_contact(const BranchPoint& before) const {
        constexpr double without_speed = 1e-6; // relative to the speed after the first step
        const auto& kept = state_.settings().kept;
        if (!kept || !state_.settings().stop_when_unphysical)
            return false;
        // The speed is zero all along: its sign is round-off.
        const bool without = is_grazing(kept->type) && kept->at_end;
        const auto& first = before.solution.certificate.approach_speeds;
        const auto& here = point.solution.certificate.approach_speeds;
        for (std::size_t s = 0; s < std::min(first.size(), here.size()); ++s)
            if (!(without && s == kept->segment) && here[s] < 0 &&
                std::abs(first[s]) < without_speed * std::abs(here[s]))
                return true;
        return false;
    }

    /// True when a curve of torus points ends, since the pair becomes real there.
    bool ends_torus_curve(const SpecialPoint& special) const {
        return state_.settings().kept && state_.settings().kept->type == PointType::torus &&
               (special.type == PointType::resonance_1 || special.type == PointType::resonance_2);
    }

    /// Moves the end of the branch to special point i.
    void end_at(std::size_t i) {
        found.resize(i + 1);
        point.solution = found[i].solution;
        point.parameter = found[i].parameter;
        point.arclength = found[i].arclength;
        point.tangent = found[i].tangent;
        point.monitors = found[i].monitors;
        point.stable = is_stable(point.solution);
    }
    /// Returns why orbits beyond special point i are inadmissible; empty if they are admissible. Admissibility is
    /// tested at the end of the step or, if another limit point follows, half-way to it, because the second may undo
    /// the effect of the first.
    std::string unphysical_beyond(std::size_t i) {
        constexpr double apart = 1e-6; // fraction of the step
        const LastStep step = state_.last_step();
        const double at = step.fraction(found[i].arclength);
        for (std::size_t j = i + 1; j < found.size() && !state_.settings().kept; ++j) {
            const double next = step.fraction(found[j].arclength);
            if (rank(found[j]) < 0 || next - at < apart)
                continue;
            ContinuationPoint between;
            BranchPoint there;
            std::vector<BranchTest> tests;
            const bool known =
                state_.continuation().between(0.5 * (at + next), between) && state_.describe(between, there, tests);
            state_.problem().evaluate(state_.continuation().point().u);
            if (!known)
                break;
            return there.solution.certificate.admissible ? "" : there.solution.certificate.reason;
        }
        return point.solution.certificate.admissible ? "" : point.solution.certificate.reason;
    }
    /// Ends the branch or changes its signature at the special points found.
    void end_or_reorder(bool was_admissible) {
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (found[i].type == PointType::bound) {
                end_at(i);
                return finish(BranchOutcome::bound, "");
            }
            if (is_degenerate(state_, found[i])) {
                found[i].detail = returned_to_simpler;
                end_at(i);
                return finish(BranchOutcome::returned, found[i].detail);
            }
            if (ends_torus_curve(found[i])) {
                end_at(i);
                return finish(BranchOutcome::stopped, "beyond, the two multipliers are real");
            }
            if (is_among(found[i].type, state_.settings().stop_at)) {
                end_at(i);
                return finish(BranchOutcome::stopped, std::string(name_of(found[i].type)));
            }
            const bool may_end = state_.settings().stop_when_unphysical && was_admissible && rank(found[i]) >= 0;
            const std::string reason = may_end ? unphysical_beyond(i) : "";
            if (!reason.empty()) {
                end_at(i);
                // With another signature, a kept point that belongs to a segment is only found again if it is a touch.
                const auto& kept = state_.settings().kept;
                const bool reordering = state_.settings().reorder &&
                                        (!kept || !kind_of(kept->type).limits || keeps_touch()) &&
                                        !is_grazing(found[i].type);
                if (!reordering || !continue_reordered(found[i])) {
                    end_at(i); // discard the attempts beyond
                    return finish(BranchOutcome::unphysical, reason);
                }
                if (is_beyond_bounds(tests_)) { // a bound lies just beyond the point
                    end_at(i);
                    finish(BranchOutcome::bound, "");
                }
                return;
            }
        }
        if (state_.settings().stop_when_unphysical && was_admissible && !point.solution.certificate.admissible)
            finish(BranchOutcome::unphysical, point.solution.certificate.reason);
    }

    BranchState state_;
    Orbit candidate_;
    std::vector<BranchTest> tests_; ///< tests at the last point
    PointLocator locator_;
    std::size_t reorderings_ = 0;
    bool is_kept_point_;          ///< a curve begins at its kept point, not at changed parameters
    bool returned_ = false;       ///< the last step has led to simpler orbits
    bool starts_simpler_ = false; ///< the first orbit is a repeated orbit, or symmetric but not given as a half orbit
    int attempts_ = 0;            ///< number of repetitions of the current step
    std::optional<SpecialPoint> equilibrium_; ///< the equilibrium ahead to which the orbits shrink, if any
    std::optional<HopfPoint> hopf_;           ///< Hopf point that may lie within the last attempted step
    std::optional<HopfPoint> approached_;     ///< Hopf point that the next step approaches
    std::optional<double> tried_;             ///< arclength at which this was tried last
    bool ended_ = true;
};

OrbitBranch::OrbitBranch(const System& system, const Orbit& candidate, const BranchSettings& settings) {
    const CurveBegin begun = begun_for_curve(system, candidate, settings);
    follower_ = std::make_unique<Follower>(system, begun.orbit, begun.settings);
}
OrbitBranch::~OrbitBranch() = default;
OrbitBranch::OrbitBranch(OrbitBranch&&) noexcept = default;

bool OrbitBranch::start() {
    begun_ = true;
    return follower_->start();
}
bool OrbitBranch::start_along(const OrbitDirection& direction, double distance) {
    for (const std::vector<double>& start : direction.starts)
        require_finite(start, "a number of the direction");
    require_finite(direction.durations, "a number of the direction");
    require_finite(direction.parameters, "a number of the direction");
    require_finite(distance, "the distance");
    begun_ = true;
    return follower_->start_along(direction, distance);
}
bool OrbitBranch::step() {
    if (!begun_)
        throw OrderError("a branch has no point to step from before it is started");
    return follower_->step();
}
const BranchPoint& OrbitBranch::point() const {
    if (!begun_)
        throw OrderError("a branch has no point before it is started");
    return follower_->point;
}
const std::vector<SpecialPoint>& OrbitBranch::found() const {
    return follower_->found;
}
BranchOutcome OrbitBranch::outcome() const {
    return follower_->outcome;
}
const std::string& OrbitBranch::detail() const {
    return follower_->detail;
}

bool ends_in_found(const OrbitBranch& branch) {
    return ends_at_point(branch.outcome()) && !branch.found().empty() &&
           branch.found().back().arclength == branch.point().arclength;
}

Branch follow_branch(const System& system, const Orbit& candidate, const BranchSettings& settings,
                     const BranchVisitor& visit) {
    OrbitBranch follower(system, candidate, settings);
    Branch branch;
    bool going = follower.start();
    while (going) {
        branch.points.push_back(follower.point());
        branch.special.insert(branch.special.end(), follower.found().begin(), follower.found().end());
        if (visit && !visit(follower.point(), follower.found())) {
            branch.outcome = BranchOutcome::stopped;
            return branch;
        }
        going = follower.step();
    }
    branch.outcome = follower.outcome();
    branch.detail = follower.detail();
    return branch;
}

} // namespace graze
