#include "graze/record/processed_record.hpp"

#include "graze/record/calibrated.hpp"
#include "graze/record/derivative.hpp"
#include "graze/record/low_pass.hpp"

#include <cmath>

namespace graze {

ProcessedRecord::ProcessedRecord(std::unique_ptr<SampleSource> from, const RecordProcessing& processing) {
    stages_.push_back(std::move(from));
    CalibratedSettings calibrated;
    for (const RecordProcessing::Scale& scale : processing.scales)
        calibrated.calibrations.push_back(
            {header().channel(scale.channel, processing.asked_as + "scale"), scale.factor, scale.offset, scale.unit});
    calibrated.begin = processing.begin;
    calibrated.end = processing.end;
    if (!calibrated.calibrations.empty() || !std::isinf(processing.begin) || !std::isinf(processing.end))
        stages_.push_back(std::make_unique<Calibrated>(source(), calibrated));
    if (processing.pass > 0 || processing.every > 1) {
        LowPassSettings filter;
        filter.pass = processing.pass;
        filter.stop = processing.stop;
        filter.every = processing.every;
        stages_.push_back(std::make_unique<LowPass>(source(), filter));
    }
    if (!processing.derivative.empty()) {
        DerivativeSettings derivative;
        derivative.channel = header().channel(processing.derivative, processing.asked_as + "derivative");
        derivative.half_width = processing.half_width;
        stages_.push_back(std::make_unique<WithDerivative>(source(), derivative));
    }
}

} // namespace graze
