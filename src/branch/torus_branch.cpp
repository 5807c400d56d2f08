#include "graze/branch/torus_branch.hpp"

#include "base/enumerator_name.hpp"
#include "branch/bounds.hpp"
#include "branch/phase_locking.hpp"
#include "branch/resonances.hpp"
#include "branch/tongue_crossing.hpp"
#include "branch/torus_amplitude.hpp"
#include "branch/torus_facts.hpp"
#include "branch/turning_pair.hpp"
#include "graze/base/input_error.hpp"
#include "orbit/shooting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <utility>

namespace graze {

namespace {

/// Corrections longer than this share of a step may lead to other tori, or to the orbit, and are rejected.
constexpr double largest_correction = 0.5;
void require_torus_point(const SpecialPoint& point) {
    const std::string remedy = "start from a torus point (NS) of a branch of orbits";
    if (point.type != PointType::torus)
        throw InputError(
            fmt::format("no tori begin at a point of type {} ({})", short_name(point.type), name_of(point.type)),
            remedy);
    const Signature& signature = point.solution.orbit.signature;
    if (std::ranges::any_of(signature, [](const Segment& one) { return one.end == SegmentEnd::chatter; }))
        throw InputError("tori of motions with complete chatter are not followed", remedy);
}

void require_extremes(const std::vector<Monitor>& monitors) {
    for (const Monitor& one : monitors)
        if (!is_extreme(one))
            throw InputError(fmt::format("monitor '{}' has no single value on a torus", one.name),
                             "choose a maximum or a minimum");
}

/// Refuses orbits of which an active state does not return, as the footholds of a walk, which matter by their distance.
void require_return(const Model& model, const TorusSetting& setting, const SignatureReturn::Image& image) {
    constexpr double same = 1e-6; // in the scales of the states
    for (const std::size_t i : setting.active)
        if (!(std::abs(image.after[i] - image.motion.starts[0][i]) <= same * setting.scales[index(i)]))
            throw InputError(fmt::format("state '{}' does not return, but only its distance from other states: tori of "
                                         "such motions are not followed",
                                         model.states[i].name),
                             "write the model in such distances");
}

} // namespace

void TorusResolution::validate() const {
    if (harmonics < fewest_harmonics || harmonics > most_harmonics)
        throw InputError(fmt::format("{} harmonics are out of range", harmonics),
                         fmt::format("choose between {} and {}", fewest_harmonics, most_harmonics));
    if (!(tail >= least_tail && tail <= largest_tail))
        throw InputError(fmt::format("the tail {} of the harmonics is out of range", tail),
                         fmt::format("choose between {} and {}", least_tail, largest_tail));
}

std::string_view name_of(TorusOutcome outcome) {
    constexpr std::string_view names[] = {"going",      "no start",     "steps",          "bound",
                                          "unphysical", "not resolved", "no convergence", "undefined"};
    return enumerator_name(names, outcome, "");
}

class TorusBranch::Follower {
public:
    Follower(const System& system, const SpecialPoint& point, const BranchSettings& settings,
             const TorusResolution& resolution)
        : simulation_(system, {}, {}, {.tolerance = settings.orbit.tolerance}), settings_(settings),
          resolution_(resolution) {
        require_torus_point(point);
        resolution.validate();
        settings.validate(system.model());
        require_extremes(settings.monitors);
        if (settings.family || !settings.free.empty())
            throw InputError("tori are followed in one parameter, and not along a family", "name one parameter alone");
        settings_.continuation.accuracy = std::max(settings.continuation.accuracy, settings.orbit.accuracy);
        const double at = point.solution.orbit.parameters[settings.parameter.place()];
        if (is_beyond_bounds(at))
            throw InputError(fmt::format("the torus point lies at {:.10g}, outside the bounds", at),
                             "widen the bounds of the parameter");
        // Rotation numbers and growth are those of whole returns, as the period is: a symmetry is not made use of.
        const Orbit whole = whole_orbit(system, point.solution.orbit);
        set_up(whole);
        monitors_ =
            std::make_unique<OrbitMonitors>(system, whole.signature, settings.monitors, settings.orbit.tolerance);
    }

    bool start();
    bool step();
    const TorusPoint& point() const { return point_; }
    const std::vector<PhaseLocking>& last_locking() const { return last_locking_; }
    TorusOutcome outcome() const { return outcome_; }
    const std::string& detail() const { return detail_; }

private:
    /// Bounds may begin at the torus point, which is known to its accuracy.
    bool is_beyond_bounds(double at) const {
        constexpr double accuracy = 1e-8; // share of the range
        const double range = settings_.least && settings_.greatest ? *settings_.greatest - *settings_.least : 0,
                     off = accuracy * std::max(range, std::abs(at));
        return is_outside(settings_, at) && is_outside(settings_, at - off) && is_outside(settings_, at + off);
    }

