#pragma once

#include "graze/picture/figure.hpp"
#include "program/arguments.hpp"

#include <chrono>
#include <string>
#include <vector>

namespace graze {

/// A picture of stroboscopic sections of records over the drive amplitude, which is drawn again as records are added.
class LivePicture {
public:
    /// @throws InputError for an unknown ending of the picture's name, and without gnuplot
    explicit LivePicture(const AcquireArguments& arguments);
    /// Adds a record. @throws InputError when it cannot be read or lacks the channels
    /// @param amplitude peak to peak, in V; @param direction negative: the amplitude falls from record to record
    void add(const std::string& file, double amplitude, int direction);
    /// Draws the picture, unless it was drawn a few seconds ago. @param now draw in any case
    void draw(bool now);

private:
    const AcquireArguments* arguments_;
    Figure figure_;
    bool changed_ = false;
    std::chrono::steady_clock::time_point last_{};
};

} // namespace graze
