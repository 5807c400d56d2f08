#include "program/progress_line.hpp"

#include <fmt/format.h>

namespace graze {

std::string progress_text(const StudyProgress& progress, const std::optional<TimeLeft::Estimate>& left) {
    std::string text = fmt::format("{}: {} of {} points", progress.run, progress.done, progress.points);
    if (progress.study_points > progress.points)
        text += fmt::format("; study: {} of {}", progress.study_done, progress.study_points);
    text += fmt::format(", {:.0f} %", 100.0 * static_cast<double>(progress.study_done) /
                                          static_cast<double>(std::max<std::size_t>(progress.study_points, 1)));
    constexpr double least = 0.5; // less would be printed as 0 s
    if (left && left->seconds >= least)
        text += fmt::format(", {}{:.0f} s left", left->at_least || progress.branches_left > 0 ? "more than " : "",
                            left->seconds);
    return text;
}

void ProgressLine::update(const StudyProgress& progress) {
    if (!line_.wanted())
        return;
    left_.note(progress.computed, line_.elapsed());
    if (line_.is_due())
        line_.show(progress_text(progress, left_.of(progress.study_points - progress.study_done)));
}

void ProgressLine::update(const std::string& run, const OrbitRecord& orbit) {
    if (line_.is_due())
        line_.show(fmt::format("{}: {} orbits, at {:.8g}", run, orbit.number + 1, orbit.point.parameter));
}

} // namespace graze
