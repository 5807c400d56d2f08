#include "sweep/motion_parts.hpp"

#include <algorithm>
#include <utility>

namespace graze {

namespace {

constexpr std::size_t most_parts = 6; ///< largest number of parts; they are merged in pairs when there are more

} // namespace

void MotionPart::include(const MotionPart& other) {
    include(other.least);
    include(other.greatest);
    contacts = contacts || other.contacts;
}

void MotionPart::include(std::span<const double> state) {
    for (std::size_t i = 0; i < state.size(); ++i) {
        least[i] = std::min(least[i], state[i]);
        greatest[i] = std::max(greatest[i], state[i]);
    }
}

void MotionParts::clear() {
    parts_.clear();
    length_ = 1;
    in_current_ = quiet_ = 0;
}

void MotionParts::add(const MotionPart& one) {
    quiet_ = one.contacts ? 0 : quiet_ + 1;
    if (in_current_ == 0)
        current_ = one;
    else
        current_.include(one);
    if (++in_current_ < length_)
        return;
    in_current_ = 0;
    parts_.push_back(current_);
    if (parts_.size() < most_parts)
        return;
    for (std::size_t k = 0; k < most_parts / 2; ++k) {
        parts_[2 * k].include(parts_[2 * k + 1]);
        if (k > 0)
            parts_[k] = std::move(parts_[2 * k]);
    }
    parts_.resize(most_parts / 2);
    length_ *= 2;
}

} // namespace graze
