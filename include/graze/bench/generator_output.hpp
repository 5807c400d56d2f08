#pragma once

namespace graze {

enum class WaveShape { sine, square, triangle, ramp, dc };

/// Output of a function generator, as its display shows it.
struct GeneratorOutput {
    double frequency = 1000; ///< in Hz
    double amplitude = 0.1;  ///< peak to peak, in V; unused for dc
    double offset = 0;       ///< in V
    WaveShape shape = WaveShape::sine;

    /// Peak-to-peak amplitude of the wave's fundamental, which drives models with a sinusoidal input.
    double fundamental() const;

    /// Range of the generator's amplitude, in V into 50 ohm.
    static constexpr double least_amplitude = 0.05, most_amplitude = 10;
    /// Whether an amplitude is within the generator's range.
    static bool reaches(double amplitude);
    bool operator==(const GeneratorOutput&) const = default;
};

} // namespace graze
