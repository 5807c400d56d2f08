#pragma once

#include "graze/record/samples.hpp"

#include <cstddef>
#include <memory>
#include <string>

namespace graze {

/// Options of `WithDerivative`.
struct DerivativeSettings {
    std::size_t channel = 0;    ///< channel to differentiate
    std::size_t half_width = 0; ///< samples of the window on each side, 4 or more; 0: chosen for the smallest error
    std::string name; ///< name of the new channel; empty: the old one with `_rate`; that of its error adds `_error`
};

/// A source with two additional channels: the derivative of one of its channels, and its standard error. The derivative
/// is that of a fourth-degree polynomial fitted to a window of samples by least squares (A. Savitzky and M. J. E.
/// Golay, Anal. Chem. 36 (1964) 1627). Its error combines two parts: the standard error from the noise, which is
/// estimated from the residuals of a sixth-degree polynomial, and the truncation error, estimated from the difference
/// of the two polynomials' derivatives. As that difference is itself noisy, at least its root mean square over the
/// record is used. The width minimises this error at the beginning of the record. Where the velocity jumps no
/// polynomial fits, and the error is large. Rows at both ends are left out. Times that are not equidistant are used as
/// they are, unless the deviations are at most their rounding.
class WithDerivative : public SampleSource {
public:
    /// @param source is shared
    /// @throws InputError for invalid settings
    WithDerivative(std::shared_ptr<SampleSource> source, const DerivativeSettings& settings);
    ~WithDerivative() override;
    const RecordHeader& header() const override;
    /// @throws InputError when there are gaps between the samples, or the record is too short
    bool read(Samples& samples) override;
    /// Samples of the window on each side; known once something has been read.
    std::size_t half_width() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace graze
