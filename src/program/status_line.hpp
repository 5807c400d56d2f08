#pragma once

#include "program/program.hpp"

#include <chrono>
#include <string>

namespace graze {

/// A line of progress on standard error, which is rewritten in place. It appears after two seconds, changes at most
/// five times a second, and is erased by the destructor.
class StatusLine {
public:
    StatusLine(const Console& console, bool wanted) : console_(&console), wanted_(wanted) {}
    ~StatusLine();
    StatusLine(const StatusLine&) = delete;
    StatusLine& operator=(const StatusLine&) = delete;

    bool wanted() const { return wanted_; }
    /// True when the line may be written: it is wanted, and the times above have passed.
    bool is_due() const;
    double elapsed() const; ///< seconds since construction
    void show(const std::string& text);

private:
    using Clock = std::chrono::steady_clock;

    const Console* console_;
    bool wanted_, shown_ = false;
    Clock::time_point start_ = Clock::now(), last_ = start_;
};

} // namespace graze
