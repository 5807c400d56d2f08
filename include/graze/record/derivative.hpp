#pragma once

#include "graze/record/samples.hpp"

#include <cstddef>
#include <memory>
#include <string>

namespace graze {

struct DerivativeSettings {
    std::size_t channel = 0;    ///< of the displacement
    std::size_t half_width = 0; ///< samples on each side, 4 or more; 0: chosen where the errors are least
    std::string name; ///< of the new channel, such as `q_rate` if it is empty; that of its error ends in `_error`
};

/// A source with two channels more: the derivative of one of its channels, and how far that is wrong. The derivative is
/// that of a polynomial of fourth degree that fits the samples around by least squares (A. Savitzky and M. J. E. Golay,
/// Anal. Chem. 36 (1964) 1627). Its error has two parts: the standard error that the noise makes, which is what a
/// polynomial of sixth degree leaves, and by how much the derivative of that one differs: at least by as much as it
/// does in the root of mean squares, since at a single sample that is as noisy as the derivative. The width is the one
/// for which this error is least at the record's beginning. Where the velocity jumps no polynomial fits, and the error
/// is large. Rows at both ends are left out. Times that are not at equal distances are taken as they are told, unless
/// that is no more than their rounding.
class WithDerivative : public SampleSource {
public:
    /// @param source is shared
    /// @throws InputError for settings without meaning
    WithDerivative(std::shared_ptr<SampleSource> source, const DerivativeSettings& settings);
    ~WithDerivative() override;
    const RecordHeader& header() const override;
    /// @throws InputError when there are gaps between the samples, or the record is too short
    bool read(Samples& samples) override;
    /// Samples on each side, once something has been read.
    std::size_t half_width() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace graze
