#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Between which values each state has been, and whether anything happened to the motion.
struct MotionPart {
    std::vector<double> least, greatest;
    bool contacts = false;

    void include(const MotionPart& other);
    void include(std::span<const double> state);
    double extent(std::size_t state) const { return greatest[state] - least[state]; }
};

/// All returns of a motion in a few parts of equal length, which double when they become too many: however slow the
/// motion is beside the clock that says what a return is, parts are as long as what has been seen allows.
class MotionParts {
public:
    void clear();
    void add(const MotionPart& one);
    /// Complete parts.
    std::size_t count() const { return parts_.size(); }
    const MotionPart& recent(std::size_t before) const { return parts_[parts_.size() - 1 - before]; }
    /// Returns in a row, up to the last, in which nothing happened.
    std::size_t quiet() const { return quiet_; }

private:
    std::vector<MotionPart> parts_;
    MotionPart current_;
    std::size_t length_ = 1, in_current_ = 0, quiet_ = 0; ///< in returns
};

} // namespace graze
