#include "graze/branch/chatter_curve.hpp"

#include "base/special_numbers.hpp"
#include "branch/bounds.hpp"
#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace graze {

namespace {

/// Solves for points of the curve in the plane of two parameters, each in units of its largest step.
class ChatterPlane {
public:
    using Place = std::array<double, 2>;

    ChatterPlane(const System& system, std::size_t event, const Orbit& first, const BranchSettings& settings)
        : settings_(settings), system_(system),
          event_(event), parameters_{settings_.parameter, settings_.free.front()} {
        bounds_[0] = {parameters_[0], settings_.least, settings_.greatest};
        bounds_[1] = {parameters_[1], std::nullopt, std::nullopt};
        for (const FreeBounds& one : settings_.free_bounds)
            if (one.parameter == parameters_[1])
                bounds_[1] = one;
        for (std::size_t k = 0; k < 2; ++k)
            units_[k] = largest_step(bounds_[k], value(k, first));
    }

    const BranchSettings& settings() const { return settings_; }
    Place place_of(const Orbit& orbit) const { return {value(0, orbit) / units_[0], value(1, orbit) / units_[1]}; }
    double value(std::size_t which, const Orbit& orbit) const { return orbit.parameters[parameters_[which].place()]; }
    std::string name_of(std::size_t which) const {
        return system_.model().independent_parameters()[parameters_[which].place()];
    }

    /// Result of a step in which one parameter is fixed at its predicted value and the other solved for.
    struct Reached {
        ChatterLimit limit;
        std::optional<std::size_t> bound; ///< index of the parameter whose bound is reached, if any
    };
    /// @param ahead the step in the plane; @param before an earlier orbit, for extrapolation of the start; @param
    /// way_before its distance
    std::optional<Reached> step_from(const Orbit& here, const Place& ahead, const Orbit* before, double length_before,
                                     std::string& why) const {
        const std::size_t held = std::abs(ahead[0]) >= std::abs(ahead[1]) ? 0 : 1;
        auto reached = hold(held, here, ahead, before, length_before, why);
        if (!reached)
            return std::nullopt;
        const std::size_t other = 1 - held;
        const double found = value(other, reached->limit.orbit);
        if (const double bounded = within(other, found); bounded != found) {
            const double step = (bounded - value(other, here)) / units_[other];
            const double whole = (found - value(other, here)) / units_[other];
            Place to_bound{ahead[0] * step / whole, ahead[1] * step / whole};
            to_bound[other] = step;
            reached = hold(other, here, to_bound, before, length_before, why);
            if (reached)
                reached->bound = other;
        }
        return reached;
    }
    /// Solves at a point with the first parameter fixed.
    std::optional<ChatterLimit> at(const Orbit& near, std::string& why) const {
        ChatterLimit limit = chatter_limit_near(system_, near, event_, parameters_[1], settings_.orbit.tolerance);
        why = limit.problem;
        if (limit.direct && within(1, limit.direct->first) != limit.direct->first)
            why = "bound: " + name_of(1);
        return limit.direct && why.empty() ? std::optional(std::move(limit)) : std::nullopt;
    }
    bool is_on_bound(std::size_t which, const Orbit& orbit, double direction) const {
        const FreeBounds& bounds = bounds_[which];
        return (direction < 0 && bounds.least && value(which, orbit) <= *bounds.least) ||
               (direction > 0 && bounds.greatest && value(which, orbit) >= *bounds.greatest);
    }

private:
    static double largest_step(const FreeBounds& bounds, double value) {
        constexpr double share = 0.02;
        const double step =
            share * (bounds.least && bounds.greatest ? *bounds.greatest - *bounds.least : std::abs(value));
        return step > 0 ? step : share;
    }
    double within(std::size_t which, double value) const {
        return within_bounds(value, bounds_[which].least, bounds_[which].greatest);
    }
    std::optional<Reached> hold(std::size_t held, const Orbit& here, const Place& ahead, const Orbit* before,
                                double length_before, std::string& why) const {
        const double from = value(held, here), wanted = from + ahead[held] * units_[held];
        const double fixed = within(held, wanted), part = wanted == from ? 0 : (fixed - from) / (wanted - from);
        Orbit guess = here;
        for (std::size_t k = 0; k < 2; ++k)
            guess.parameters[parameters_[k].place()] += part * ahead[k] * units_[k];
        if (before) {
            const double share = part * std::hypot(ahead[0], ahead[1]) / length_before;
            const std::vector<double> periods = system_.periods()(here.parameters);
            for (std::size_t i = 0; i < periods.size(); ++i) {
                const double gain = here.starts[0][i] - before->starts[0][i];
                guess.starts[0][i] += share * (periods[i] > 0 ? std::remainder(gain, periods[i]) : gain);
            }
        }
        guess.parameters[parameters_[held].place()] = fixed;
        Reached reached{chatter_limit_near(system_, guess, event_, parameters_[1 - held], settings_.orbit.tolerance),
                        fixed == wanted ? std::nullopt : std::optional(held)};
        why = reached.limit.problem;
        return reached.limit.direct ? std::optional(std::move(reached)) : std::nullopt;
    }

    BranchSettings settings_;
    System system_;
    std::size_t event_;
    std::array<ParameterId, 2> parameters_;
    std::array<FreeBounds, 2> bounds_;
    Place units_{};
};

/// Returns the angle between two directions in the plane.
double angle_between(const ChatterPlane::Place& one, const ChatterPlane::Place& other) {
    return std::abs(std::atan2(one[0] * other[1] - one[1] * other[0], one[0] * other[0] + one[1] * other[1]));
}

} // namespace

