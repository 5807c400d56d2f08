#include "branch/branch_state.hpp"

#include "base/concatenated.hpp"
#include "branch/bounds.hpp"
#include "branch/branch_point_problem.hpp"
#include "branch/homoclinic_end.hpp"
#include "branch/neutral_direction.hpp"
#include "branch/orbit_quantity.hpp"
#include "branch/sensitivity_condition.hpp"
#include "graze/base/input_error.hpp"
#include "orbit/cut.hpp"
#include "orbit/newton.hpp"
#include "orbit/orbit_flow.hpp"
#include "orbit/shooting.hpp"
#include "orbit/solve_homoclinic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace graze {

namespace {

/// Growth of derivatives over one piece above which the segments are split anew.
constexpr double too_much_growth = 1e6;

} // namespace

BranchState::BranchState(const System& system, const Orbit& candidate, const BranchSettings& settings)
    : settings_(settings), simulation_(system, {}, {}, integration(settings.orbit.tolerance)) {
    const Model& model = system.model();
    settings_.validate(model);
    validate_orbit(model, candidate);
    require_kept_homoclinic(candidate, settings);
    if (candidate.cycle) // the model's own motion, which leads to other signatures, does not stay beside the cycle
        settings_.reorder = false;
    if (is_outside(settings, candidate.parameters[settings.parameter.place()]))
        throw InputError(fmt::format("the orbit's {} = {} lies outside the branch's bounds",
                                     model.independent_parameters()[settings.parameter.place()],
                                     candidate.parameters[settings.parameter.place()]),
                         "choose bounds on either side of it");
    if (!settings.monitors.empty())
        monitors_ =
            std::make_unique<OrbitMonitors>(system, candidate.signature, settings.monitors, settings.orbit.tolerance);
    if (keeps_branch_point() && settings.free.size() > 1)
        throw InputError("monitors cannot be fixed along a curve of branch points", "leave `fixed` out");
    // Fixed monitors without a value are held at that of the candidate, also in later problems of the branch.
    const std::vector<double> values =
        monitors_ && !settings.free.empty() ? (*monitors_)(candidate) : std::vector<double>();
    for (std::size_t m = 0; m < values.size(); ++m)
        if (settings_.monitors[m].fixed && !settings_.monitors[m].held)
            settings_.monitors[m].held = values[m];
    if (!make_problem(candidate))
        throw InputError(
            fmt::format("the condition of a point of type {} cannot be held there", short_name(settings.kept->type)),
            "choose another point");
}

/// Makes the equations and the continuation for an orbit. @return false where the kept point has no condition
bool BranchState::make_problem(const Orbit& orbit) {
    problem_ = keeps_branch_point() ? std::make_shared<BranchPointProblem>(simulation_, orbit, settings_)
                                    : std::make_shared<OrbitProblem>(simulation_, orbit, settings_);
    if (monitors_)
        hold_monitors();
    if (settings_.kept && !hold_kept(orbit))
        return false;
    hold_neutral_directions();
    rises_ = {};
    problem_->hold(held_);
    ContinuationOptions options = settings_.continuation;
    // A kept touch differs from a contact by much less than the accuracy of orbits, so Newton's method must be more
    // accurate.
    constexpr double kept_accuracy = 1e-13;
    if (settings_.kept)
        options.accuracy = std::min(options.accuracy, kept_accuracy);
    continuation_ = std::make_unique<Continuation>(problem_, options);
    return true;
}

/// Adds the conditions of fixed monitors: compiled once, then moved to the segments of each new signature.
void BranchState::hold_monitors() {
    std::size_t at = 0;
    for (std::size_t m = 0; m < settings_.monitors.size(); ++m) {
        const Monitor& monitor = settings_.monitors[m];
        if (!monitor.fixed)
            continue;
        if (at == held_.size())
            held_.push_back(std::make_unique<OrbitQuantity>(OrbitQuantity::of_monitor(
                problem_->equations(), monitor, monitors_->segment(m), monitor.held.value())));
        held_[at++]->set_segment(monitors_->segment(m));
    }
}

