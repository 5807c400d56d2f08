#include "graze/branch/orbit_branch.hpp"

#include "branch/crossing.hpp"
#include "branch/orbit_problem.hpp"
#include "branch/orbit_tests.hpp"
#include "graze/branch/switching.hpp"
#include "graze/symbolic/input_error.hpp"
#include "orbit/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr int most_locating_steps = 60;
/// Fraction of a step to which points are located.
constexpr double located_within = 1e-13;
/// Growth of derivatives over one piece at which the segments are split anew.
constexpr double too_much_growth = 1e6;

SimulationOptions integration(const OrbitOptions& options) {
    SimulationOptions result;
    result.tolerance = options.tolerance;
    return result;
}

bool is_among(PointType type, const std::vector<PointType>& types) {
    return std::find(types.begin(), types.end(), type) != types.end();
}

/// Of several things at one place, the one that tells most comes first.
int rank(const SpecialPoint& point) {
    switch (point.type) {
    case PointType::grazing: {
        const Orbit& orbit = point.solution.orbit;
        const double duration = std::abs(orbit.durations[point.segment]);
        // An arc that vanishes has the contact before it to thank for that.
        constexpr double almost_nothing = 1e-4;
        if (point.at_end)
            return duration > almost_nothing * orbit.period() ? 1 : 2;
        // A minimum that comes or goes through an end of its arc does so because a contact has lost its speed.
        constexpr double at_edge = 1e-6;
        return point.time > at_edge * duration && point.time < (1 - at_edge) * duration ? 0 : 2;
    }
    case PointType::vanishing:
        return 3;
    case PointType::two_events:
        return 4;
    case PointType::guard:
        return 5;
    default:
        return -1;
    }
}

} // namespace

void BranchSettings::validate(const Model& model) const {
    continuation.validate();
    orbit.validate();
    if (parameter >= model.parameter_symbols().size())
        throw InputError("the branch's parameter is not one of the model's", "choose an independent parameter");
    if (direction != 1 && direction != -1)
        throw InputError(fmt::format("the direction {} is neither 1 nor -1", direction), "give 1 for up, -1 for down");
    if (least && greatest && !(*least < *greatest))
        throw InputError("the branch's bounds leave no room", "give the smaller one first");
    const auto held = static_cast<std::size_t>(
        std::count_if(monitors.begin(), monitors.end(), [](const Monitor& monitor) { return monitor.fixed; }));
    if (held != free.size())
        throw InputError(fmt::format("{} monitors are fixed and {} further parameters are free", held, free.size()),
                         "free one parameter for each monitor that is fixed");
    for (const std::size_t one : free)
        if (one >= model.parameter_symbols().size() || one == parameter ||
            std::count(free.begin(), free.end(), one) > 1)
            throw InputError("a free parameter is not one of the model's, or there twice", "name other ones");
}

std::string_view name_of(BranchOutcome outcome) {
    switch (outcome) {
    case BranchOutcome::steps:
        return "all steps made";
    case BranchOutcome::bound:
        return "bound reached";
    case BranchOutcome::stopped:
        return "stopped";
    case BranchOutcome::unphysical:
        return "unphysical beyond";
    case BranchOutcome::closed:
        return "closed";
    case BranchOutcome::returned:
        return "returned";
    case BranchOutcome::no_convergence:
        return "no convergence";
    case BranchOutcome::undefined:
        return "undefined beyond";
    case BranchOutcome::no_start:
        return "no start";
    }
    return "";
}

class OrbitBranch::Follower {
public:
    Follower(const Model& model, const Orbit& candidate, const BranchSettings& settings)
        : model_(&model), settings_(settings), simulation_(model, {}, {}, integration(settings.orbit)),
          candidate_(candidate) {
        settings_.validate(model);
        validate_orbit(model, candidate);
        if (is_outside(candidate.parameters[settings.parameter]))
            throw InputError(fmt::format("the orbit's {} = {} lies outside the branch's bounds",
                                         model.parameter_symbols()[settings.parameter].name(),
                                         candidate.parameters[settings.parameter]),
                             "choose bounds on either side of it");
        if (!settings.monitors.empty())
            monitors_ = std::make_unique<OrbitMonitors>(model, candidate.signature, settings.monitors,
                                                        settings.orbit.tolerance);
        hold(candidate);
        make_problem(candidate);
    }

