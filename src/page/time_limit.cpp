#include "page/time_limit.hpp"

#include <chrono>

namespace graze {

std::function<bool()> time_limit(double seconds, const std::function<bool()>& interrupted) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    return [end, interrupted] { return Clock::now() > end || (interrupted && interrupted()); };
}

} // namespace graze
