#include "study/chatter_curve.hpp"

#include "graze/branch/chatter_limit.hpp"
#include "study/branch_run.hpp"
#include "study/ladder_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace graze {

namespace {

/// The curve in the plane of two parameters, each in units of the largest step in it.
class ChatterCurve {
public:
    using Place = std::array<double, 2>;

    ChatterCurve(const StudyRun& run, const System& system, std::size_t event, const Orbit& first)
        : settings_(run.branch.settings), system_(system),
          event_(event), parameters_{settings_.parameter, settings_.free.front()} {
        bounds_[0] = {parameters_[0], settings_.least, settings_.greatest};
        bounds_[1] = {parameters_[1], std::nullopt, std::nullopt};
        for (const FreeBounds& one : settings_.free_bounds)
            if (one.parameter == parameters_[1])
                bounds_[1] = one;
        for (std::size_t k = 0; k < 2; ++k)
            units_[k] = largest_step(bounds_[k], first.parameters[parameters_[k].place()]);
    }

    const System& system() const { return system_; }
    Place place_of(const Orbit& orbit) const {
        return {orbit.parameters[parameters_[0].place()] / units_[0],
                orbit.parameters[parameters_[1].place()] / units_[1]};
    }
    std::size_t place_in_model(std::size_t which) const { return parameters_[which].place(); }
    std::string name_of(std::size_t which) const {
        return system_.model().independent_parameters()[parameters_[which].place()];
    }

    /// Where a step leads in which one parameter is held at a value that has been predicted, and the other follows.
    struct Reached {
        ChatterLimit limit;
        std::optional<std::size_t> bound; ///< of which parameter it lies on
    };
    /// @param ahead of the step: in the plane, in units; @param before an earlier orbit, from which all else is
    /// extrapolated, and how far it is away
    std::optional<Reached> go(const Orbit& here, const Place& ahead, const Orbit* before, double way_before,
                              std::string& why) const {
        const std::size_t held = std::abs(ahead[0]) >= std::abs(ahead[1]) ? 0 : 1;
        auto reached = hold(held, here, ahead, before, way_before, why);
        if (!reached)
            return std::nullopt;
        const std::size_t other = 1 - held;
        const double value = reached->limit.orbit.parameters[parameters_[other].place()];
        if (const double bounded = within(other, value); bounded != value) {
            const double step = (bounded - here.parameters[parameters_[other].place()]) / units_[other];
            const double whole = (value - here.parameters[parameters_[other].place()]) / units_[other];
            Place to_bound{ahead[0] * step / whole, ahead[1] * step / whole};
            to_bound[other] = step;
            reached = hold(other, here, to_bound, before, way_before, why);
            if (reached)
                reached->bound = other;
        }
        return reached;
    }
    /// At a point as it is: the second parameter follows.
    std::optional<ChatterLimit> at(const Orbit& near, std::string& why) const {
        ChatterLimit limit = chatter_limit_near(system_, near, event_, parameters_[1], settings_.orbit.tolerance);
        why = limit.problem;
        if (limit.direct && within(1, limit.direct->first) != limit.direct->first)
            why = "bound: " + name_of(1);
        return limit.direct && why.empty() ? std::optional(std::move(limit)) : std::nullopt;
    }
    bool is_on_bound(std::size_t which, const Orbit& orbit, double direction) const {
        const double value = orbit.parameters[parameters_[which].place()];
        return (direction < 0 && bounds_[which].least && value <= *bounds_[which].least) ||
               (direction > 0 && bounds_[which].greatest && value >= *bounds_[which].greatest);
    }

private:
    static double largest_step(const FreeBounds& bounds, double value) {
        constexpr double share = 0.02;
        const double step =
            share * (bounds.least && bounds.greatest ? *bounds.greatest - *bounds.least : std::abs(value));
        return step > 0 ? step : share;
    }
    double within(std::size_t which, double value) const {
        if (bounds_[which].least)
            value = std::max(value, *bounds_[which].least);
        if (bounds_[which].greatest)
            value = std::min(value, *bounds_[which].greatest);
        return value;
    }
    std::optional<Reached> hold(std::size_t held, const Orbit& here, const Place& ahead, const Orbit* before,
                                double way_before, std::string& why) const {
        const double from = here.parameters[parameters_[held].place()], wanted = from + ahead[held] * units_[held],
                     value = within(held, wanted);
        const double part = wanted == from ? 0 : (value - from) / (wanted - from);
        Orbit guess = here;
        for (std::size_t k = 0; k < 2; ++k)
            guess.parameters[parameters_[k].place()] += part * ahead[k] * units_[k];
        if (before) {
            const double share = part * std::hypot(ahead[0], ahead[1]) / way_before;
            const std::vector<double> periods = system_.periods()(here.parameters);
            for (std::size_t i = 0; i < periods.size(); ++i) {
                const double gain = here.starts[0][i] - before->starts[0][i];
                guess.starts[0][i] += share * (periods[i] > 0 ? std::remainder(gain, periods[i]) : gain);
            }
        }
        guess.parameters[parameters_[held].place()] = value;
        Reached reached{chatter_limit_near(system_, guess, event_, parameters_[1 - held], settings_.orbit.tolerance),
                        value == wanted ? std::nullopt : std::optional(held)};
        why = reached.limit.problem;
        return reached.limit.direct ? std::optional(std::move(reached)) : std::nullopt;
    }

