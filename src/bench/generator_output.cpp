#include "graze/bench/generator_output.hpp"

#include <numbers>

namespace graze {

double GeneratorOutput::fundamental() const {
    constexpr double pi = std::numbers::pi;
    switch (shape) {
    case WaveShape::sine:
        return amplitude;
    case WaveShape::square:
        return 4 / pi * amplitude;
    case WaveShape::triangle:
        return 8 / (pi * pi) * amplitude;
    case WaveShape::ramp:
        return 2 / pi * amplitude;
    case WaveShape::dc:
        break;
    }
    return 0;
}

bool GeneratorOutput::reaches(double amplitude) {
    // Round-off in the conversion of a unit must not exclude a limit.
    constexpr double roundoff = 1e-12;
    return amplitude >= least_amplitude * (1 - roundoff) && amplitude <= most_amplitude * (1 + roundoff);
}

} // namespace graze
