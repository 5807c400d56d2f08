#pragma once

#include <cstddef>
#include <deque>
#include <optional>

namespace graze {

/// How long work will take that consists of many points, from what those have taken that were done.
class TimeLeft {
public:
    struct Estimate {
        double seconds = 0;
        bool at_least = false; ///< it may be more: points have begun to take longer, or there is work of unknown length
    };

    /// So many points have been computed after so many seconds, which both rise from call to call.
    void note(std::size_t computed, double seconds);
    /// For so many points that are left. It does not climb: where points turn out to take longer, it is what they take
    /// at least. None while too little has been done to tell.
    std::optional<Estimate> of(std::size_t points_left);

private:
    struct Moment {
        std::size_t computed;
        double seconds;
    };
    /// Of one point: what the slower of all and of those of late took.
    std::optional<double> seconds_of_a_point() const;

    std::deque<Moment> moments_; ///< of late, a few
    Moment now_{0, 0};
    std::optional<double> shown_;
};

} // namespace graze
