#pragma once

#include "graze/record/samples.hpp"

#include <cstddef>
#include <memory>
#include <utility>

namespace graze {

/// A sliding window over a source: rows `first` ... `last` - 1 of the window have at least `margin` rows before and
/// after them. Each row of the source, except those near its ends, is among them exactly once.
class SlidingSamples {
public:
    /// @param begun rows that were read from the source already
    SlidingSamples(std::shared_ptr<SampleSource> source, std::size_t margin, Samples begun = {})
        : source_(std::move(source)), margin_(margin), first_(margin), samples_(std::move(begun)) {
        samples_.values.resize(source_->header().channels.size());
    }
    /// Moves the window. @return false when there are no more rows
    bool next() {
        const std::size_t drop = last_ > 0 ? last_ - margin_ : 0;
        samples_.drop_front(drop);
        dropped_ += drop;
        first_ = margin_;
        last_ = 0;
        while (samples_.rows() <= 2 * margin_) {
            if (!source_->read(part_))
                return false;
            samples_.append(part_);
        }
        last_ = samples_.rows() - margin_;
        return true;
    }
    const Samples& samples() const { return samples_; }
    std::size_t first() const { return first_; }
    std::size_t last() const { return last_; }
    /// Number of source rows before the first row of the window.
    std::size_t dropped() const { return dropped_; }

private:
    std::shared_ptr<SampleSource> source_;
    std::size_t margin_, first_, last_ = 0, dropped_ = 0;
    Samples samples_, part_;
};

} // namespace graze