/// Adds phase conditions, made anew for each problem, for free parameters that no other condition determines: those
/// that unfold a family with several conserved quantities.
void BranchState::hold_neutral_directions() {
    if (settings_.unfolded == 0)
        return;
    const std::size_t others = settings_.fixed_monitors() + kept_conditions();
    held_.resize(others);
    const std::size_t count = settings_.free.size() - others;
    for (std::size_t i = 0; i < count; ++i)
        held_.push_back(std::make_unique<NeutralDirection>(problem_->equations(), i, count));
}

/// Adds the condition of the kept point, made anew for each problem because it may depend on the pieces of segments.
/// @return false where it has none
bool BranchState::hold_kept(const Orbit& orbit) {
    SpecialPoint& kept = *settings_.kept;
    kept.solution.orbit = orbit;
    if (keeps_branch_point()) // BranchPointProblem contains the condition
        return true;
    std::unique_ptr<OrbitCondition> condition;
    if (rule_of(kept.type).condition && problem_->evaluate(problem_->unknowns_of(orbit)))
        condition = rule_of(kept.type).condition(problem_->equations(), problem_->evaluation(), kept);
    held_.resize(settings_.fixed_monitors());
    if (!condition)
        return false;
    held_.push_back(std::move(condition));
    if (!settings_.kept_too)
        return true;
    held_.push_back(SensitivityCondition::of_touch(problem_->equations(), problem_->evaluation(), kept));
    return held_.back() != nullptr;
}

std::size_t BranchState::kept_conditions() const {
    return (settings_.kept && !keeps_branch_point() ? 1U : 0U) + (settings_.kept_too ? 1U : 0U);
}

/// Updates the time of the kept touch: that of the minimum of its event function that is nearest to zero.
void BranchState::update_kept_time(const OrbitSolution& solution) {
    const auto held = held_limit_of(settings_);
    if (!held || held->kind != HeldLimit::Kind::touch)
        return;
    SpecialPoint& kept = *settings_.kept;
    if (const auto touch = touch_in(solution.certificate, kept.segment, kept.event))
        kept.time = touch->time;
}

/// Finds the kept touch in an orbit of another signature that nearly touches.
bool BranchState::find_touch(const Orbit& orbit) {
    OrbitProblem problem(simulation_, orbit, settings_);
    if (!problem.evaluate(problem.unknowns_of(orbit)))
        return false;
    SpecialPoint& kept = *settings_.kept;
    const auto touch = nearest_touch(certify(problem.equations(), problem.evaluation()), kept.event);
    if (touch) {
        kept.segment = touch->segment;
        kept.time = touch->time;
    }
    return touch.has_value();
}

bool BranchState::keep_image_of_touch(const Orbit& orbit) {
    SpecialPoint& kept = *settings_.kept;
    const std::size_t mode = orbit.signature[kept.segment].mode;
    const Transition* contact = model().find_transition(mode, kept.event);
    if (!contact)
        return false;
    const auto transition = static_cast<std::size_t>(contact - model().transitions.data());
    try {
        const Segment image = image_of(system(), orbit.symmetry.value(), {mode, SegmentEnd::event, transition}, orbit);
        kept.event = model().transitions[image.index].event;
    } catch (const InputError&) { // the event has no image
        return false;
    }
    return true;
}

SpecialPoint special_of_type(PointType type, const BranchPoint& there) {
    SpecialPoint special;
    special.type = type;
    special.solution = there.solution;
    special.parameter = there.parameter;
    special.arclength = there.arclength;
    special.tangent = there.tangent;
    special.monitors = there.monitors;
    return special;
}

LastStep BranchState::last_step() const {
    const double from = arclength(continuation_->previous().arclength);
    return {from, arclength(continuation_->point().arclength) - from};
}

double BranchState::distance_from(std::span<const double> u) const {
    return (vector_of(u) - vector_of(continuation_->point().u)).cwiseQuotient(vector_of(problem_->scales())).norm();
}

