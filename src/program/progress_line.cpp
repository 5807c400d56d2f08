#include "program/progress_line.hpp"

#include <fmt/format.h>

namespace graze {

namespace {

using namespace std::chrono_literals;
constexpr auto quiet_at_first = 2s;
constexpr auto between_lines = 200ms;

} // namespace

std::string progress_text(const StudyProgress& progress, const std::optional<TimeLeft::Estimate>& left) {
    std::string text = fmt::format("{}: {} of {} points", progress.run, progress.done, progress.points);
    if (progress.study_points > progress.points)
        text += fmt::format("; study: {} of {}", progress.study_done, progress.study_points);
    text += fmt::format(", {:.0f} %", 100.0 * static_cast<double>(progress.study_done) /
                                          static_cast<double>(std::max<std::size_t>(progress.study_points, 1)));
    constexpr double least = 0.5; // less would read as nothing
    if (left && left->seconds >= least)
        text += fmt::format(", {}{:.0f} s left", left->at_least || progress.branches_left > 0 ? "more than " : "",
                            left->seconds);
    return text;
}

ProgressLine::~ProgressLine() {
    if (shown_)
        console_->progress() << (console_->terminal ? "\r\033[K" : "\n") << std::flush;
}

bool ProgressLine::is_due() const {
    const auto now = Clock::now();
    return wanted_ && now - start_ >= quiet_at_first && now - last_ >= between_lines;
}

void ProgressLine::show(const std::string& text) {
    last_ = Clock::now();
    shown_ = true;
    console_->progress() << fmt::format("\r{:<78}", text) << std::flush;
}

void ProgressLine::update(const StudyProgress& progress) {
    if (!wanted_)
        return;
    left_.note(progress.computed, std::chrono::duration<double>(Clock::now() - start_).count());
    if (is_due())
        show(progress_text(progress, left_.of(progress.study_points - progress.study_done)));
}

void ProgressLine::update(const std::string& run, const OrbitRecord& orbit) {
    if (is_due())
        show(fmt::format("{}: {} orbits, at {:.8g}", run, orbit.number + 1, orbit.point.parameter));
}

} // namespace graze