struct ChatterCurve::State {
    State(ChatterPlane in, std::size_t at, ChatterLimit begin)
        : plane(std::move(in)), event(at), first(std::move(begin)), here(first) {}

    void report_bound(std::size_t which) {
        ending = fmt::format("bound: {} = {:.9g}", plane.name_of(which), plane.value(which, here.orbit));
    }
    /// Attempts a step. @return false when it fails
    bool attempt(std::string& problem);

    ChatterPlane plane;
    std::size_t event;
    ChatterLimit first, here;
    std::optional<Orbit> before;
    ChatterPlane::Place direction{};
    double length = 0, length_before = 1; ///< lengths of the next and of the last step, in largest steps
    std::size_t made = 0;
    bool interrupted = false;
    std::string ending;
};

ChatterCurve::ChatterCurve(const System& system, const SpecialPoint& first, const BranchSettings& settings) {
    require_chatter_curve(system.model(), first, settings);
    ChatterPlane plane(system, first.event, first.solution.orbit, settings);
    std::string why;
    auto begin = plane.at(first.solution.orbit, why);
    if (!begin)
        throw InputError(fmt::format("no onset of chatter is found at its start: {}", why),
                         "choose another point, or wider bounds");
    state_ = std::make_unique<State>(std::move(plane), first.event, std::move(*begin));
}

ChatterCurve::~ChatterCurve() = default;
ChatterCurve::ChatterCurve(ChatterCurve&&) noexcept = default;

void ChatterCurve::start(int direction) {
    constexpr double first_length = 0.25;
    State& state = *state_;
    state = State(state.plane, state.event, state.first);
    state.direction = {direction < 0 ? -1.0 : 1.0, 0};
    state.length = first_length;
    if (state.plane.is_on_bound(0, state.here.orbit, state.direction[0]))
        state.report_bound(0);
}

bool ChatterCurve::State::attempt(std::string& problem) {
    using Place = ChatterPlane::Place;
    constexpr double growth = 1.5, largest_angle = 0.4;
    const Place from = plane.place_of(here.orbit), ahead{length * direction[0], length * direction[1]};
    auto reached = plane.step_from(here.orbit, ahead, before ? &*before : nullptr, length_before, problem);
    if (!reached)
        return false;
    problem = name_of(BranchOutcome::no_convergence);
    const Place to = plane.place_of(reached->limit.orbit), moved{to[0] - from[0], to[1] - from[1]};
    const double distance = std::hypot(moved[0], moved[1]);
    const bool bends = before && angle_between(direction, moved) > largest_angle;
    if (!(distance > 0) || bends || (!before && distance > 1))
        return false;
    before = std::move(here.orbit);
    length_before = distance;
    here = std::move(reached->limit);
    direction = {moved[0] / distance, moved[1] / distance};
    ++made;
    if (reached->bound)
        report_bound(*reached->bound);
    length = std::min(growth * length, 1.0);
    return true;
}

bool ChatterCurve::step(const std::function<bool()>& interrupted) {
    constexpr double shortest = 1e-4;
    State& state = *state_;
    if (state.ending.empty() && state.made >= state.plane.settings().steps)
        state.ending = name_of(BranchOutcome::steps);
    while (state.ending.empty()) {
        if (interrupted && interrupted()) {
            state.interrupted = true;
            return false;
        }
        std::string problem;
        if (state.attempt(problem))
            return true;
        state.length /= 2;
        if (state.length < shortest)
            state.ending = problem;
    }
    return false;
}

const ChatterLimit& ChatterCurve::limit() const {
    return state_->here;
}

std::size_t ChatterCurve::steps() const {
    return state_->made;
}

bool ChatterCurve::interrupted() const {
    return state_->interrupted;
}

const std::string& ChatterCurve::ending() const {
    return state_->ending;
}

SpecialPoint ChatterCurve::point() const {
    const ChatterLimit& limit = state_->here;
    SpecialPoint point;
    point.type = PointType::regular;
    point.detail = fmt::format("{}+- {:.1e}", state_->made == 0 ? "start; " : "", limit.direct->second);
    point.event = state_->event;
    point.solution.orbit = limit.orbit;
    point.solution.outcome = OrbitOutcome::converged;
    point.solution.residual = limit.gap;
    point.solution.certificate.admissible = true;
    point.parameter = limit.orbit.parameters[state_->plane.settings().parameter.place()];
    point.bracket = {not_a_number, not_a_number};
    point.step = state_->made;
    return point;
}

void require_chatter_curve(const Model& model, const SpecialPoint& first, const BranchSettings& settings) {
    if (settings.free.empty())
        throw InputError("it needs a second parameter", "name one in `free`");
    if (settings.free.size() > 1)
        throw InputError("it needs no further free parameters", "leave `free` out");
    for (const Monitor& monitor : settings.monitors)
        if (monitor.fixed || !monitor.crossings.empty() || monitor.least || monitor.greatest)
            throw InputError(fmt::format("monitor '{}' cannot be fixed, reported or bounded", monitor.name),
                             "leave that out");
    if (!settings.stop_at.empty())
        throw InputError("it meets no other points", "leave `stop` out");
    const double value = first.solution.orbit.parameters[settings.parameter.place()];
    if (is_outside(settings, value))
        throw InputError(fmt::format("its start, {:.9g}, lies outside of the bounds of '{}'", value,
                                     model.independent_parameters()[settings.parameter.place()]),
                         "give wider bounds in `along`");
}

} // namespace graze
