#include "identify/estimate_checks.hpp"

#include "identify/impact_proportion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace graze {

void check_residuals(Identification& found, const std::string& name, const std::string& channel,
                     const ResidualTest& left, const char* what) {
    if (!left.is_noise())
        found.warnings.push_back(fmt::format("{}: '{}' is not {}: {}; intervals are too narrow, and may be misplaced",
                                             name, channel, what, left.text()));
}

void remove_value(Identification& found, const std::string& value, const std::string& why) {
    found.warnings.push_back(fmt::format("{} is left out: {}", value, why));
    std::erase_if(found.values, [&](const Identification::Value& one) { return one.name == value; });
}

void check_impacts(Identification& found, const std::string& name, const std::string& channel,
                   const VelocityWatch& watched, std::span<const RecordedImpact> impacts, const Restitution& one) {
    const auto warn = [&](const std::string& text) {
        found.warnings.push_back(fmt::format("{}: {}; the interval is too narrow, and may be misplaced", name, text));
    };
    if (const std::size_t clipped = clipped_readings(watched.values); clipped > 0)
        warn(fmt::format("{} readings of '{}' stand at the end of their range, as if they were clipped", clipped,
                         channel));
    std::vector<double> left = one.residuals, speeds, constant, squares, order;
    for (std::size_t k = 0; k < impacts.size(); ++k) {
        const double weight = 1 / std::hypot(impacts[k].after_error, one.coefficient.value * impacts[k].before_error);
        left[k] *= weight;
        speeds.push_back(weight * impacts[k].before);
        constant.push_back(weight);
        squares.push_back(weight * impacts[k].before * std::abs(impacts[k].before));
        order.push_back(weight * impacts[k].before * static_cast<double>(k));
    }
    // Levels of the tests by the scatter about the line, and by the velocities' own errors, which an offset does not
    // enlarge.
    constexpr double level = 1e-5, level_by_errors = 1e-3, level_unlike = 1e-6;
    const ImpactProportion proportion = test_proportion(impacts, one.coefficient.value);
    if (chance_of_fit(left, {speeds}, {constant}) < level ||
        (proportion.offset < level_by_errors && proportion.offset <= proportion.change))
        warn(fmt::format("velocities after impacts are not in proportion to those before ('{}' may have an offset)",
                         channel));
    else if (chance_of_fit(left, {speeds}, {squares, order}) < level || proportion.change < level_by_errors)
        warn("the restitution changes with the speed, or in the course of the record");
    else if (proportion.unlike < level_unlike)
        found.warnings.push_back(fmt::format("{}: the restitution changes from impact to impact: they differ by {:.2g} "
                                             "times the errors of their velocities; the interval is that of its mean",
                                             name, std::sqrt(proportion.scatter)));
    constexpr double excess_limit = 3; // standard errors: chance 1e-3 for an elastic impact
    if (proportion.excess > excess_limit)
        warn(fmt::format("the restitution is above one by {:.2g} times the errors of velocities, which no impact has "
                         "('{}' may have an offset)",
                         proportion.excess, channel));
    const ResidualTest test = test_residuals(left);
    if (!test.is_noise())
        warn("residuals of velocities after impacts are not random noise: " + test.text());
}

void check_restitutions(Identification& found) {
    const std::vector<Identification::Value> values = found.values;
    for (const Identification::Value& one : values) {
        const double least = one.estimate.value - one.estimate.half_width();
        constexpr double none = 1e-9;
        if (one.name.starts_with("restitution") && (least > 1 || !(one.estimate.value > none)))
            remove_value(
                found, one.name,
                fmt::format("{:.4g} is impossible for an impact; look at which channel is the velocity, and at its "
                            "offset",
                            one.estimate.value));
    }
}

void check_loads(Identification& found, const std::vector<StaticLoad>& loads, const CouplingSettings& known,
                 const Coupling& constants) {
    const double space = constants.beta2.value + known.gap;
    double furthest = 0;
    for (const StaticLoad& load : loads)
        furthest = std::max(furthest, load.displacement);
    const auto refuse = [&](const char* why) {
        remove_value(found, "beta1", why);
        remove_value(found, "beta2", why);
    };
    if (!(constants.beta1.value > 0) || !(space > furthest))
        return refuse("no magnet has such a force; look at which channel is which, and at their units");
    constexpr double roundoff = 1e-9; // of the gap
    if (constants.beta2.value + constants.beta2.half_width() < -roundoff * known.gap)
        return refuse("beta2, the part of the magnetic path in iron, comes out below zero; look at the gap, and "
                      "at units and offset of the displacement");
    for (const char* what : {"displacements", "currents"}) {
        std::vector<double> values;
        for (const StaticLoad& load : loads)
            values.push_back(*what == 'd' ? load.displacement : load.current);
        if (const std::size_t clipped = clipped_readings(values); clipped > 0)
            found.warnings.push_back(fmt::format("{} {} stand at the end of their range, as if they were clipped; "
                                                 "intervals may be misplaced",
                                                 clipped, what));
    }
    if (!constants.reasons.empty())
        found.warnings.push_back(fmt::format("the loads are not equilibria with random noise: {}; intervals are too "
                                             "narrow, and may be misplaced",
                                             fmt::join(constants.reasons, "; ")));
}

void check_coil(Identification& found) {
    const auto refuse = [&](const std::string& name, const char* remedy) {
        const auto one = std::find_if(found.values.begin(), found.values.end(),
                                      [&](const Identification::Value& value) { return value.name == name; });
        if (one != found.values.end() && !(one->estimate.value > 0))
            remove_value(found, name, fmt::format("the {} comes out below zero, which no coil has; {}", name, remedy));
    };
    refuse("resistance", "look at the sign of the current or the voltage");
    refuse("inductance", "the current leads the voltage: look at which channel is which, at the frequency, and at "
                         "filters that delay one of them");
    refuse("leakage_inductance", "look at beta1, beta2, gap and clamped displacement, and at their units");
}

} // namespace graze
