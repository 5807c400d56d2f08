#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// The range of each state over a part of a motion, and whether there were contacts.
struct MotionPart {
    std::vector<double> least, greatest;
    bool contacts = false;

    void include(const MotionPart& other);
    void include(std::span<const double> state);
    double extent(std::size_t state) const { return greatest[state] - least[state]; }
};

/// All returns of a motion in a few parts of equal length; the length doubles when there are too many parts. However
/// slow the motion is relative to the section's clock, parts are as long as the observation allows.
class MotionParts {
public:
    void clear();
    void add(const MotionPart& one);
    /// Returns the number of complete parts.
    std::size_t count() const { return parts_.size(); }
    const MotionPart& recent(std::size_t before) const { return parts_[parts_.size() - 1 - before]; }
    /// Returns the number of consecutive returns without contacts, up to the last.
    std::size_t quiet() const { return quiet_; }

private:
    std::vector<MotionPart> parts_;
    MotionPart current_;
    std::size_t length_ = 1, in_current_ = 0, quiet_ = 0; ///< in returns
};

} // namespace graze
