#pragma once

#include "program/program.hpp"

#include <chrono>
#include <string>

namespace graze {

/// A line on standard error about how far work has come, rewritten in its place: not before two seconds have passed,
/// not more often than five times a second, and gone when the work is done.
class StatusLine {
public:
    StatusLine(const Console& console, bool wanted) : console_(&console), wanted_(wanted) {}
    ~StatusLine();
    StatusLine(const StatusLine&) = delete;
    StatusLine& operator=(const StatusLine&) = delete;

    bool wanted() const { return wanted_; }
    /// Whether it is time to show something.
    bool is_due() const;
    double elapsed() const; ///< seconds since it was made
    void show(const std::string& text);

private:
    using Clock = std::chrono::steady_clock;

    const Console* console_;
    bool wanted_, shown_ = false;
    Clock::time_point start_ = Clock::now(), last_ = start_;
};

} // namespace graze