std::vector<double> BranchState::rates_at_sections() {
    problem_->evaluate(continuation_->point().u);
    return passing_rates(problem_->equations(), problem_->evaluation());
}

std::vector<double> BranchState::rates_at(const Orbit& orbit, std::size_t segment) const {
    return system().mode(orbit.signature[segment].mode).rates(concatenated(orbit.starts[segment], orbit.parameters));
}

std::optional<DescribedPoint> BranchState::describe(const ContinuationPoint& at, std::optional<PointType> only) {
    OrbitEquations& equations = problem_->equations();
    if (!problem_->evaluate(at.u))
        return std::nullopt;
    const OrbitEvaluation& evaluation = problem_->evaluation();
    BranchPoint result;
    result.solution.outcome = OrbitOutcome::converged;
    result.solution.iterations = at.iterations;
    result.solution.orbit = problem_->orbit_of(at.u);
    const bool wants_all = settings_.unfolded > 0 || std::ranges::any_of(settings_.monitors, [](const Monitor& one) {
                               return one.kind == Monitor::Kind::multiplier;
                           });
    describe_orbit(equations, evaluation, result.solution, held_limit_of(settings_),
                   wants_all ? Spectrum::all : Spectrum::leading);
    mark_neutral(result.solution, settings_.unfolded);
    update_kept_time(result.solution);
    result.parameter = at.u[problem_->parameter_place()];
    result.tangent = problem_->direction_of(at.tangent);
    result.monitors = monitors_ ? (*monitors_)(result.solution.orbit) : std::vector<double>();
    if (monitors_)
        measure_multipliers(settings_.monitors, result.solution.multipliers, result.monitors);
    result.arclength = arclength(at.arclength);
    result.stable = is_stable(result.solution);
    std::vector<Degeneracy> degeneracies;
    if (settings_.kept && !keeps_branch_point())
        degeneracies =
            held_[settings_.fixed_monitors() + kept_conditions() - 1]->degeneracies(equations, evaluation, only);
    const auto rise = rise_of_family(true);
    std::vector<BranchTest> tests = branch_tests({equations, evaluation, result.solution, at.tangent, at.determinant,
                                                  result.monitors, settings_, degeneracies, rise ? &*rise : nullptr});
    return DescribedPoint{std::move(result), std::move(tests)};
}

std::optional<DescribedPoint> BranchState::describe_between(double fraction, std::optional<PointType> only,
                                                            std::vector<ContinuationPoint>* known) {
    ContinuationPoint at;
    if (!continuation_->between(fraction, at,
                                known ? std::span(std::as_const(*known)) : std::span<const ContinuationPoint>()))
        return std::nullopt;
    if (known)
        known->push_back(at);
    return describe(at, only);
}

std::optional<double> BranchState::error_of(const Orbit& orbit, const OrbitDirection& tangent) {
    if (!settings_.free.empty())
        return std::nullopt;
    if (!tighter_) {
        tighter_.emplace(system(), std::vector<Probe>(), std::vector<Expression>(),
                         integration(0.01 * settings_.orbit.tolerance));
        tighter_flow_.emplace(flow_of(*tighter_));
    }
    const auto size_of = [](OrbitProblem& problem, std::span<const double> step) {
        const double error = vector_of(step).cwiseQuotient(vector_of(problem.scales())).cwiseAbs().maxCoeff();
        return std::isfinite(error) ? std::optional(error) : std::nullopt;
    };
    // With the derivatives that are known, where these equations can be compared with another flow.
    OrbitProblem& here = *problem_;
    std::vector<double> step(here.unknowns());
    if (here.has_chords()) {
        if (!here.evaluate(here.unknowns_of(orbit)) ||
            !here.correction_by(*tighter_flow_, here.row_of(here.unknowns_of(tangent)), step))
            return std::nullopt;
        return size_of(here, step);
    }
    OrbitProblem problem(*tighter_, orbit, settings_.parameter);
    step.resize(problem.unknowns());
    if (!problem.evaluate(problem.unknowns_of(orbit)) ||
        !problem.solve(problem.row_of(problem.unknowns_of(tangent)), 0, false, step, nullptr))
        return std::nullopt;
    return size_of(problem, step);
}

