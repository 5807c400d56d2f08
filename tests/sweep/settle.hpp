#pragma once

#include "graze/sweep/point_search.hpp"
#include "trajectory/model_parts.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Runs a search from a state to its end.
inline PointResult result_of(const SearchFactory& searches, const Model& model, const std::vector<double>& state) {
    const auto search = searches.make();
    search->begin(model.parameter_values(), state, model.initial_mode);
    JetSet jets(searches.simulation(), LaneKind::single);
    do
        run(search->trajectory(), jets);
    while (search->proceed());
    return std::move(search->result());
}

/// Returns the result for a model's motion from its initial state.
inline PointResult settle(const Model& model, AttractorOptions options = {}, const std::vector<double>& state = {},
                          const SimulationOptions& simulation = {}) {
    if (options.section.empty())
        options.section = model.sections.front().name;
    Sampling sampling;
    sampling.name = "returns";
    sampling.section = options.section;
    const auto searches = attractor_searches(System(model), options, {sampling}, model.state_symbols(), simulation);
    return result_of(*searches, model, state.empty() ? model.initial_state() : state);
}

enum class SectionOf {
    clock,  ///< phase of the clock is zero
    states, ///< x rises through zero
};

/// x'' = acceleration in x, v and the clock theta (if there is one), whose rate is Omega.
/// @param length, time units in which the model is written; results must not depend on them
inline Model oscillator(const std::string& acceleration, SectionOf section, double x, double v, double Omega = 1,
                        double length = 1, double time = 1) {
    const bool clock = section == SectionOf::clock;
    // X and V are the states in units of one.
    return testing::OneMode{.parameters =
                                fmt::format("length = {:.17g}\nmoment = {:.17g}\nOmega = {:.17g}", length, time, Omega),
                            .states = fmt::format("x = '{:.17g}*length'\nv = '{:.17g}*length/moment'", x, v),
                            .definitions = "X = 'x/length'\nV = 'v*moment/length'",
                            .rates = fmt::format("x = 'v', v = '({})*length/moment^2'", acceleration),
                            .clock = clock ? "Omega/moment" : "",
                            .more = clock ? testing::at_phase(0, "s") : testing::section("s", "x")}
        .model();
}

/// x' = rate.
inline Model first_order(const std::string& rate, SectionOf section, double x) {
    const bool clock = section == SectionOf::clock;
    return testing::OneMode{.states = fmt::format("x = {:.17g}", x),
                            .rates = fmt::format("x = '{}'", rate),
                            .clock = clock ? "1" : "",
                            .period = "1",
                            .more = clock ? testing::at_phase(0.5, "s") : testing::section("s", "x - 0.25")}
        .model();
}

/// States that are constant except for a map once in every unit of time.
inline Model iterated(const std::string& states, const std::string& rates, const std::string& jump) {
    return testing::OneMode{.states = states,
                            .rates = rates,
                            .clock = "1",
                            .period = "1",
                            .stops = {{"tick", "cos(2*pi*theta)", jump, "", "free", "section"}},
                            .more = testing::at_phase(0.5, "half")}
        .model();
}

/// z -> map once in every unit of time.
inline Model iterated(const std::string& map, double z, bool cyclic = false) {
    return iterated(fmt::format("z = {{ initial = {:.17g}{} }}", z, cyclic ? ", period = 1" : ""), "z = 0",
                    fmt::format("z = '{}'", map));
}

/// z -> left where z < border, right elsewhere, once in every unit of time: both branches are maps of z.
inline Model in_two_pieces(const std::string& left, const std::string& right, double border, double z) {
    const std::string next = fmt::format("[{{ when = 'z < {:.17g}', mode = 'left' }}, {{ mode = 'right' }}]", border);
    return testing::model_from(fmt::format(R"toml(
[states]
z = {{ initial = {:.17g} }}
theta = {{ initial = 0, period = 1 }}
[events]
tick = {{ function = "cos(2*pi*theta)", kind = "section" }}
[modes.left]
rates = {{ z = 0, theta = 1 }}
watch = ["tick"]
[modes.right]
rates = {{ z = 0, theta = 1 }}
watch = ["tick"]
[jumps.left]
z = "{}"
[jumps.right]
z = "{}"
[initial]
mode = "{}"
)toml",
                                           z, left, right, z < border ? "left" : "right") +
                               testing::transition("left", "tick", next, "left") +
                               testing::transition("right", "tick", next, "right") + testing::at_phase(0.5, "half"));
}

} // namespace graze
