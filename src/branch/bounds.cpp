#include "branch/bounds.hpp"

#include "base/special_numbers.hpp"
#include "branch/branch_state.hpp"
#include "orbit/eigen_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr double round_off_of_bound =
    1e-12; // relative to the bounds, or to the scale of a parameter whose bound is zero

constexpr double round_off_of_start = 1e-11;

/// Returns the parameter of a bound test with its bounds, if the test is not about a monitor.
FreeBounds bounds_of(const BranchSettings& settings, const BranchTest& test) {
    return test.free ? settings.free_bounds[*test.free]
                     : FreeBounds{settings.parameter, settings.least, settings.greatest};
}

/// Returns the index of a varying parameter among the unknowns.
std::size_t place_of_parameter(const OrbitEquations& equations, ParameterId parameter) {
    const std::vector<ParameterId>& free = equations.free();
    const auto which = std::find(free.begin(), free.end(), parameter) - free.begin();
    return equations.layout().parameter(static_cast<std::size_t>(which));
}

} // namespace

std::vector<BranchTest> tests_of_bounds(const BranchSettings& settings, std::span<const double> parameters,
                                        std::span<const double> monitors) {
    std::vector<BranchTest> tests;
    const auto add = [&](std::optional<double> least, std::optional<double> greatest, double value, BranchTest test) {
        const bool always = !test.monitor && !test.free;
        const double size = std::max(std::abs(least.value_or(0)), std::abs(greatest.value_or(0)));
        test.type = PointType::bound;
        test.noise = round_off_of_bound * (size > 0 ? size : 1);
        if (test.value = least ? value - *least : not_a_number; least || always)
            tests.push_back(test);
        if (test.value = greatest ? *greatest - value : not_a_number; greatest || always)
            tests.push_back(test);
    };
    add(settings.least, settings.greatest, parameters[settings.parameter.place()], {});
    for (std::size_t f = 0; f < settings.free_bounds.size(); ++f) {
        const FreeBounds& bounds = settings.free_bounds[f];
        add(bounds.least, bounds.greatest, parameters[bounds.parameter.place()], {.free = f});
    }
    for (std::size_t m = 0; m < settings.monitors.size(); ++m)
        add(settings.monitors[m].least, settings.monitors[m].greatest, monitors[m], {.monitor = m});
    return tests;
}

void test_bounds(const TestedPoint& point, std::vector<BranchTest>& tests) {
    for (BranchTest test : tests_of_bounds(point.settings, point.at.parameters, point.monitors)) {
        if (!test.monitor) {
            const ParameterId one = bounds_of(point.settings, test).parameter;
            test.noise = std::min(test.noise, round_off_of_bound *
                                                  point.at.scales[index(place_of_parameter(point.equations, one))]);
        }
        tests.push_back(test);
    }
}

bool confirm_bound(BranchState& state, SpecialPoint& special, const BranchTest& test) {
    const BranchSettings& settings = state.settings();
    if (test.monitor) {
        special.detail =
            fmt::format("{} = {:.10g}", settings.monitors[*test.monitor].name, special.monitors[*test.monitor]);
        return special.located;
    }
    const FreeBounds bounds = bounds_of(settings, test);
    double& value = special.solution.orbit.parameters[bounds.parameter.place()];
    // Sets the parameter exactly to the bound: round-off, or the uncertainty of a nearby crossing, would leave it on
    // either side.
    constexpr double uncertain = 1e-8; // share of the step
    const std::size_t place = place_of_parameter(state.problem().equations(), bounds.parameter);
    const double step = std::abs(state.continuation().point().u[place] - state.continuation().previous().u[place]);
    for (const auto& bound : {bounds.least, bounds.greatest})
        if (bound && std::abs(value - *bound) < uncertain * step)
            value = *bound;
    special.parameter = special.solution.orbit.parameters[settings.parameter.place()];
    special.detail =
        fmt::format("{} = {:.10g}", state.model().independent_parameters()[bounds.parameter.place()], value);
    return special.located;
}

bool is_beyond_bounds(const std::vector<BranchTest>& tests) {
    return std::any_of(tests.begin(), tests.end(), [](const BranchTest& test) {
        return test.type == PointType::bound && test.value < -test.noise;
    });
}

std::string beyond_in_words(const BranchState& state, const BranchPoint& point) {
    const BranchSettings& settings = state.settings();
    const std::vector<double>& parameters = point.solution.orbit.parameters;
    for (const BranchTest& test : tests_of_bounds(settings, parameters, point.monitors)) {
        if (!is_beyond_bounds({test}))
            continue;
        if (test.monitor)
            return fmt::format("{} = {:.10g} lies beyond its bound", settings.monitors[*test.monitor].name,
                               point.monitors[*test.monitor]);
        const ParameterId one = bounds_of(settings, test).parameter;
        return fmt::format("{} = {:.10g} lies beyond its bound", state.model().independent_parameters()[one.place()],
                           parameters[one.place()]);
    }
    return "";
}

bool leads_beyond_bounds(BranchState& state) {
    const BranchSettings& settings = state.settings();
    const ContinuationPoint& begun = state.continuation().point();
    const auto leaves = [&](ParameterId parameter, const auto& least, const auto& greatest) {
        const std::size_t place = place_of_parameter(state.problem().equations(), parameter);
        const double rise = begun.tangent[place], value = begun.u[place];
        // A point that was located on a bound lies on either side of it by round-off: where it leads decides.
        const double room = round_off_of_start * std::max(std::abs(least.value_or(0)), std::abs(greatest.value_or(0)));
        return (least && (value < *least - room || (rise < 0 && value <= *least + room))) ||
               (greatest && (value > *greatest + room || (rise > 0 && value >= *greatest - room)));
    };
    return leaves(settings.parameter, settings.least, settings.greatest) ||
           std::any_of(settings.free_bounds.begin(), settings.free_bounds.end(),
                       [&](const FreeBounds& one) { return leaves(one.parameter, one.least, one.greatest); });
}

double within_bounds(double value, const std::optional<double>& least, const std::optional<double>& greatest) {
    return std::min(std::max(value, least.value_or(-infinity)), greatest.value_or(infinity));
}

void put_on_bounds(const BranchSettings& settings, Orbit& orbit) {
    const auto put = [&](ParameterId parameter, const std::optional<double>& least,
                         const std::optional<double>& greatest) {
        double& value = orbit.parameters[parameter.place()];
        value = within_bounds(value, least, greatest);
    };
    put(settings.parameter, settings.least, settings.greatest);
    for (const FreeBounds& bounds : settings.free_bounds)
        put(bounds.parameter, bounds.least, bounds.greatest);
}

} // namespace graze