    bool start() {
        const std::vector<double> u = unknowns_of(candidate_);
        return begin(continuation_->start(u, problem_->parameter_place(), settings_.direction));
    }

    bool start_along(const std::vector<double>& direction, double distance) {
        const std::vector<double> u = unknowns_of(candidate_);
        if (direction.size() != u.size())
            throw InputError("the direction does not fit the orbit", "give as many numbers as there are unknowns");
        if (distance != 0)
            return begin(continuation_->start_along(u, direction, distance));
        begun_at_solution_ = true;
        std::vector<double> row = direction;
        for (std::size_t i = 0; i < row.size(); ++i)
            row[i] /= problem_->scales()[i] * problem_->scales()[i];
        return begin(continuation_->start_at(u, row));
    }

    bool step() {
        found.clear();
        if (ended_)
            return false;
        if (point.step >= settings_.steps)
            return end(BranchOutcome::steps, "");
        renew_pieces();
        const std::vector<BranchTest> before = tests_;
        const bool was_admissible = point.solution.certificate.admissible;
        const double parameter_before = point.parameter;
        if (!continuation_->step())
            return end(continuation_->outcome() == ContinuationOutcome::undefined ? BranchOutcome::undefined
                                                                                  : BranchOutcome::no_convergence,
                       problem_->shooting().problem());
        describe(continuation_->point(), point, tests_);
        ++point.step;
        point.iterations = continuation_->point().iterations;
        locate_all(before, parameter_before, was_admissible);
        judge(was_admissible);
        if (continuation_->outcome() == ContinuationOutcome::closed && !ended_)
            finish(BranchOutcome::closed, "");
        return true;
    }

    BranchPoint point;
    std::vector<SpecialPoint> found;
    BranchOutcome outcome = BranchOutcome::no_start;
    std::string detail;

private:
    /// Monitors without a given value are held at that of the candidate, however the problem is made anew later.
    void hold(const Orbit& candidate) {
        if (settings_.free.empty())
            return;
        const std::vector<double> values = (*monitors_)(candidate);
        for (std::size_t m = 0; m < values.size(); ++m)
            if (settings_.monitors[m].fixed && !settings_.monitors[m].held)
                settings_.monitors[m].held = values[m];
        monitors_ = std::make_unique<OrbitMonitors>(*model_, candidate.signature, settings_.monitors,
                                                    settings_.orbit.tolerance);
    }

    void make_problem(const Orbit& orbit) {
        problem_ = std::make_unique<OrbitProblem>(simulation_, orbit, settings_.parameter, settings_.free,
                                                  settings_.free.empty() ? nullptr : monitors_.get());
        continuation_ = std::make_unique<Continuation>(*problem_, settings_.continuation);
        older_.clear();
    }

    std::vector<double> unknowns_of(const Orbit& orbit) {
        const Eigen::VectorXd unknowns = problem_->shooting().unknowns_of(orbit);
        return {unknowns.begin(), unknowns.end()};
    }

    bool begin(bool begun) {
        ended_ = !begun;
        if (!begun) {
            outcome = BranchOutcome::no_start;
            detail = problem_->shooting().problem();
            if (detail.empty())
                detail = fmt::format("{} from the orbit that was given", name_of(continuation_->outcome()));
            return false;
        }
        point = {};
        describe(continuation_->point(), point, tests_);
        const double rise = continuation_->point().tangent[problem_->parameter_place()];
        const bool leaves = (rise < 0 && settings_.least && point.parameter <= *settings_.least) ||
                            (rise > 0 && settings_.greatest && point.parameter >= *settings_.greatest);
        if (leaves || is_outside(point.parameter))
            finish(BranchOutcome::bound, "");
        return true;
    }

