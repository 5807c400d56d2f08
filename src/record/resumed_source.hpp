#pragma once

#include "graze/record/samples.hpp"

#include <memory>
#include <utility>

namespace graze {

/// A source that first returns samples already read from another, and then the rest of it.
class ResumedSource : public SampleSource {
public:
    ResumedSource(std::shared_ptr<SampleSource> source, Samples begun)
        : source_(std::move(source)), begun_(std::move(begun)) {}
    const RecordHeader& header() const override { return source_->header(); }
    bool read(Samples& samples) override {
        if (begun_.rows() == 0)
            return source_->read(samples);
        samples = std::exchange(begun_, Samples());
        return true;
    }

private:
    std::shared_ptr<SampleSource> source_;
    Samples begun_;
};

} // namespace graze
