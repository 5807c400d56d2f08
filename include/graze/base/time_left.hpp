#pragma once

#include <cstddef>
#include <deque>
#include <optional>

namespace graze {

/// Estimates the remaining time of a computation of many points from the time that the computed points took.
class TimeLeft {
public:
    struct Estimate {
        double seconds = 0;
        bool at_least = false; ///< a lower bound: points have become slower, or some work is of unknown length
    };

    /// Notes that `computed` points took `seconds` in total. Both rise from call to call.
    void note(std::size_t computed, double seconds);
    /// Estimates the time for the points that are left. The estimate never rises from call to call: where points become
    /// slower, the earlier value is kept and marked as a lower bound. None until enough points have been computed.
    std::optional<Estimate> of(std::size_t points_left);

private:
    struct Moment {
        std::size_t computed;
        double seconds;
    };
    /// Returns the time of one point: the larger of the mean over all points and the mean over the recent ones.
    std::optional<double> seconds_of_a_point() const;

    std::deque<Moment> moments_; ///< recent calls of `note`, a few
    Moment now_{0, 0};
    std::optional<double> shown_;
};

} // namespace graze