    bool is_outside(double parameter) const {
        return (settings_.least && parameter < *settings_.least) ||
               (settings_.greatest && parameter > *settings_.greatest);
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

    /// What is known of a point of the branch.
    void describe(const ContinuationPoint& at, BranchPoint& result, std::vector<BranchTest>& tests) {
        Shooting& shooting = problem_->shooting();
        const auto unknowns = OrbitProblem::vector_of(at.u);
        shooting.evaluate(unknowns);
        result.solution = {};
        result.solution.outcome = OrbitOutcome::converged;
        result.solution.iterations = at.iterations;
        result.solution.orbit = shooting.orbit_of(unknowns);
        describe_orbit(shooting, unknowns, result.solution);
        result.parameter = at.u[problem_->parameter_place()];
        result.tangent = at.tangent;
        result.monitors = monitors_ ? (*monitors_)(result.solution.orbit) : std::vector<double>();
        result.arclength = arclength_ + at.arclength;
        result.stable = is_stable(result.solution);
        tests = branch_tests(shooting, result.solution, at.tangent, at.determinant, result.monitors, settings_);
    }

    /// Whether derivatives have grown too much for their pieces, or the last piece of a segment, which alone has a
    /// duration that is free, has become too short for the others.
    bool pieces_are_unfit() const {
        const Shooting& shooting = problem_->shooting();
        for (std::size_t k = 0; k < shooting.pieces(); ++k) {
            const Shooting::Piece& piece = shooting.piece(k);
            if (piece.flow.leftCols(static_cast<Eigen::Index>(shooting.states())).norm() > too_much_growth * growth_)
                return true;
            if (piece.last && k > shooting.first_piece(piece.segment) &&
                continuation_->point().u[shooting.duration_of(k)] < 0.5 * piece.fixed_duration)
                return true;
        }
        return false;
    }

    /// Splits segments anew where that is due.
    void renew_pieces() {
        if (!pieces_are_unfit())
            return;
        const double length = continuation_->next_step();
        const std::vector<double> tangent = continuation_->point().tangent;
        const std::unique_ptr<OrbitProblem> old = std::move(problem_);
        arclength_ = point.arclength;
        make_problem(point.solution.orbit);
        if (problem_->shooting().pieces() <= old->shooting().pieces())
            growth_ *= 10; // nothing was gained: ask again later
        // The direction in what both have in common: starts of segments and the parameter.
        std::vector<double> row(problem_->unknowns(), 0.0);
        const auto weigh = [&](std::size_t to, std::size_t from) {
            row[to] = tangent[from] / (problem_->scales()[to] * problem_->scales()[to]);
        };
        for (std::size_t s = 0; s < problem_->shooting().signature().size(); ++s)
            for (std::size_t i = 0; i < problem_->shooting().states(); ++i)
                weigh(problem_->shooting().start_of(problem_->shooting().first_piece(s)) + i,
                      old->shooting().start_of(old->shooting().first_piece(s)) + i);
        weigh(problem_->parameter_place(), old->parameter_place());
        continuation_->start_at(unknowns_of(point.solution.orbit), row);
        continuation_->set_next_step(length);
        describe(continuation_->point(), point, tests_);
    }

    void locate_all(const std::vector<BranchTest>& before, double parameter_before, bool was_admissible) {
        if (before.size() != tests_.size())
            return;
        const double from = continuation_->previous().arclength;
        const double length = continuation_->point().arclength - from;
        for (std::size_t i = 0; i < tests_.size(); ++i)
            for (const auto& [low, high] : brackets_of(i, before[i].value))
                if (std::optional<SpecialPoint> special = locate(i, low, high)) {
                    special->bracket = std::minmax(parameter_before, point.parameter);
                    special->step = point.step;
                    accept_limit(*special, was_admissible);
                    found.push_back(std::move(*special));
                }
        older_ = before;
        older_arclength_ = arclength_ + from;
        std::stable_sort(found.begin(), found.end(),
                         [](const SpecialPoint& a, const SpecialPoint& b) { return a.arclength < b.arclength; });
        merge(length);
        drop_folds_of_return(length);
        drop_origin(length);
        problem_->evaluate(continuation_->point().u);
    }

    /// At the end of what is admissible round-off would decide: the limit of admissible orbits is one.
    void accept_limit(SpecialPoint& special, bool was_admissible) const {
        Certificate& certificate = special.solution.certificate;
        if (rank(special) < 0 || certificate.admissible)
            return;
        certificate.admissible = was_admissible || point.solution.certificate.admissible;
        if (certificate.admissible)
            certificate.reason.clear();
    }

    /// Parts of the last step in which a test changes its sign.
    std::vector<std::pair<TestValue, TestValue>> brackets_of(std::size_t test, double before) {
        const TestValue low{0, before}, high{1, tests_[test].value};
        const bool grazing = tests_[test].type == PointType::grazing;
        const bool appeared = grazing && std::isnan(low.value) && high.value < 0;
        const bool vanished = grazing && std::isnan(high.value) && low.value < 0;
        if (low.value * high.value < 0 || appeared || vanished || (high.value == 0 && low.value != 0))
            return {{low, high}};
        if (older_.size() != tests_.size() || !(low.value * high.value > 0))
            return {};
        const double from = arclength_ + continuation_->previous().arclength;
        const double length = arclength_ + continuation_->point().arclength - from;
        const auto dip = possible_dip({(older_arclength_ - from) / length, older_[test].value}, low, high);
        ContinuationPoint at;
        if (!dip || !continuation_->between(*dip, at))
            return {};
        BranchPoint there;
        std::vector<BranchTest> tests;
        describe(at, there, tests);
        const TestValue middle{*dip, tests[test].value};
        if (!(middle.value * low.value < 0))
            return {};
        return {{low, middle}, {middle, high}};
    }

    std::optional<SpecialPoint> locate(std::size_t test, const TestValue& low, const TestValue& high) {
        return tests_[test].singular ? locate_branch_point(test, low, high) : locate_zero(test, low, high);
    }

    /// The zero of a test within the last step, by the secant method kept within a bracket (M. Dowell and
    /// P. Jarratt's Illinois variant of regula falsi, 1971). A value without meaning, as where a minimum does not exist
    /// yet, counts as positive but of unknown size.
    std::optional<SpecialPoint> locate_zero(std::size_t test, const TestValue& begin, const TestValue& end) {
        double low = begin.fraction, low_value = begin.value, high = end.fraction, high_value = end.value;
        double fraction = 0;
        const double size = std::fmax(std::abs(low_value), std::abs(high_value));
        ContinuationPoint at;
        BranchPoint there;
        std::vector<BranchTest> tests;
        bool found_any = false;
        int side = 0;
        for (int i = 0; i < most_locating_steps && high - low > located_within; ++i) {
            fraction = low - low_value * (high - low) / (high_value - low_value); // NaN if one of them is
            if (!(fraction > low && fraction < high) || i % 8 == 7)
                fraction = 0.5 * (low + high);
            if (!continuation_->between(fraction, at))
                break;
            describe(at, there, tests);
            found_any = true;
            const double value = tests[test].value;
            if (value == 0)
                break;
            if ((value < 0) == (low_value < 0)) {
                low = fraction;
                low_value = value;
                high_value *= side == -1 ? 0.5 : 1;
                side = -1;
            } else {
                high = fraction;
                high_value = value;
                low_value *= side == 1 ? 0.5 : 1;
                side = 1;
            }
        }
        return found_any ? special_at(at, there, tests[test], size) : std::nullopt;
    }

    /// Where another branch crosses, at which determinants are zero.
    std::optional<SpecialPoint> locate_branch_point(std::size_t test, const TestValue& low, const TestValue& high) {
        const std::optional<ContinuationPoint> at = locate_crossing(*continuation_, low, high);
        if (!at)
            return std::nullopt;
        BranchPoint there;
        std::vector<BranchTest> tests;
        describe(*at, there, tests);
        return special_at(*at, there, tests[test], std::max(std::abs(low.value), std::abs(high.value)));
    }

    /// @param size of the test at the ends of the bracket
    std::optional<SpecialPoint> special_at(const ContinuationPoint& at, const BranchPoint& there,
                                           const BranchTest& here, double size) const {
        SpecialPoint special;
        special.type = here.type;
        special.solution = there.solution;
        special.parameter = there.parameter;
        special.arclength = there.arclength;
        special.tangent = at.tangent;
        special.monitors = there.monitors;
        special.segment = here.segment;
        special.event = here.event;
        special.time = here.time;
        special.at_end = here.at_end;
        // A zero, not a jump: the value there must be small against those at the ends.
        special.located = std::abs(here.value) <= 1e-3 * size;
        return keep(special, here) ? std::optional(special) : std::nullopt;
    }

    /// Whether a located zero means what its test stands for; puts it into words.
    bool keep(SpecialPoint& special, const BranchTest& test) const {
        const auto& events = model_->events;
        switch (special.type) {
        case PointType::torus: {
            const auto& multipliers = special.solution.half_multipliers.empty() ? special.solution.multipliers
                                                                                : special.solution.half_multipliers;
            return special.located && std::any_of(multipliers.begin(), multipliers.end(), [](auto one) {
                       return std::abs(one.imag()) > 1e-6 && std::abs(std::abs(one) - 1) < 1e-5;
                   });
        }
        case PointType::fold:
        case PointType::flip:
            return special.located;
        case PointType::branch_point:
            special.detail = problem_->shooting().symmetry() ? "symmetry" : "";
            return special.located;
        case PointType::grazing:
            special.detail =
                fmt::format("{}{}", events[special.event].name, special.at_end ? ", no approach speed" : "");
            return true;
        case PointType::two_events: {
            // Two events of which the other one does not fall is a touch at the very end of an arc.
            const double speed = *std::max_element(special.solution.certificate.approach_speeds.begin(),
                                                   special.solution.certificate.approach_speeds.end());
            if (std::abs(test.rate) < 1e-6 * std::max(speed, std::abs(test.rate) + 1e-300)) {
                special.type = PointType::grazing;
                special.time = special.solution.orbit.durations[special.segment];
            }
            special.detail = events[special.event].name;
            return true;
        }
        case PointType::bound:
        case PointType::crossing: {
            // Round-off would leave the bound on the one side or the other.
            for (const auto& bound : {settings_.least, settings_.greatest})
                if (bound && !test.monitor && std::abs(special.parameter - *bound) < 1e-9 * length_of_step())
                    special.parameter = special.solution.orbit.parameters[settings_.parameter] = *bound;
            const std::string name = test.monitor ? settings_.monitors[*test.monitor].name
                                                  : model_->parameter_symbols()[settings_.parameter].name();
            const double value = test.monitor ? special.monitors[*test.monitor] : special.parameter;
            special.detail = fmt::format("{} = {:.10g}", name,
                                         special.type == PointType::crossing
                                             ? settings_.monitors[*test.monitor].crossings[test.crossing]
                                             : value);
            return special.located;
        }
        case PointType::vanishing:
            special.detail = fmt::format("segment {}", special.segment + 1);
            return true;
        case PointType::guard:
            special.detail =
                fmt::format("after {}", end_name(*model_, special.solution.orbit.signature[special.segment]));
            return true;
        default:
            return true;
        }
    }

    /// By how much the parameter changes over the last step.
    double length_of_step() const {
        const std::size_t place = problem_->parameter_place();
        return std::abs(continuation_->point().u[place] - continuation_->previous().u[place]);
    }

    /// Whether an orbit is that of a shorter period several times over, or one of its symmetry: where a branch of less
    /// regular orbits comes back to the one that it left.
    bool is_degenerate(const SpecialPoint& special) const {
        if (special.type != PointType::branch_point || problem_->shooting().symmetry())
            return false;
        constexpr double same = 1e-3;
        const Orbit& orbit = special.solution.orbit;
        if (half_orbit(*model_, orbit, same))
            return true;
        const std::size_t half = orbit.segments() / 2;
        if (orbit.segments() % 2 != 0)
            return false;
        for (std::size_t k = 0; k < half; ++k) {
            if (orbit.signature[k] != orbit.signature[k + half])
                return false;
            for (const std::size_t i : problem_->shooting().active())
                if (!model_->states[i].period &&
                    std::abs(orbit.starts[k][i] - orbit.starts[k + half][i]) > same * problem_->scales()[i])
                    return false;
        }
        return true;
    }

    /// Of several points at the same place that are consequences of one another, only the first in rank is kept.
    void merge(double length) {
        constexpr double same_place = 1e-6;
        for (std::size_t i = 0; i < found.size(); ++i)
            for (std::size_t j = i + 1; j < found.size();) {
                const int a = rank(found[i]), b = rank(found[j]);
                const bool same_type = found[i].type == found[j].type;
                if (std::abs(found[i].arclength - found[j].arclength) > same_place * length ||
                    ((a < 0 || b < 0) && !same_type)) {
                    ++j;
                    continue;
                }
                if (b < a)
                    std::swap(found[i], found[j]);
                found.erase(found.begin() + static_cast<std::ptrdiff_t>(j));
            }
    }

    /// Where a branch comes back to the one that it left, the parameter turns: no fold of its own.
    void drop_folds_of_return(double length) {
        constexpr double near = 0.05; // share of the step: both are located where they are ill-conditioned
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (!is_degenerate(found[i]))
                continue;
            const double at = found[i].arclength;
            std::erase_if(found, [&](const SpecialPoint& other) {
                return other.type == PointType::fold && std::abs(other.arclength - at) < near * length;
            });
            break;
        }
    }

