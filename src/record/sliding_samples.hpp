#pragma once

#include "graze/record/samples.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

namespace graze {

/// A source seen through a window that moves along it: rows `first` ... `last` - 1 of what is in it have so many rows
/// before and behind them, and each row of the source is once among them but for those at its ends.
class SlidingSamples {
public:
    SlidingSamples(std::shared_ptr<SampleSource> source, std::size_t margin)
        : source_(std::move(source)), margin_(margin), first_(margin) {
        samples_.clear(source_->header().channels.size());
    }
    /// Moves on. @return false when there are no more rows
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
    /// Rows of the source before the first in the window.
    std::size_t dropped() const { return dropped_; }

private:
    std::shared_ptr<SampleSource> source_;
    std::size_t margin_, first_, last_ = 0, dropped_ = 0;
    Samples samples_, part_;
};

} // namespace graze
