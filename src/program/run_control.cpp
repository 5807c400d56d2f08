#include "program/run_control.hpp"

#include "program/interrupt.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

using namespace std::chrono_literals;
constexpr auto quiet_at_first = 2s;
constexpr auto between_lines = 200ms;
constexpr int calls_between_looks = 64; ///< at the clock

} // namespace

Progress::Progress(const Console& console, bool wanted)
    : console_(&console), wanted_(wanted), start_(Clock::now()), last_(start_) {}

Progress::~Progress() {
    if (shown_)
        console_->progress() << (console_->terminal ? "\r\033[K" : "\n") << std::flush;
}

void Progress::update(std::optional<double> fraction, double time) {
    if (!wanted_ || ++calls_ < calls_between_looks)
        return;
    calls_ = 0;
    const auto now = Clock::now();
    if (now - start_ < quiet_at_first || now - last_ < between_lines)
        return;
    last_ = now;
    shown_ = true;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    std::string line = fmt::format("\rtime {:.6g}", time);
    if (fraction && *fraction > 0)
        line += fmt::format(", {:.0f} %, {:.0f} s left", 100 * *fraction, elapsed * (1 - *fraction) / *fraction);
    console_->progress() << fmt::format("{:<60}", line) << std::flush;
}

RunControl::RunControl(Observer& recorders, Progress& progress, std::optional<std::size_t> period_probe,
                       std::vector<bool> counted)
    : recorders_(&recorders), progress_(&progress), period_probe_(period_probe), counted_(std::move(counted)) {}

void RunControl::begin(const LegEnd& end, double time, bool shown) {
    end_ = end;
    start_ = time_ = time;
    periods_ = contacts_ = 0;
    shown_ = shown;
}

void RunControl::step(const Step& step) {
    time_ = step.start + step.length;
    if (shown_)
        recorders_->step(step);
}

void RunControl::contact(const Contact& contact) {
    if (contact.kind != ContactKind::touch && counted_[contact.event])
        ++contacts_;
    if (shown_)
        recorders_->contact(contact);
}

void RunControl::passage(const Passage& passage) {
    if (period_probe_ && passage.probe == *period_probe_)
        ++periods_;
    else if (shown_)
        recorders_->passage(passage);
}

void RunControl::minimum(const StepMinimum& minimum) {
    if (shown_)
        recorders_->minimum(minimum);
}

bool RunControl::is_reached() const {
    return (end_.periods > 0 && periods_ >= end_.periods) || (end_.contacts > 0 && contacts_ >= end_.contacts);
}

bool RunControl::stop() {
    std::optional<double> fraction;
    if (end_.expected)
        fraction = std::min(1.0, (time_ - start_) / *end_.expected);
    else if (end_.contacts > 0)
        fraction = static_cast<double>(contacts_) / static_cast<double>(end_.contacts);
    progress_->update(fraction, time_);
    return is_reached() || InterruptGuard::requested() || is_full_();
}

} // namespace graze
