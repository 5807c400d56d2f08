#pragma once

#include "graze/model/model.hpp"

#include <cstddef>
#include <string>
#include <vector>

/// A chain of forced oscillators between fixed ends, each with a wall: a model of variable size. For i = 1..n
///     x_i'' = -0.2 x_i - 0.04 x_i' - (2 x_i - x_{i-1} - x_{i+1}) - 0.1 x_i^3, plus F cos(0.9 t) for the first,
/// x_0 = x_{n+1} = 0, with impacts of restitution e = 0.7 at x_i = 0.6.
struct Chain {
    static constexpr double spring = 0.2, damping = 0.04, coupling = 1, cubic = 0.1, frequency = 0.9, wall = 0.6,
                            restitution = 0.7, start = 0.001;
    /// Force at which chains of any length do not reach their walls.
    static constexpr double small_force = 0.3;
    /// Force at which the first oscillators impact their walls repeatedly.
    static constexpr double large_force = 1;
};

/// Returns the model with displacements, velocities and the phase of the force; parameters F, omega, e and wall.
inline graze::Model chain(std::size_t oscillators, double force) {
    using graze::Expression;
    const auto numbered = [](const char* stem, std::size_t i) { return stem + std::to_string(i); };
    graze::Model model;
    model.name = numbered("chain-", oscillators);
    for (const auto& [name, value] :
         {std::pair{"F", force}, {"omega", Chain::frequency}, {"e", Chain::restitution}, {"wall", Chain::wall}})
        model.parameters.push_back({name, "", "", value, std::nullopt});
    const std::vector<Expression> parameters = model.parameter_symbols();
    const Expression zero = model.number(0);
    for (const char* stem : {"x", "v"})
        for (std::size_t i = 1; i <= oscillators; ++i)
            model.states.push_back(
                {numbered(stem, i), "", "", stem[0] == 'x' ? model.number(Chain::start) : zero, {}, false});
    model.states.push_back({"theta", "", "", zero, 8 * atan(model.number(1)), false});
    const std::vector<Expression> states = model.state_symbols();

    graze::Mode mode{"free", "", {states.begin() + static_cast<std::ptrdiff_t>(oscillators), states.end() - 1}, {}};
    model.jumps[0].map = states;
    for (std::size_t i = 0; i < oscillators; ++i) {
        const Expression x = states[i], v = states[oscillators + i];
        Expression stretch = 2 * x;
        if (i > 0)
            stretch = stretch - states[i - 1];
        if (i + 1 < oscillators)
            stretch = stretch - states[i + 1];
        Expression rate =
            -(Chain::spring * x) - Chain::damping * v - Chain::coupling * stretch - Chain::cubic * pow(x, 3.0);
        if (i == 0)
            rate = rate + parameters[0] * cos(states.back());
        mode.rates.push_back(rate);
        mode.watched.push_back(i);
        model.events.push_back({numbered("wall_", i + 1), "", parameters[3] - x});
        model.jumps.push_back({numbered("impact_", i + 1), "", states});
        model.jumps.back().map[oscillators + i] = -(parameters[2] * v);
        model.transitions.push_back({numbered("I", i + 1), 0, i, i + 1, {{{}, "", 0}}, {}});
    }
    mode.rates.push_back(parameters[1]);
    model.modes.push_back(std::move(mode));
    model.sections.push_back({"phase0", "", {}, 2 * oscillators, zero, graze::Direction::both});
    model.validate();
    return model;
}
