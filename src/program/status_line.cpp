#include "program/status_line.hpp"

#include <fmt/format.h>

namespace graze {

namespace {

using namespace std::chrono_literals;
constexpr auto quiet_at_first = 2s;
constexpr auto between_lines = 200ms;

} // namespace

StatusLine::~StatusLine() {
    if (shown_)
        console_->progress() << (console_->terminal ? "\r\033[K" : "\n") << std::flush;
}

bool StatusLine::is_due() const {
    const auto now = Clock::now();
    return wanted_ && now - start_ >= quiet_at_first && now - last_ >= between_lines;
}

double StatusLine::elapsed() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
}

void StatusLine::show(const std::string& text) {
    last_ = Clock::now();
    shown_ = true;
    console_->progress() << fmt::format("\r{:<78}", text) << std::flush;
}

} // namespace graze
