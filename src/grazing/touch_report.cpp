#include "graze/grazing/touch_report.hpp"

#include "graze/base/input_error.hpp"

#include <cmath>

namespace graze {

namespace {

std::vector<MotionBeyond> motions_beyond(const CycleMap& map, const Verdict& verdict, ParameterId parameter) {
    if (verdict.outcome != GrazingOutcome::persists || map.contact.order != MapOrder::square_root ||
        !map.clearance_rate || *map.clearance_rate == 0)
        return {};
    double size = 0;
    for (std::size_t i = 0; i < map.gradient.size(); ++i)
        size += std::abs(map.gradient[i]) * map.scales[i];
    const double value = map.contact.touch.parameters[parameter.place()];
    std::vector<MotionBeyond> motions;
    for (const int digits : {3, 5, 7}) {
        const double clearance = -size * std::pow(10.0, -digits);
        motions.push_back({digits, value + clearance / *map.clearance_rate, map_motion(map, clearance)});
    }
    return motions;
}

} // namespace

TouchReport touch_report(const System& system, const CycleMap& map, std::optional<ParameterId> parameter, bool verify) {
    TouchReport report;
    report.verdict = verdict_of(map);
    if (verify && !parameter)
        throw InputError("no parameter is given that moves the orbit from its touch", "name a parameter that does");
    if (verify)
        report.trial = try_verdict(system, map, report.verdict, *parameter);
    if (parameter)
        report.beyond = motions_beyond(map, report.verdict, *parameter);
    return report;
}

} // namespace graze
