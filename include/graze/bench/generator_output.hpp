#pragma once

namespace graze {

enum class WaveShape { sine, square, triangle, ramp, dc };

/// A wave, as the display of a function generator shows it.
struct GeneratorOutput {
    double frequency = 1000; ///< in Hz
    double amplitude = 0.1;  ///< from peak to peak, in V; dc has none
    double offset = 0;       ///< in V
    WaveShape shape = WaveShape::sine;

    /// From peak to peak, of the part of the wave at its frequency, which drives a model that knows of sines only.
    double fundamental() const;

    static constexpr double least_amplitude = 0.05, most_amplitude = 10; ///< that a generator gives, in V, into 50 ohm
    /// Whether a generator gives such an amplitude.
    static bool reaches(double amplitude);
    bool operator==(const GeneratorOutput&) const = default;
};

} // namespace graze