SecondVariation& BranchState::second_variation() {
    if (!second_variation_)
        second_variation_.emplace(problem_->equations());
    return *second_variation_;
}

bool BranchState::is_in_family(const Orbit& orbit) {
    if (!settings_.free.empty() || !problem_->evaluate(problem_->unknowns_of(orbit)) ||
        problem_->evaluation().system.undetermined() == 0)
        return false;
    Shooting shooting(simulation_, orbit, {});
    OrbitEvaluation at = shooting.evaluation();
    return shooting.evaluate(shooting.unknowns_of(orbit), at) && graze::is_in_family(shooting, at);
}

std::optional<Eigen::RowVectorXd> BranchState::rise_of_family(bool conserved) {
    if (!is_family())
        return std::nullopt;
    const auto is_wanted = [&](const Monitor& one) {
        return conserved ? one.kind == Monitor::Kind::conserved : &one == &settings_.monitors.back();
    };
    const auto monitor = std::ranges::find_if(settings_.monitors, is_wanted);
    if (monitor == settings_.monitors.end())
        return std::nullopt;
    std::optional<OrbitQuantity>& quantity = rises_[conserved ? 1 : 0];
    if (!quantity)
        quantity.emplace(OrbitQuantity::of_monitor(
            problem_->equations(), *monitor,
            monitors_->segment(static_cast<std::size_t>(monitor - settings_.monitors.begin())), 0));
    if (!quantity->evaluate(problem_->equations(), problem_->evaluation()))
        return std::nullopt;
    return quantity->gradient();
}

bool BranchState::start_in_family(std::span<const double> u) {
    if (!is_family() || !problem_->evaluate(u))
        return false;
    const auto rise = rise_of_family(false);
    if (!rise)
        return false;
    const Eigen::RowVectorXd row = settings_.direction * *rise;
    return continuation_->start_at(u, {row.data(), static_cast<std::size_t>(row.size())});
}

bool BranchState::pieces_need_renewal() {
    const OrbitEquations& equations = problem_->equations();
    const OrbitLayout& layout = equations.layout();
    if (equations.contacts_need_renewal(problem_->evaluation()) || distances_need_renewal() || turns_need_renewal())
        return true;
    for (std::size_t k = 0; k < layout.pieces(); ++k) {
        const OrbitEvaluation& at = problem_->evaluation();
        const Eigen::VectorXd sizes = at.scales.head(static_cast<Eigen::Index>(layout.states()));
        const Eigen::MatrixXd flow = at.pieces[k].flow.leftCols(sizes.size());
        if ((sizes.cwiseInverse().asDiagonal() * flow * sizes.asDiagonal()).norm() > too_much_growth * growth_)
            return true;
        if (layout.is_last(k) && !layout.accumulates(k) && k > layout.first_piece(layout.segment_of(k)) &&
            continuation_->point().u[layout.duration_of(k)] < 0.5 * equations.fixed_duration(k))
            return true;
    }
    return false;
}

/// Removes from a direction the component along the motion, since a new cut is laid across it. That component only
/// shifts starts along their orbits and could reverse the direction where it dominates.
OrbitDirection BranchState::across_cuts(const Orbit& orbit, OrbitDirection direction) const {
    if (orbit.signature.front().end != SegmentEnd::cut)
        return direction;
    const std::size_t count = orbit.segments();
    std::vector<double> times(count, 0.0);
    for (std::size_t k = 0; k < count; ++k) {
        const std::vector<double> rates = rates_at(orbit, k);
        double along = 0, all = 0;
        for (std::size_t i = 0; i < rates.size(); ++i) {
            if (model().states[i].drifting)
                continue;
            const double unit = problem_->scales()[i] * problem_->scales()[i];
            along += direction.starts[k][i] * rates[i] / unit;
            all += rates[i] * rates[i] / unit;
        }
        times[k] = all > 0 ? along / all : 0;
        for (std::size_t i = 0; i < rates.size(); ++i)
            direction.starts[k][i] -= times[k] * rates[i];
    }
    for (std::size_t k = 0; k < count; ++k)
        direction.durations[k] += times[k] - times[(k + 1) % count];
    return direction;
}

