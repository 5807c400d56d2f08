#pragma once

#include "graze/record/samples.hpp"

#include <utility>

namespace graze {

/// A source that first returns samples already read from another, and then the rest of it.
class ResumedSource : public SampleSource {
public:
    ResumedSource(SampleSource& source, Samples begun) : source_(&source), begun_(std::move(begun)) {}
    const RecordHeader& header() const override { return source_->header(); }
    bool read(Samples& samples) override {
        if (begun_.rows() == 0)
            return source_->read(samples);
        samples = std::exchange(begun_, Samples());
        return true;
    }

private:
    SampleSource* source_;
    Samples begun_;
};

} // namespace graze
