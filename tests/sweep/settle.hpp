#pragma once

#include "graze/model/model_file.hpp"
#include "graze/sweep/point_search.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Returns the result for a model's motion from its initial state.
inline PointResult settle(const Model& model, AttractorOptions options = {}, std::vector<double> state = {},
                          const SimulationOptions& simulation = {}) {
    if (options.section.empty())
        options.section = model.sections.front().name;
    Sampling sampling;
    sampling.name = "returns";
    sampling.section = options.section;
    const auto factory = attractor_searches(System(model), options, {sampling}, model.state_symbols(), simulation);
    const auto search = factory->make();
    if (state.empty())
        state = model.initial_state();
    search->begin(model.parameter_values(), state, model.initial_mode);
    JetSet jets(factory->simulation(), LaneKind::single);
    do
        run(search->trajectory(), jets);
    while (search->proceed());
    return std::move(search->result());
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
    return parse_model(fmt::format(R"toml(
name = "oscillator"
[parameters]
length = {0:.17g}
moment = {1:.17g}
Omega = {2:.17g}
[definitions]
X = "x/length"
V = "v*moment/length"
[states]
x = {{ initial = "{3:.17g}*length" }}
v = {{ initial = "{4:.17g}*length/moment" }}
{5}
[modes.only]
rates = {{ x = "v", v = "({6})*length/moment^2"{7} }}
[sections.s]
{8}
[initial]
mode = "only"
)toml",
                                   length, time, Omega, x, v, clock ? "theta = { initial = 0, period = \"2*pi\" }" : "",
                                   acceleration, clock ? ", theta = \"Omega/moment\"" : "",
                                   clock ? "state = \"theta\"\nvalue = 0" : "function = \"x\"\ndirection = \"rising\""),
                       "oscillator");
}

/// x' = rate.
inline Model first_order(const std::string& rate, SectionOf section, double x) {
    const bool clock = section == SectionOf::clock;
    return parse_model(
        fmt::format(R"toml(
name = "first order"
[states]
x = {{ initial = {0:.17g} }}
{1}
[modes.only]
rates = {{ x = "{2}"{3} }}
[sections.s]
{4}
[initial]
mode = "only"
)toml",
                    x, clock ? "theta = { initial = 0, period = 1 }" : "", rate, clock ? ", theta = 1" : "",
                    clock ? "state = \"theta\"\nvalue = 0.5" : "function = \"x - 0.25\"\ndirection = \"rising\""),
        "first order");
}

/// z -> map once in every unit of time.
inline Model iterated(const std::string& map, double z, bool cyclic = false) {
    return parse_model(fmt::format(R"toml(
name = "map"
[states]
z = {{ initial = {0:.17g}{1} }}
theta = {{ initial = 0, period = 1 }}
[events]
tick = {{ function = "cos(2*pi*theta)", kind = "section" }}
[modes.only]
rates = {{ z = 0, theta = 1 }}
watch = ["tick"]
[jumps.map]
z = "{2}"
[[transitions]]
mode = "only"
event = "tick"
jump = "map"
next = "only"
[sections.half]
state = "theta"
value = 0.5
[initial]
mode = "only"
)toml",
                                   z, cyclic ? ", period = 1" : "", map),
                       "map");
}

/// z -> left where z < border, right elsewhere, once in every unit of time: both branches are maps of z.
inline Model in_two_pieces(const std::string& left, const std::string& right, double border, double z) {
    return parse_model(fmt::format(R"toml(
name = "map in two pieces"
[states]
z = {{ initial = {0:.17g} }}
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
z = "{1}"
[jumps.right]
z = "{2}"
[[transitions]]
mode = "left"
event = "tick"
jump = "left"
next = [{{ when = "z < {3:.17g}", mode = "left" }}, {{ mode = "right" }}]
[[transitions]]
mode = "right"
event = "tick"
jump = "right"
next = [{{ when = "z < {3:.17g}", mode = "left" }}, {{ mode = "right" }}]
[sections.half]
state = "theta"
value = 0.5
[initial]
mode = "{4}"
)toml",
                                   z, left, right, border, z < border ? "left" : "right"),
                       "map in two pieces");
}

} // namespace graze