    const BranchSettings& settings_;
    System system_;
    std::size_t event_;
    std::array<ParameterId, 2> parameters_;
    std::array<FreeBounds, 2> bounds_;
    Place units_{};
};

/// @param again whether the other part of the run has the same first point
SpecialPoint point_of(const ChatterLimit& limit, const StudyRun& run, const System& system, std::size_t event,
                      std::size_t step, bool again) {
    SpecialPoint point;
    point.type = step == 0 && !again ? PointType::chatter : PointType::regular;
    point.detail = fmt::format("{}+- {:.1e}", step == 0 ? "start; " : "", limit.direct->second);
    point.event = event;
    point.solution.orbit = limit.orbit;
    point.solution.outcome = OrbitOutcome::converged;
    point.solution.residual = limit.gap;
    point.solution.certificate.admissible = true;
    point.parameter = limit.orbit.parameters[run.branch.settings.parameter.place()];
    point.bracket = {unknown_value, unknown_value};
    point.step = step;
    point.monitors = monitors_of(system, limit.orbit, run);
    return point;
}

/// Angle between two directions in the plane.
double angle_between(const ChatterCurve::Place& one, const ChatterCurve::Place& other) {
    return std::abs(std::atan2(one[0] * other[1] - one[1] * other[0], one[0] * other[0] + one[1] * other[1]));
}

/// Steps along the secant, in which the parameter that changes more is held and the other one solved for: turns in
/// either are passed (W. C. Rheinboldt, "Numerical Analysis of Parametrized Nonlinear Equations", 1986).
/// @return false when interrupted
bool follow_one_way(const StudyRun& run, const ChatterCurve& curve, const std::string& part, bool again,
                    const ChatterLimit& first, std::size_t event, PointWriter& writer, const RunnerOptions& options) {
    using Place = ChatterCurve::Place;
    constexpr double growth = 1.5, smallest = 1e-4, largest_angle = 0.4; // of the largest step, which is 1
    double step = 0.25;
    Orbit here = first.orbit;
    std::optional<Orbit> before;
    double way_before = 1;
    Place direction{part == "down" ? -1.0 : 1.0, 0};
    writer.add(part, point_of(first, run, curve.system(), event, 0, again), false);
    std::string why = std::string(name_of(BranchOutcome::steps)), problem;
    const auto tell_bound = [&](std::size_t which) {
        why = fmt::format("bound: {} = {:.9g}", curve.name_of(which), here.parameters[curve.place_in_model(which)]);
    };
    if (curve.is_on_bound(0, here, direction[0])) {
        tell_bound(0);
        writer.end(why);
        return true;
    }
    for (std::size_t made = 1; made <= run.branch.settings.steps;) {
        if (options.interrupted && options.interrupted())
            return false;
        const Place from = curve.place_of(here), ahead{step * direction[0], step * direction[1]};
        const auto reached = curve.go(here, ahead, before ? &*before : nullptr, way_before, problem);
        Place moved{};
        if (reached) {
            const Place to = curve.place_of(reached->limit.orbit);
            moved = {to[0] - from[0], to[1] - from[1]};
        }
        const double way = std::hypot(moved[0], moved[1]);
        const bool bends = reached && before && angle_between(direction, moved) > largest_angle;
        if (!reached || !(way > 0) || bends || (!before && way > 1)) {
            step /= 2;
            if (step >= smallest)
                continue;
            why = reached ? std::string(name_of(BranchOutcome::no_convergence)) : problem;
            break;
        }
        before = here;
        way_before = way;
        here = reached->limit.orbit;
        direction = {moved[0] / way, moved[1] / way};
        writer.add(part, point_of(reached->limit, run, curve.system(), event, made++, again), false);
        if (reached->bound) {
            tell_bound(*reached->bound);
            break;
        }
        step = std::min(growth * step, 1.0);
    }
    writer.end(why);
    return true;
}

/// What has no meaning for the onset of chatter is refused, not left out.
void require_plain(const StudyRun& run, const SpecialPoint& first) {
    const auto refuse = [&](const std::string& problem, const std::string& remedy) {
        throw InputError(run.start->place, fmt::format("run '{}' follows an onset of chatter: {}", run.name, problem),
                         remedy);
    };
    const BranchSettings& settings = run.branch.settings;
    if (!run.start->onto.empty())
        refuse(fmt::format("it is no point of type {}", run.start->onto), "leave `onto` out");
    if (settings.free.size() > 1)
        refuse("it needs no further free parameters", "leave `free` out");
    for (const Monitor& monitor : settings.monitors)
        if (monitor.fixed || !monitor.crossings.empty() || monitor.least || monitor.greatest)
            refuse(fmt::format("monitor '{}' cannot be fixed, reported or bounded", monitor.name), "leave that out");
    if (!settings.stop_at.empty())
        refuse("it meets no other points", "leave `stop` out");
    const double value = first.solution.orbit.parameters[settings.parameter.place()];
    if ((settings.least && value < *settings.least) || (settings.greatest && value > *settings.greatest))
        refuse(fmt::format("its start, {:.9g}, lies outside of the bounds of '{}'", value,
                           run.model.independent_parameters()[settings.parameter.place()]),
               "give wider bounds in `along`");
}

} // namespace

bool run_chatter_curve(const StudyRun& run, const System& system, const SpecialPoint& first, PointWriter& writer,
                       const RunnerOptions& options) {
    require_plain(run, first);
    const Orbit& orbit = first.solution.orbit;
    const ChatterCurve curve(run, system, first.event, orbit);
    std::string why;
    const auto begin = at_place(run.start->place, run, [&] { return curve.at(orbit, why); });
    if (!begin)
        throw InputError(run.start->place,
                         fmt::format("run '{}': no onset of chatter is found at its start: {}", run.name, why),
                         "choose another point, or wider bounds");
    bool again = false;
    for (const std::string& part : direction_names(run)) {
        if (!follow_one_way(run, curve, part, again, *begin, first.event, writer, options))
            return false;
        again = true;
    }
    return true;
}

} // namespace graze
