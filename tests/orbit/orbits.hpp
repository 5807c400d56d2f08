// Orbits of tests: given ones, and those on which motions settle.

#pragma once

#include "graze/orbit/solve.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace graze::testing {

inline Orbit given_orbit(const Model& model, const std::string& signature, std::vector<std::vector<double>> starts,
                         std::vector<double> durations) {
    return {parse_signature(model, signature), model.parameter_values(), std::move(starts), std::move(durations), {}};
}

inline OrbitSolution settled(const Model& model, const std::string& section, std::size_t cycles = 2000) {
    OrbitSolution solution = find_orbit(System(model), {.section = section, .cycles = cycles});
    EXPECT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
    return solution;
}

} // namespace graze::testing
