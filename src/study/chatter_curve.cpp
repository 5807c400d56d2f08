#include "study/chatter_curve.hpp"

#include "graze/branch/chatter_limit.hpp"
#include "study/branch_run.hpp"
#include "study/ladder_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace graze {

namespace {

/// The curve in one direction.
class ChatterCurve {
public:
    ChatterCurve(const StudyRun& run, const System& system, std::size_t event)
        : settings_(run.branch.settings), system_(system), event_(event), free_(settings_.free.front()) {
        const auto bounds = std::find_if(settings_.free_bounds.begin(), settings_.free_bounds.end(),
                                         [&](const FreeBounds& one) { return one.parameter == free_; });
        if (bounds != settings_.free_bounds.end())
            bounds_ = *bounds;
    }

    const System& system() const { return system_; }
    /// @return the limit at a value of the first parameter, from one or two that are near; none, and why, where there
    /// is none
    std::optional<ChatterLimit> at(double value, const Orbit& near, const Orbit* before, std::string& why) const {
        Orbit guess = near;
        const std::size_t place = settings_.parameter.place();
        if (before) {
            const double share =
                (value - near.parameters[place]) / (near.parameters[place] - before->parameters[place]);
            guess.parameters[free_.place()] +=
                share * (near.parameters[free_.place()] - before->parameters[free_.place()]);
            const std::vector<double> periods = system_.periods()(near.parameters);
            for (std::size_t i = 0; i < periods.size(); ++i) {
                const double gain = near.starts[0][i] - before->starts[0][i];
                guess.starts[0][i] += share * (periods[i] > 0 ? std::remainder(gain, periods[i]) : gain);
            }
        }
        guess.parameters[place] = value;
        const ChatterLimit limit = chatter_limit_near(system_, guess, event_, free_, settings_.orbit.tolerance);
        why = limit.problem;
        if (limit.direct && !is_inside(limit.direct->first))
            why = fmt::format("bound: {}", system_.model().independent_parameters()[free_.place()]);
        return limit.direct && why.empty() ? std::optional(limit) : std::nullopt;
    }
    bool is_inside(double second) const {
        return !(bounds_.least && second < *bounds_.least) && !(bounds_.greatest && second > *bounds_.greatest);
    }
    /// The first parameter after a step, not beyond its bounds.
    double after(double value, double step) const {
        double next = value + step;
        if (settings_.least)
            next = std::max(next, *settings_.least);
        if (settings_.greatest)
            next = std::min(next, *settings_.greatest);
        return next;
    }
    /// The largest step, and the first one.
    double largest_step(double value) const {
        constexpr double share = 0.02;
        if (settings_.least && settings_.greatest)
            return share * (*settings_.greatest - *settings_.least);
        return share * std::abs(value);
    }

private:
    const BranchSettings& settings_;
    System system_;
    std::size_t event_;
    ParameterId free_;
    FreeBounds bounds_;
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

/// @return false when interrupted
bool follow_one_way(const StudyRun& run, const ChatterCurve& curve, const std::string& part, bool again,
                    const ChatterLimit& first, std::size_t event, PointWriter& writer, const RunnerOptions& options) {
    const BranchSettings& settings = run.branch.settings;
    const std::size_t place = settings.parameter.place();
    constexpr double growth = 1.5, smallest = 1e-4; // of the largest step
    const double largest = curve.largest_step(first.orbit.parameters[place]), sign = part == "down" ? -1 : 1;
    double step = largest / 4;
    Orbit here = first.orbit;
    std::optional<Orbit> before;
    writer.add(part, point_of(first, run, curve.system(), event, 0, again), false);
    std::string why = std::string(name_of(BranchOutcome::steps)), problem;
    for (std::size_t made = 1; made <= settings.steps;) {
        if (options.interrupted && options.interrupted())
            return false;
        const double value = here.parameters[place], next = curve.after(value, sign * step);
        if (next == value) {
            why = fmt::format("bound: {} = {:.9g}", run.model.independent_parameters()[place], value);
            break;
        }
        const auto limit = curve.at(next, here, before ? &*before : nullptr, problem);
        if (!limit) {
            step /= 2;
            if (step >= smallest * largest)
                continue;
            why = problem;
            break;
        }
        before = here;
        here = limit->orbit;
        writer.add(part, point_of(*limit, run, curve.system(), event, made++, again), false);
        step = std::min(growth * step, largest);
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
    const ChatterCurve curve(run, system, first.event);
    const Orbit& orbit = first.solution.orbit;
    std::string why;
    const auto begin = at_place(run.start->place, run, [&] {
        return curve.at(orbit.parameters[run.branch.settings.parameter.place()], orbit, nullptr, why);
    });
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