    /// Follows the orbits that have another signature beyond a point. @return false when there are none
    bool go_on_reordered(SpecialPoint& special) {
        constexpr std::size_t most = 100;
        if (++reorderings_ > most)
            return false;
        try {
            const BranchStart start = branches_at(*model_, special, settings_).front();
            if (monitors_)
                monitors_ = std::make_unique<OrbitMonitors>(*model_, start.orbit.signature, settings_.monitors,
                                                            settings_.orbit.tolerance);
            const double length = continuation_->next_step();
            arclength_ = special.arclength;
            make_problem(start.orbit);
            const std::vector<double> u = unknowns_of(start.orbit);
            std::vector<double> row = start.direction;
            for (std::size_t i = 0; i < row.size(); ++i)
                row[i] /= problem_->scales()[i] * problem_->scales()[i];
            if (!continuation_->start_at(u, row))
                throw InputError("the continuation does not start there", "");
            continuation_->set_next_step(length);
        } catch (const InputError& error) { // nothing beyond: the branch ends
            special.detail += fmt::format("; {}", error.problem());
            return false;
        }
        special.detail += fmt::format("; goes on as {}", to_string(*model_, problem_->shooting().signature()));
        describe(continuation_->point(), point, tests_);
        return true;
    }

    /// A branch that begins at a special point of another has not found that point.
    void drop_origin(double length) {
        constexpr double same_place = 1e-6;
        if (point.step == 1 && begun_at_solution_)
            std::erase_if(found, [&](const SpecialPoint& special) {
                return rank(special) >= 0 && special.arclength < same_place * length;
            });
    }

