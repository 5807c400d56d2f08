#pragma once

#include "graze/record/samples.hpp"

#include <cstddef>
#include <memory>

namespace graze {

/// Options of `LowPass`.
struct LowPassSettings {
    /// End of the pass band, and start of the stop band, in cycles per unit of time; 0: see LowPass.
    double pass = 0, stop = 0;
    double attenuation = 80; ///< attenuation of the stop band in dB; it also bounds the ripple of the pass band
    std::size_t every = 1;   ///< decimation: one of this many samples is kept
};

/// A source filtered by a low pass, and optionally decimated. The filter is symmetric and finite, so it causes no delay
/// (a sinc with Kaiser's window; J. F. Kaiser, Proc. IEEE Int. Symp. Circuits and Systems (1974) 20). For decimation
/// the default bands are: pass up to 0.35 of the new sampling frequency, stop from half of it, so that nothing is
/// aliased. Without decimation `pass` is required, and `stop` is 1.5 times that by default. Rows at both ends, for
/// which the filter would need samples outside the record, are left out.
class LowPass : public SampleSource {
public:
    /// @param source is shared
    /// @throws InputError for invalid settings
    LowPass(std::shared_ptr<SampleSource> source, const LowPassSettings& settings);
    ~LowPass() override;
    const RecordHeader& header() const override;
    /// @throws InputError when the samples are not equidistant in time, or the record is shorter than the filter
    bool read(Samples& samples) override;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace graze
