#include "graze/trajectory/run_control.hpp"

#include <algorithm>

namespace graze {

RunControl::RunControl(std::shared_ptr<Observer> recorders, std::optional<std::size_t> period_probe,
                       std::vector<bool> counted)
    : recorders_(recorders ? std::move(recorders) : std::make_shared<Observer>()), period_probe_(period_probe),
      counted_(std::move(counted)) {}

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
    if (progress_)
        progress_(fraction, time_);
    return is_reached() || (ends_ && ends_());
}

} // namespace graze