    /// Ends the branch where what was found says so.
    void judge(bool was_admissible) {
        // The branch ends in the special point itself, not beyond it.
        const auto cut_after = [&](std::size_t i) {
            found.resize(i + 1);
            point.solution = found[i].solution;
            point.parameter = found[i].parameter;
            point.arclength = found[i].arclength;
            point.tangent = found[i].tangent;
            point.monitors = found[i].monitors;
            point.stable = is_stable(point.solution);
        };
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (found[i].type == PointType::bound) {
                cut_after(i);
                return finish(BranchOutcome::bound, "");
            }
            if (is_degenerate(found[i])) {
                found[i].detail = "back on the branch of more regular orbits";
                cut_after(i);
                return finish(BranchOutcome::returned, found[i].detail);
            }
            if (is_among(found[i].type, settings_.stop_at)) {
                cut_after(i);
                return finish(BranchOutcome::stopped, std::string(name_of(found[i].type)));
            }
            const bool may_end = rank(found[i]) >= 0;
            if (settings_.stop_when_unphysical && may_end && was_admissible && !point.solution.certificate.admissible) {
                const std::string reason = point.solution.certificate.reason;
                cut_after(i);
                const bool reordering = settings_.reorder && found[i].type != PointType::grazing;
                if (!reordering || !go_on_reordered(found[i]))
                    finish(BranchOutcome::unphysical, reason);
                return;
            }
        }
        if (settings_.stop_when_unphysical && was_admissible && !point.solution.certificate.admissible)
            finish(BranchOutcome::unphysical, point.solution.certificate.reason);
    }

    const Model* model_;
    BranchSettings settings_;
    Simulation simulation_;
    Orbit candidate_;
    std::unique_ptr<OrbitMonitors> monitors_;
    std::unique_ptr<OrbitProblem> problem_;
    std::unique_ptr<Continuation> continuation_;
    std::vector<BranchTest> tests_, older_; ///< at the last point, and at the one before the previous one
    double older_arclength_ = 0;
    double arclength_ = 0, growth_ = 1;
    std::size_t reorderings_ = 0;
    bool ended_ = true, begun_at_solution_ = false;
};

OrbitBranch::OrbitBranch(const Model& model, const Orbit& candidate, const BranchSettings& settings)
    : follower_(std::make_unique<Follower>(model, candidate, settings)) {}
OrbitBranch::~OrbitBranch() = default;
OrbitBranch::OrbitBranch(OrbitBranch&&) noexcept = default;

bool OrbitBranch::start() {
    return follower_->start();
}
bool OrbitBranch::start_along(const std::vector<double>& direction, double distance) {
    return follower_->start_along(direction, distance);
}
bool OrbitBranch::step() {
    return follower_->step();
}
const BranchPoint& OrbitBranch::point() const {
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

Branch follow_branch(const Model& model, const Orbit& candidate, const BranchSettings& settings,
                     const BranchVisitor& visit) {
    OrbitBranch follower(model, candidate, settings);
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
