#pragma once

#include "graze/picture/figure.hpp"
#include "program/arguments.hpp"

#include <chrono>
#include <string>
#include <vector>

namespace graze {

/// Sections of records over the amplitude that they were taken at, drawn again while more of them come.
class LivePicture {
public:
    /// @throws InputError for an ending that cannot be drawn, and without gnuplot
    explicit LivePicture(const AcquireArguments& arguments);
    /// Adds a record. @throws InputError when it cannot be read, or has not these channels
    void add(const std::string& file, double amplitude, int direction);
    /// Draws it, unless that was done a short time ago. @param now in any case
    void draw(bool now);

private:
    const AcquireArguments* arguments_;
    Figure figure_;
    bool changed_ = false;
    std::chrono::steady_clock::time_point last_{};
};

} // namespace graze