/// True when a homoclinic orbit should begin and end at other distances from its saddle.
bool BranchState::distances_need_renewal() const {
    const HomoclinicEnds* const ends = problem_->equations().homoclinic_ends();
    return ends && !renewal_was_tried() && graze::distances_need_renewal(*ends);
}

/// True when an orbit that is homoclinic to a cycle should have other turns beside it.
bool BranchState::turns_need_renewal() const {
    const CycleEnds* const ends = problem_->equations().cycle_ends();
    return ends && !renewal_was_tried() &&
           graze::turns_need_renewal(*ends, orbit(), problem_->evaluation().pieces.back().after);
}

/// True shortly after a homoclinic orbit could not begin and end at other distances.
bool BranchState::renewal_was_tried() const {
    constexpr double pause = 10; // steps of the greatest length
    return arclength(continuation_->point().arclength) < not_renewed_at_ + pause * settings_.continuation.largest_step;
}

/// Continues with other turns beside the cycle. @return false, with nothing changed, where that does not start
bool BranchState::renew_turns(const BranchPoint& from) {
    const CycleEnds& ends = *problem_->equations().cycle_ends();
    const Orbit& orbit = from.solution.orbit;
    const TurnsChanged changed = with_suitable_turns(ends, orbit, problem_->evaluation().pieces.back().after);
    return replace_orbit(from, {changed.orbit, changed.of(from.tangent)}, Guess::inexact);
}

/// Newton's method across a direction. @return false where it does not converge
bool BranchState::correct(std::vector<double>& u, const OrbitDirection& direction) {
    constexpr int iterations = 8;
    constexpr double solved = 1e-8, farthest = 0.1; // corrections in units of the scales
    std::vector<double> step(u.size());
    double before = farthest;
    for (int i = 0; i < iterations; ++i) {
        if (!problem_->evaluate(u) ||
            !problem_->solve(problem_->row_of(problem_->unknowns_of(direction)), 0, false, step, nullptr))
            return false;
        const double size = vector_of(step).cwiseQuotient(vector_of(problem_->scales())).cwiseAbs().maxCoeff();
        if (!(size < farthest))
            return false;
        if (size <= solved && size >= 0.5 * before) // corrections that do not shrink are round-off
            return true;
        entries_of(u) += vector_of(step);
        before = size;
    }
    return before <= solved;
}

void BranchState::renew_pieces(const BranchPoint& from) {
    if (turns_need_renewal()) {
        if (!renew_turns(from))
            not_renewed_at_ = from.arclength; // keep the old ones for some time
        return;
    }
    if (distances_need_renewal()) {
        const auto other = at_suitable_distances(*this, from.solution.orbit, from.tangent);
        if (!other || !restart(*other, from.tangent, from.arclength))
            not_renewed_at_ = from.arclength; // keep the old ones for some time
        return;
    }
    const bool grown = pieces_need_renewal();
    const std::size_t pieces = problem_->equations().layout().pieces();
    const bool renewed = restart(from.solution.orbit, across_cuts(from.solution.orbit, from.tangent), from.arclength);
    if (grown && problem_->equations().layout().pieces() <= pieces)
        growth_ *= 10; // no improvement: test again later
    if (!renewed)
        growth_ *= 10; // keep the old pieces for some time
}

