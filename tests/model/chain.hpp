#pragma once

#include "graze/model/model.hpp"

#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

namespace graze::testing {

/// A chain of n oscillators of which the first is forced, each with a wall of its own:
/// x_i'' = -0.2 x_i - 0.04 x_i' - coupling (2 x_i - x_{i-1} - x_{i+1}) - 0.1 x_i^3, with F cos(phase) added to the
/// first; contacts at x_i = 0.6 have restitution coefficient 0.7. The ends of the chain are fixed. States: x1, v1, x2,
/// ..., phase.
inline Model chain(std::size_t n, double coupling = 1) {
    Model model;
    model.name = "chain";
    model.parameters.push_back({.name = "F", .value = 1.0});
    const Expression force = model.symbol("F"), phase = model.symbol("phase"), none = model.number(0);
    const auto name = [](const char* letter, std::size_t i) { return letter + std::to_string(i + 1); };
    std::vector<Expression> x, v;
    for (std::size_t i = 0; i < n; ++i) {
        x.push_back(model.symbol(name("x", i)));
        v.push_back(model.symbol(name("v", i)));
        model.states.push_back({.name = name("x", i), .initial = model.number(0.001)});
        model.states.push_back({.name = name("v", i), .initial = none});
    }
    model.states.push_back({.name = "phase", .initial = none, .period = model.number(2 * std::numbers::pi)});
    const StateMap stays(model.state_symbols());
    Mode free{.name = "free"};
    for (std::size_t i = 0; i < n; ++i) {
        const Expression left = i > 0 ? x[i - 1] : none, right = i + 1 < n ? x[i + 1] : none;
        const Expression rate = -0.2 * x[i] - 0.04 * v[i] - coupling * (2 * x[i] - left - right) - 0.1 * pow(x[i], 3);
        free.rates.push_back(v[i]);
        free.rates.push_back(i == 0 ? rate + force * cos(phase) : rate);
        free.watched.push_back(i);
        model.events.push_back({.name = name("wall", i), .function = 0.6 - x[i]});
        Jump impact{.name = name("impact", i), .map = stays};
        impact.map[2 * i + 1] = -0.7 * v[i];
        model.jumps.push_back(std::move(impact));
        model.transitions.push_back(
            {.label = name("J", i), .mode = 0, .event = i, .jump = i + 1, .next = {{.mode = 0}}});
    }
    free.rates.push_back(model.number(0.9));
    model.modes.push_back(std::move(free));
    return model;
}

} // namespace graze::testing
