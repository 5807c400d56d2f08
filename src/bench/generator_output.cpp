#include "graze/bench/generator_output.hpp"

#include <numbers>

namespace graze {

double GeneratorOutput::fundamental() const {
    constexpr double pi = std::numbers::pi;
    constexpr double factors[]{1, 4 / pi, 8 / (pi * pi), 2 / pi, 0}; // in the order of WaveShape
    return factors[static_cast<int>(shape)] * amplitude;
}

bool GeneratorOutput::reaches(double amplitude) {
    // Round-off in the conversion of a unit must not exclude a limit.
    constexpr double roundoff = 1e-12;
    return amplitude >= least_amplitude * (1 - roundoff) && amplitude <= most_amplitude * (1 + roundoff);
}

} // namespace graze