/// Continues from a solution with new equations. @return false when the continuation does not start there; then nothing
/// changes
bool BranchState::restart(const Orbit& orbit, const OrbitDirection& direction, double arclength, Guess guess) {
    const double length = continuation_->next_step();
    const std::optional<SpecialPoint> kept = settings_.kept;
    std::shared_ptr<OrbitProblem> old = std::move(problem_);
    std::unique_ptr<Continuation> old_continuation = std::move(continuation_);
    const auto first = held_.begin() + static_cast<std::ptrdiff_t>(settings_.fixed_monitors());
    std::vector<std::unique_ptr<OrbitCondition>> old_kept(std::make_move_iterator(first),
                                                          std::make_move_iterator(held_.end()));
    held_.erase(first, held_.end());
    const bool holds = make_problem(orbit);
    std::vector<double> u = problem_->unknowns_of(orbit);
    if (!holds || (guess == Guess::inexact && !correct(u, direction)) || !problem_->evaluate(u) ||
        !continuation_->start_at(u, problem_->row_of(problem_->unknowns_of(direction)))) {
        problem_ = std::move(old);
        continuation_ = std::move(old_continuation);
        settings_.kept = kept;
        if (settings_.kept || !old_kept.empty()) {
            held_.resize(settings_.fixed_monitors());
            std::move(old_kept.begin(), old_kept.end(), std::back_inserter(held_));
            problem_->hold(held_);
        }
        return false;
    }
    arclength_ = arclength;
    continuation_->set_next_step(length);
    return true;
}

/// True when sections must be kept: monitors refer to starts or ends of segments, or the kept point lies in a segment
/// that would be merged.
bool BranchState::needs_sections(const Orbit& orbit, const Orbit& without) const {
    return refer_to_segments(settings_.monitors) ||
           (settings_.kept && kind_of(settings_.kept->type).limits && orbit.segments() != without.segments());
}

bool BranchState::leave_sections(const BranchPoint& from) {
    const Orbit& orbit = from.solution.orbit;
    const auto uncut = without_sections(model(), orbit, from.tangent);
    return uncut && uncut->orbit.signature != orbit.signature && replace_orbit(from, *uncut);
}

bool BranchState::replace_orbit(const BranchPoint& from, const UncutOrbit& same, Guess guess) {
    const Orbit& orbit = from.solution.orbit;
    if (needs_sections(orbit, same.orbit))
        return false;
    if (monitors_)
        monitors_->set_signature(same.orbit.signature);
    if (restart(same.orbit, same.direction, from.arclength, guess))
        return true;
    if (monitors_)
        monitors_->set_signature(orbit.signature);
    return false;
}

bool BranchState::begin_without_sections(const Orbit& candidate) {
    OrbitDirection none;
    none.starts.assign(candidate.segments(), std::vector<double>(model().states.size(), 0.0));
    none.durations.assign(candidate.segments(), 0.0);
    const auto uncut = without_sections(model(), candidate, none);
    if (!uncut || uncut->orbit.signature == candidate.signature || needs_sections(candidate, uncut->orbit))
        return false;
    if (monitors_)
        monitors_->set_signature(uncut->orbit.signature);
    return make_problem(uncut->orbit) &&
           continuation_->start(problem_->unknowns_of(uncut->orbit), problem_->parameter_place(), settings_.direction);
}

void BranchState::continue_on(const BranchStart& start, double arclength) {
    if (monitors_)
        monitors_->set_signature(start.orbit.signature);
    const double length = continuation_->next_step();
    arclength_ = arclength;
    const bool holds = make_problem(start.orbit);
    const std::vector<double> u = problem_->unknowns_of(start.orbit);
    if (!holds || !problem_->evaluate(u) ||
        !continuation_->start_at(u, problem_->row_of(problem_->unknowns_of(start.direction))))
        throw InputError("the continuation does not start there", "choose another point");
    continuation_->set_next_step(length);
}

bool BranchState::continue_curve(const Orbit& guess, int direction, double arclength) {
    if (monitors_)
        monitors_->set_signature(guess.signature);
    const double length = continuation_->next_step();
    arclength_ = arclength;
    const auto held = held_limit_of(settings_);
    if ((held && held->kind == HeldLimit::Kind::touch && !find_touch(guess)) || !make_problem(guess) ||
        !continuation_->start(problem_->unknowns_of(guess), problem_->parameter_place(), direction))
        return false;
    continuation_->set_next_step(length);
    return true;
}

} // namespace graze
