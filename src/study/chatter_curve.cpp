#include "study/chatter_curve.hpp"

#include "graze/branch/chatter_limit.hpp"
#include "study/branch_run.hpp"

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

    /// @return the limit at a value of the first parameter, from one or two that are near; none where there is none
    std::optional<ChatterLimit> at(double value, const Orbit& near, const Orbit* before) const {
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
        if (!limit.direct || !is_inside(limit.direct->first))
            return std::nullopt;
        return limit;
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
SpecialPoint point_of(const ChatterLimit& limit, const StudyRun& run, std::size_t event, std::size_t step, bool again) {
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
    point.monitors.assign(run.branch.settings.monitors.size(), unknown_value);
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
    writer.add(part, point_of(first, run, event, 0, again), false);
    std::string why = std::string(name_of(BranchOutcome::steps));
    for (std::size_t made = 1; made <= settings.steps;) {
        if (options.interrupted && options.interrupted())
            return false;
        const double value = here.parameters[place], next = curve.after(value, sign * step);
        if (next == value) {
            why = fmt::format("bound: {} = {:.9g}", run.model.independent_parameters()[place], value);
            break;
        }
        const auto limit = curve.at(next, here, before ? &*before : nullptr);
        if (!limit) {
            step /= 2;
            if (step >= smallest * largest)
                continue;
            why = "no onset of chatter is found beyond, or the other parameter leaves its bounds";
            break;
        }
        before = here;
        here = limit->orbit;
        writer.add(part, point_of(*limit, run, event, made++, again), false);
        step = std::min(growth * step, largest);
    }
    writer.end(why);
    return true;
}

} // namespace

bool run_chatter_curve(const StudyRun& run, const System& system, const SpecialPoint& first, PointWriter& writer,
                       const RunnerOptions& options) {
    const ChatterCurve curve(run, system, first.event);
    const Orbit& orbit = first.solution.orbit;
    const auto begin = at_place(run.start->place, run, [&] {
        return curve.at(orbit.parameters[run.branch.settings.parameter.place()], orbit, nullptr);
    });
    if (!begin)
        throw InputError(run.start->place, fmt::format("run '{}': no onset of chatter is found at its start", run.name),
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
