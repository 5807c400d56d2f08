#pragma once

#include "graze/record/samples.hpp"

#include <cstddef>
#include <memory>

namespace graze {

struct LowPassSettings {
    double pass = 0, stop = 0; ///< frequencies up to which all passes, and from which nothing does; 0: see LowPass
    double attenuation = 80;   ///< in dB, of what must not pass; what passes changes by no more either
    std::size_t every = 1;     ///< of how many samples one is kept: decimation
};

/// A source without what is faster than some frequency, and with fewer samples: a symmetric filter of finite length,
/// which delays nothing (a sinc under Kaiser's window; J. F. Kaiser, Proc. IEEE Int. Symp. Circuits and Systems (1974)
/// 20). When samples are dropped and nothing is said, all passes up to 0.35 of the new sampling frequency, and nothing
/// from half of it, so that no frequency appears as another. Without dropping one has to say `pass`; `stop` is 1.5
/// times that. Rows at both ends, of which the filter would need others outside of the record, are left out.
class LowPass : public SampleSource {
public:
    /// @param source is shared
    /// @throws InputError for settings without meaning
    LowPass(std::shared_ptr<SampleSource> source, const LowPassSettings& settings);
    ~LowPass() override;
    const RecordHeader& header() const override;
    /// @throws InputError when the samples are not at equal distances of time, or the record is shorter than the filter
    bool read(Samples& samples) override;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace graze
