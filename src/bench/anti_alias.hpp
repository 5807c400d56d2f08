#pragma once

#include <array>
#include <cstddef>

namespace graze {

/// A fourth-order Butterworth low pass, applied sample by sample; designed by the bilinear transform with its corner
/// prewarped (A. V. Oppenheim and R. W. Schafer, "Discrete-Time Signal Processing", chapter 7).
class AntiAlias {
public:
    AntiAlias() = default;
    /// @param corner frequency of 3 dB attenuation, relative to the sampling frequency; below 1/2
    explicit AntiAlias(double corner);
    /// Returns the output for the next input sample.
    double filtered(double sample);
    /// Sets the filter to its steady state for a constant input.
    void settle(double value);

private:
    static constexpr std::size_t sections = 2;
    struct Section {
        double b = 0, a1 = 0, a2 = 0; ///< numerator b (1 + 2/z + 1/z^2)
        double first = 0, second = 0; ///< state from earlier samples
    };
    std::array<Section, sections> sections_;
};

} // namespace graze
