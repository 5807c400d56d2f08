#include "graze/record/processed_record.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/record/calibrated.hpp"
#include "graze/record/derivative.hpp"
#include "graze/record/low_pass.hpp"

#include <cmath>

namespace graze {

namespace {

/// Passes samples on, and throws if there are none at all, since any result would be empty.
class RequiredRows : public SampleSource {
public:
    explicit RequiredRows(std::shared_ptr<SampleSource> source) : source_(std::move(source)) {}
    const RecordHeader& header() const override { return source_->header(); }
    bool read(Samples& samples) override {
        const bool more = source_->read(samples);
        has_rows_ = has_rows_ || samples.rows() > 0;
        if (!more && !has_rows_)
            throw InputError("the record has no rows", "give one with rows, and let `part` leave some");
        return more;
    }

private:
    std::shared_ptr<SampleSource> source_;
    bool has_rows_ = false;
};

} // namespace

ProcessedRecord::ProcessedRecord(std::shared_ptr<SampleSource> source, const RecordProcessing& processing)
    : source_(required(std::move(source), "a source")) {
    CalibratedSettings calibrated{{}, processing.begin, processing.end};
    for (const RecordProcessing::Scale& scale : processing.scales)
        calibrated.calibrations.push_back(
            {header().channel(scale.channel, "scale"), scale.factor, scale.offset, scale.unit});
    if (!calibrated.calibrations.empty() || !std::isinf(processing.begin) || !std::isinf(processing.end))
        source_ = std::make_shared<Calibrated>(source_, calibrated);
    if (processing.pass > 0 || processing.every > 1)
        source_ = std::make_shared<LowPass>(
            source_, LowPassSettings{.pass = processing.pass, .stop = processing.stop, .every = processing.every});
    if (!processing.derivative.empty()) {
        const std::size_t channel = header().channel(processing.derivative, "derivative");
        source_ = std::make_shared<WithDerivative>(source_, DerivativeSettings{channel, processing.half_width, ""});
    }
    source_ = std::make_shared<RequiredRows>(source_);
}

} // namespace graze
