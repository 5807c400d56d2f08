#pragma once

#include <array>
#include <cstddef>

namespace graze {

/// A low-pass filter of Butterworth's of fourth order as samples pass through it, by the bilinear transform with its
/// corner where it is asked for (A. V. Oppenheim and R. W. Schafer, "Discrete-Time Signal Processing", chapter 7).
class AntiAlias {
public:
    AntiAlias() = default;
    /// @param corner where 3 dB are lost, as a part of the frequency at which samples come; below 1/2
    explicit AntiAlias(double corner);
    /// What comes out when one more sample has gone in.
    double filtered(double sample);
    /// As after a long time of this value.
    void settle(double value);

private:
    static constexpr std::size_t sections = 2;
    struct Section {
        double b = 0, a1 = 0, a2 = 0; ///< numerator b (1 + 2/z + 1/z^2)
        double first = 0, second = 0; ///< what is kept of earlier samples
    };
    std::array<Section, sections> sections_;
};

} // namespace graze
