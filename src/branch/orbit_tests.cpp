#include "branch/orbit_tests.hpp"

#include "orbit/certify.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// Signs of less are round-off: of a parameter's share in the direction of a branch, of the product of a pair of
/// multipliers less one.
constexpr double least_rise = 1e-8, least_growth = 1e-9;

/// Product over pairs of multipliers of mu_i mu_j - 1, which vanishes where two of them are inverse to one another: on
/// whole branches of conservative models.
void add_torus_test(const std::vector<std::complex<double>>& multipliers, std::vector<BranchTest>& tests) {
    BranchTest test{PointType::torus, 0, 0, nothing, 0, false, 0, std::nullopt, 0};
    std::complex<double> product = 1;
    double smallest = 1, others = 1;
    for (std::size_t i = 0; i < multipliers.size(); ++i)
        for (std::size_t j = i + 1; j < multipliers.size(); ++j) {
            const std::complex<double> both = multipliers[i] * multipliers[j],
                                       factor = (both - 1.0) / (1 + std::abs(both));
            product *= factor;
            others *= std::max(std::abs(factor), smallest);
            smallest = std::min(std::abs(factor), smallest);
        }
    if (multipliers.size() >= 2 && std::isfinite(product.real()))
        test.value = product.real();
    test.noise = least_growth * others;
    tests.push_back(test);
}

void add_arc_tests(const OrbitEquations& equations, const Certificate& certificate, std::vector<BranchTest>& tests) {
    const System& compiled = equations.system();
    for (std::size_t s = 0; s < equations.signature().size(); ++s) {
        const auto& mode = compiled.mode(equations.signature()[s].mode);
        for (std::size_t w = 0; w < mode.watched.size(); ++w) {
            BranchTest test{PointType::grazing, s, mode.watched[w], nothing, 0, false, 0, std::nullopt, 0};
            for (const OrbitMinimum& minimum : certificate.minima)
                if (minimum.segment == s && minimum.event == test.event && !(minimum.value >= test.value)) {
                    test.value = minimum.value;
                    test.noise = smallest_clearance * minimum.size;
                    test.time = minimum.time;
                }
            tests.push_back(test);
        }
    }
    for (const EndValue& end : certificate.end_values) {
        const bool barrier = equations.model().events[end.event].kind == EventKind::barrier;
        tests.push_back({PointType::two_events, end.segment, end.event, barrier ? end.value : nothing, 0, false,
                         end.rate, std::nullopt, 0});
    }
}

void add_monitor_tests(const std::vector<double>& values, const BranchSettings& settings,
                       std::vector<BranchTest>& tests) {
    for (std::size_t m = 0; m < settings.monitors.size(); ++m) {
        const Monitor& monitor = settings.monitors[m];
        BranchTest test{PointType::bound, 0, 0, nothing, 0, false, 0, m, 0};
        if (monitor.least) {
            test.value = values[m] - *monitor.least;
            tests.push_back(test);
        }
        if (monitor.greatest) {
            test.value = *monitor.greatest - values[m];
            tests.push_back(test);
        }
        test.type = PointType::crossing;
        for (test.crossing = 0; test.crossing < monitor.crossings.size(); ++test.crossing) {
            test.value = values[m] - monitor.crossings[test.crossing];
            tests.push_back(test);
        }
    }
}

} // namespace

std::vector<BranchTest> branch_tests(const OrbitEquations& equations, const OrbitEvaluation& at,
                                     const OrbitSolution& solution, const std::vector<double>& tangent,
                                     double determinant, const std::vector<double>& monitors,
                                     const BranchSettings& settings) {
    std::vector<BranchTest> tests;
    const auto add = [&](PointType type, double value, std::size_t segment = 0, std::size_t event = 0) {
        tests.push_back({type, segment, event, value, 0, false, 0, std::nullopt, 0});
    };
    const double parameter = at.parameters[settings.parameter];
    add(PointType::bound, settings.least ? parameter - *settings.least : nothing);
    add(PointType::bound, settings.greatest ? *settings.greatest - parameter : nothing);
    // Where monitors are held, the parameter may turn although no multiplier is 1.
    const std::size_t place = equations.layout().parameter(0);
    add(PointType::fold, settings.free.empty() ? tangent[place] : at.system.periodic_determinant());
    tests.back().noise =
        settings.free.empty() ? least_rise * at.scales[static_cast<Eigen::Index>(place)] : at.system.periodic_noise();
    // The half of a symmetric orbit that changes into its image loses the symmetry instead of doubling its period.
    add(equations.symmetry() ? PointType::asymmetry : PointType::flip, at.system.antiperiodic_determinant());
    add(PointType::branch_point, determinant);
    tests.back().singular = true;
    add_torus_test(solution.half_multipliers.empty() ? solution.multipliers : solution.half_multipliers, tests);
    const Certificate& certificate = solution.certificate;
    for (std::size_t s = 0; s < equations.signature().size(); ++s) {
        const Segment& segment = equations.signature()[s];
        const bool event = segment.end == SegmentEnd::event;
        const std::size_t index = event ? equations.model().transitions[segment.index].event : 0;
        tests.push_back({PointType::grazing, s, index, event ? certificate.approach_speeds[s] : nothing,
                         solution.orbit.durations[s], true, 0, std::nullopt, 0});
        tests.back().noise = least_rate * equations.usual_rate(at, s);
        add(PointType::vanishing, solution.orbit.durations[s], s, index);
        const double margin = certificate.guard_margins[s];
        add(PointType::guard, std::isfinite(margin) ? margin : nothing, s, index);
    }
    add_arc_tests(equations, certificate, tests);
    add_monitor_tests(monitors, settings, tests);
    return tests;
}

} // namespace graze