    bool end(TorusOutcome outcome, std::string detail) {
        outcome_ = outcome;
        detail_ = std::move(detail);
        return false;
    }

    void set_up(const Orbit& orbit);
    bool refine();
    std::optional<ContinuationPoint> along(double distance, const std::vector<double>& guess = {});
    std::optional<ContinuationPoint> resolved_along(double distance);
    std::optional<ContinuationPoint> next_point(double& length);
    bool end_without_step();
    TorusPoint described(const ContinuationPoint& at) const;
    bool end_at_bound(double length, double beyond);
    bool end_at_grazing(double length, std::string reason);
    bool take(const ContinuationPoint& at, TorusPoint next);
    bool cross_tongue(const Torus& from, bool is_first);
    void scale_parameter();

    Simulation simulation_;
    BranchSettings settings_;
    TorusResolution resolution_;
    TorusSetting setting_;
    std::unique_ptr<OrbitMonitors> monitors_;
    std::unique_ptr<LockingSearch> lockings_;
    std::shared_ptr<TorusProblem> problem_;
    /// Unknowns from which the next step is made, its direction, and the circle to which the phase condition refers.
    std::vector<double> origin_, direction_, reference_;
    double next_length_ = 0, first_parameter_ = 0;
    bool unresolved_ = false; ///< the last attempt needed more harmonics than are allowed
    TorusPoint point_;
    std::vector<PhaseLocking> last_locking_;
    TorusOutcome outcome_ = TorusOutcome::no_start;
    std::string detail_;
};

/// Prepares the circles along the vector of the multipliers.
void TorusBranch::Follower::set_up(const Orbit& orbit) {
    constexpr std::size_t harmonics = 3; // at first: only strong resonances make these equations singular
    const double range = settings_.least && settings_.greatest ? *settings_.greatest - *settings_.least : 0;
    Shooting shooting(simulation_, orbit, {settings_.parameter}, {range});
    OrbitEvaluation at = shooting.evaluation();
    if (!shooting.evaluate(shooting.unknowns_of(orbit), at))
        throw InputError("the orbit cannot be followed: " + at.problem, "choose another torus point");
    setting_.active = at.active;
    setting_.scales = at.scales.head(index(orbit.starts[0].size()));
    constexpr double share = 0.5; // of the range
    setting_.parameter_scale = std::max(at.scales[index(shooting.layout().parameter(0))], share * range);
    setting_.parameter = settings_.parameter;
    setting_.back = std::make_shared<SignatureReturn>(simulation_, orbit, settings_.parameter, setting_.scales);
    const double parameter = first_parameter_ = orbit.parameters[settings_.parameter.place()];
    const auto image = setting_.back->follow(orbit.starts[0], parameter, orbit.durations);
    if (!image)
        throw InputError("the orbit cannot be followed: " + setting_.back->problem(), "choose another torus point");
    require_return(simulation_.model(), setting_, *image);
    const Eigen::VectorXd scales = setting_.scales(setting_.active);
    const TurningPair pair = turning_pair(scales.cwiseInverse().asDiagonal() *
                                          image->derivatives(setting_.active, setting_.active) * scales.asDiagonal());
    scale_by_amplitude(setting_, *image, parameter, pair);
    lockings_ = std::make_unique<LockingSearch>(simulation_, settings_, setting_);
    problem_ = std::make_shared<TorusProblem>(setting_, std::min(harmonics, resolution_.harmonics));
    origin_.assign(problem_->unknowns(), 0.0);
    direction_ = origin_;
    for (std::size_t a = 0; a < setting_.active.size(); ++a) {
        origin_[problem_->place_of(0, a)] = orbit.starts[0][setting_.active[a]];
        direction_[problem_->place_of(1, a)] = scales[index(a)] * pair.vector[index(a)].real();
        direction_[problem_->place_of(2, a)] = -scales[index(a)] * pair.vector[index(a)].imag();
    }
    origin_[problem_->rotation_place()] = std::arg(pair.multiplier) / (2 * std::numbers::pi);
    origin_[problem_->parameter_place()] = parameter;
    reference_ = direction_;
}

/// Takes more harmonics for the next step. @return false when no more are allowed
bool TorusBranch::Follower::refine() {
    const std::size_t now = problem_->harmonics(),
                      more = std::min(now + std::max<std::size_t>(4, now / 2), resolution_.harmonics);
    if (more == now)
        return false;
    auto finer = problem_->with_harmonics(more);
    for (std::vector<double>* numbers : {&origin_, &direction_, &reference_})
        *numbers = finer->extended(*numbers);
    problem_ = std::move(finer);
    return true;
}

/// Returns the torus at a distance from the origin of the step, in the plane across its direction.
/// @param guess in that plane; empty: the point along the direction
std::optional<ContinuationPoint> TorusBranch::Follower::along(double distance, const std::vector<double>& guess) {
    Continuation there(problem_, settings_.continuation);
    problem_->accept(reference_);
    std::vector<double> from = guess.empty() ? origin_ : guess;
    if (!guess.empty())
        entries_of(from) -= distance / problem_->length_of(direction_) * vector_of(direction_);
    if (!there.start_along(from, direction_, distance))
        return std::nullopt;
    ContinuationPoint point = there.point();
    std::vector<double> off = point.u;
    entries_of(off) -= vector_of(origin_) + distance / problem_->length_of(direction_) * vector_of(direction_);
    off[problem_->rotation_place()] = 0; // not determined by the orbit without a torus
    if (!(problem_->length_of(off) <= largest_correction * distance))
        return std::nullopt;
    point.arclength = point_.arclength + distance;
    return point;
}

/// The same with as many harmonics as it needs.
std::optional<ContinuationPoint> TorusBranch::Follower::resolved_along(double distance) {
    unresolved_ = false;
    auto there = along(distance);
    while (there && !is_resolved(*problem_, there->u, resolution_)) {
        unresolved_ = !refine();
        there = unresolved_ ? std::nullopt : along(distance, problem_->extended(there->u));
    }
    return there;
}

TorusPoint TorusBranch::Follower::described(const ContinuationPoint& at) const {
    problem_->evaluate(at.u);
    TorusPoint point;
    point.torus = problem_->torus_of(at.u);
    point.facts = facts_of(*problem_, at.u, simulation_);
    if (point.facts.admissible)
        point.monitors = extremes_of(*problem_, at.u, *monitors_);
    point.motion = problem_->images().front().motion;
    point.parameter = at.u[problem_->parameter_place()];
    point.arclength = at.arclength;
    point.stable = point.facts.growth < 1;
    point.iterations = at.iterations;
    return point;
}

bool TorusBranch::Follower::take(const ContinuationPoint& at, TorusPoint next) {
    if (next.passed.empty())
        next.passed = lockings_->between(problem_->torus_of(origin_), next.torus);
    point_ = std::move(next);
    origin_ = reference_ = at.u;
    direction_ = at.tangent;
    scale_parameter();
    return true;
}

/// A parameter that is zero at the orbit has the size of its change.
void TorusBranch::Follower::scale_parameter() {
    const double change = std::abs(point_.parameter - first_parameter_),
                 scale =
                     std::max({problem_->scales()[problem_->parameter_place()], std::abs(point_.parameter), change});
    problem_->set_parameter_scale(scale);
    lockings_->set_parameter_scale(scale);
}

/// Goes on beyond a tongue that the branch has entered. @return false where it is none, or has no tori beyond
bool TorusBranch::Follower::cross_tongue(const Torus& from, bool is_first) {
    const double turning = is_first ? 0 : direction_[problem_->rotation_place()],
                 direction = is_first ? 0 : direction_[problem_->parameter_place()];
    // The rotation number of the branch, continued along its tangent.
    const auto forecast = [&](const Resonance& resonance) -> std::optional<Torus> {
        constexpr double farthest = 1; // in scaled unknowns
        const double distance = (resonance.value() - from.rotation) / turning;
        if (is_first || !(distance > 0 && distance < farthest))
            return std::nullopt;
        std::vector<double> there = origin_;
        entries_of(there) += distance * vector_of(direction_);
        return problem_->torus_of(there);
    };
    auto tongue =
        TongueCrossing(*lockings_, settings_, resolution_).cross(from, *problem_, turning, direction, forecast);
    if (!tongue)
        return false;
    const PhaseLocking& locking = tongue->locking;
    const auto without_torus = [&](const std::string& why) {
        detail_ = fmt::format("the torus locks at the rotation number {}/{}: {}", locking.resonance.numerator,
                              locking.resonance.denominator, why);
        last_locking_ = {locking};
        return false;
    };
    if (!tongue->equations)
        return without_torus(tongue->problem);
    const auto before = std::exchange(problem_, tongue->equations);
    tongue->beyond.arclength =
        point_.arclength + std::abs(tongue->beyond.u[problem_->parameter_place()] - lockings_->parameter_of(from)) /
                               problem_->scales()[problem_->parameter_place()];
    TorusPoint next = described(tongue->beyond);
    if (!next.facts.admissible) {
        problem_ = before;
        return without_torus("beyond, " + next.facts.reason);
    }
    // Other resonances up to the tongue, and beyond it.
    const auto at_tongue = [&](Torus torus, const SpecialPoint& end) {
        torus.rotation = locking.resonance.value();
        torus.parameters[settings_.parameter.place()] = end.parameter;
        return torus;
    };
    std::vector<PhaseLocking> passed = lockings_->between(from, at_tongue(from, locking.ends.front()));
    std::erase_if(passed, [&](const PhaseLocking& one) { return one.resonance == locking.resonance; });
    passed.push_back(locking);
    const auto further = lockings_->between(at_tongue(next.torus, locking.ends.back()), next.torus);
    passed.insert(passed.end(), further.begin(), further.end());
    next.passed = std::move(passed);
    outcome_ = TorusOutcome::going;
    next_length_ = settings_.continuation.first_step;
    return take(tongue->beyond, std::move(next));
}

bool TorusBranch::Follower::start() {
    constexpr double turned = 0.02; // change of the rotation number that a small torus does not exceed
    const double first = settings_.continuation.first_step;
    for (const double share : {1.0, 2.0, 4.0, 8.0, 16.0, 0.5, 0.25, 0.125}) {
        const auto there = resolved_along(share * first);
        const std::size_t place = problem_->rotation_place();
        if (!there || !(std::abs(there->u[place] - origin_[place]) < turned))
            continue;
        TorusPoint small = described(*there);
        if (!small.facts.admissible)
            return end(TorusOutcome::no_start, small.facts.reason);
        if (is_outside(settings_, small.parameter))
            return end(TorusOutcome::no_start, "tori are on the other side of the bound");
        next_length_ = share * first;
        outcome_ = TorusOutcome::going;
        return take(*there, std::move(small));
    }
    std::vector<double> small = origin_;
    entries_of(small) += first / problem_->length_of(direction_) * vector_of(direction_);
    if (cross_tongue(problem_->torus_of(small), true))
        return true;
    std::string why = "Newton's method did not converge to small tori";
    if (!detail_.empty())
        why += "; " + detail_;
    else if (const auto strong = resonance_near(origin_[problem_->rotation_place()], 0.01);
             strong && strong->is_strong())
        why += fmt::format("; the point is near the strong resonance {}/{}", strong->numerator, strong->denominator);
    return end(TorusOutcome::no_start, why);
}

/// Returns the next torus, with a shorter step where Newton's method does not converge or the branch bends.
std::optional<ContinuationPoint> TorusBranch::Follower::next_point(double& length) {
    const ContinuationOptions& options = settings_.continuation;
    constexpr std::size_t good_iterations = 3;
    // A torus that is about to break down is not approached closer than this share of the largest step.
    const double closest = 1e-3 * options.largest_step;
    for (length = std::min(next_length_, options.largest_step); length >= options.smallest_step; length *= 0.5) {
        const auto there = resolved_along(length);
        if (!there && unresolved_ && length < closest)
            break;
        if (!there)
            continue;
        const double cosine = problem_->product(there->tangent, direction_) /
                              (problem_->length_of(there->tangent) * problem_->length_of(direction_)),
                     angle = std::acos(std::clamp(cosine, -1.0, 1.0));
        if (angle > options.largest_angle && length > 2 * options.smallest_step)
            continue;
        const double growth = there->iterations <= good_iterations ? 2 : there->iterations <= 5 ? 1 : 0.5;
        next_length_ = length * std::clamp(angle > 0 ? 0.7 * options.largest_angle / angle : growth, 0.5, growth);
        return there;
    }
    return std::nullopt;
}

bool TorusBranch::Follower::end_without_step() {
    if (!last_locking_.empty())
        return end(TorusOutcome::not_resolved, std::string(detail_));
    std::string near;
    if (const auto resonance = resonance_near(point_.torus.rotation, 2e-3))
        near = fmt::format("; the rotation number is near {}/{}, where the motion may lock", resonance->numerator,
                           resonance->denominator);
    if (unresolved_)
        return end(TorusOutcome::not_resolved,
                   fmt::format("the torus needs more than {} harmonics{}", problem_->harmonics(), near));
    std::vector<double> predicted = origin_;
    entries_of(predicted) +=
        settings_.continuation.smallest_step / problem_->length_of(direction_) * vector_of(direction_);
    if (!problem_->evaluate(predicted))
        return end(TorusOutcome::undefined, problem_->problem());
    return end(TorusOutcome::no_convergence, "Newton's method does not converge" + near);
}

bool TorusBranch::Follower::step() {
    if (outcome_ != TorusOutcome::going)
        return false;
    if (point_.step >= settings_.steps)
        return end(TorusOutcome::steps, "");
    const std::size_t number = point_.step + 1;
    double length = 0;
    const auto there = next_point(length);
    if (!there && cross_tongue(point_.torus, false)) {
        point_.step = number;
        return true;
    }
    if (!there)
        return end_without_step();
    const double parameter = there->u[problem_->parameter_place()];
    bool made = false;
    if (is_outside(settings_, parameter)) {
        made = end_at_bound(length, parameter);
    } else if (TorusPoint next = described(*there); next.facts.admissible) {
        made = take(*there, std::move(next));
    } else {
        made = end_at_grazing(length, next.facts.reason);
    }
    if (made)
        point_.step = number;
    return made;
}

/// Moves to the bound that the step has crossed, by the method of false position with halved weights (Illinois).
bool TorusBranch::Follower::end_at_bound(double length, double beyond) {
    const double bound = settings_.least && beyond < *settings_.least ? *settings_.least : *settings_.greatest;
    const double enough = 1e-12 * std::max(std::abs(bound), setting_.parameter_scale);
    double low = 0, high = length, off_low = origin_[problem_->parameter_place()] - bound, off_high = beyond - bound;
    int side = 0;
    for (int iteration = 0; iteration < 60; ++iteration) {
        const double middle = (low * off_high - high * off_low) / (off_high - off_low);
        const auto there = along(middle);
        if (!there)
            break;
        const double off = there->u[problem_->parameter_place()] - bound;
        if (std::abs(off) <= enough) {
            TorusPoint next = described(*there);
            if (!next.facts.admissible)
                return end_at_grazing(middle, next.facts.reason);
            next.parameter = bound;
            for (std::vector<double>* parameters : {&next.torus.parameters, &next.motion.parameters})
                (*parameters)[settings_.parameter.place()] = bound;
            outcome_ = TorusOutcome::bound;
            return take(*there, std::move(next));
        }
        const bool above = (off > 0) == (off_high > 0);
        (above ? high : low) = middle;
        (above ? off_high : off_low) = off;
        if (above == (side > 0) && side != 0)
            (above ? off_low : off_high) *= 0.5;
        side = above ? 1 : -1;
    }
    return end(TorusOutcome::no_convergence, "the torus at the bound was not found");
}

/// Moves to the last torus from all angles of which the model makes the same segments.
bool TorusBranch::Follower::end_at_grazing(double length, std::string reason) {
    constexpr double precision = 1e-8; // in scaled unknowns
    std::optional<std::pair<ContinuationPoint, TorusPoint>> last;
    double low = 0, high = length;
    while (high - low > precision) {
        const double middle = 0.5 * (low + high);
        const auto there = along(middle);
        if (!there) {
            high = middle;
            continue;
        }
        TorusPoint one = described(*there);
        if (!one.facts.admissible) {
            reason = one.facts.reason;
            high = middle;
            continue;
        }
        last = {*there, std::move(one)};
        low = middle;
    }
    end(TorusOutcome::unphysical, "the torus grazes: " + reason);
    return last && take(last->first, std::move(last->second));
}

TorusBranch::TorusBranch(const System& system, const SpecialPoint& point, const BranchSettings& settings,
                         const TorusResolution& resolution)
    : follower_(std::make_unique<Follower>(system, point, settings, resolution)) {}
TorusBranch::~TorusBranch() = default;
TorusBranch::TorusBranch(TorusBranch&&) noexcept = default;

bool TorusBranch::start() {
    return follower_->start();
}
bool TorusBranch::step() {
    return follower_->step();
}
const TorusPoint& TorusBranch::point() const {
    return follower_->point();
}
const std::vector<PhaseLocking>& TorusBranch::last_locking() const {
    return follower_->last_locking();
}
TorusOutcome TorusBranch::outcome() const {
    return follower_->outcome();
}
const std::string& TorusBranch::detail() const {
    return follower_->detail();
}

} // namespace graze
