#include "graze/trajectory/recorder.hpp"
#include "flow/cyclic.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

Relay::Relay(std::vector<std::shared_ptr<Observer>> observers) : observers_(std::move(observers)) {
    if (std::find(observers_.begin(), observers_.end(), nullptr) != observers_.end())
        throw InputError("one of the observers is null", "leave it out");
}

ArcMinima::ArcMinima(Receiver receiver) : receiver_(std::move(receiver)) {
    if (!receiver_)
        throw InputError("there is no receiver of the minima", "give a function");
}

void Relay::step(const Step& step) {
    for (const auto& observer : observers_)
        observer->step(step);
}

void Relay::contact(const Contact& contact) {
    for (const auto& observer : observers_)
        observer->contact(contact);
}

void Relay::passage(const Passage& passage) {
    for (const auto& observer : observers_)
        observer->passage(passage);
}

void Relay::minimum(const StepMinimum& minimum) {
    for (const auto& observer : observers_)
        observer->minimum(minimum);
}

bool Relay::stop() {
    return std::any_of(observers_.begin(), observers_.end(), [](const auto& observer) { return observer->stop(); });
}

void Recorder::contact(const Contact& contact) {
    RecordedContact& record = contacts_.emplace_back();
    record.contact = contact;
    record.contact.before = record.contact.after = {};
    record.before.assign(contact.before.begin(), contact.before.end());
    record.after.assign(contact.after.begin(), contact.after.end());
}

void Recorder::passage(const Passage& passage) {
    RecordedPassage& record = passages_.emplace_back();
    record.passage = passage;
    record.passage.state = {};
    record.state.assign(passage.state.begin(), passage.state.end());
}

void Recorder::clear() {
    contacts_.clear();
    passages_.clear();
}

double RecordedStep::state(std::size_t index, double s) const {
    require_index(index, states, "state");
    const auto terms = static_cast<std::size_t>(order) + 1;
    return evaluate_polynomial(Series{coefficients.data() + index * terms, 1}, terms, s);
}

void StepRecorder::step(const Step& step) {
    RecordedStep& record = steps_.emplace_back();
    record.start = step.start;
    record.length = step.length;
    record.mode = step.mode;
    record.states = step.states.size();
    record.order = step.order;
    for (const auto& all : {step.states, step.events, step.observed})
        for (const Series& one : all)
            for (int k = 0; k <= step.order; ++k)
                record.coefficients.push_back(one[static_cast<std::size_t>(k)]);
}

Sampler::Sampler(double start, double spacing, std::size_t count, std::vector<double> periods, Receiver receiver)
    : start_(start), spacing_(spacing), count_(count), periods_(std::move(periods)), state_(periods_.size()),
      receiver_(std::move(receiver)) {
    require_finite(start, "the time of the first sample");
    require_finite(periods_, "the period of a state");
    if (!(spacing > 0) || !std::isfinite(spacing))
        throw InputError(fmt::format("the spacing {} of samples is not a positive time", spacing),
                         "give a positive one");
    if (!receiver_)
        throw InputError("there is no receiver of the samples", "give a function");
}

void Sampler::step(const Step& step) {
    require_size(periods_.size(), step.states.size(), "periods of states");
    for (; taken_ < count_; ++taken_) {
        const double time = next();
        // Start and length of the step are both rounded.
        if (!(time <= step.start + step.length + 2 * std::numeric_limits<double>::epsilon() * std::abs(time)))
            return;
        const double s = std::clamp(time - step.start, 0.0, step.length);
        for (std::size_t i = 0; i < state_.size(); ++i)
            state_[i] = within_period(step.state(i, s), periods_[i]);
        receiver_(time, step.mode, state_);
    }
}

void Sampler::coarsen() {
    spacing_ *= 2;
    taken_ = (taken_ + 1) / 2 - 1; // the present sample has not been counted yet
}

void ArcMinima::step(const Step& step) {
    if (!begun_) {
        begun_ = true;
        mode_ = step.mode;
        start_ = step.start;
    }
    end_ = step.start + step.length;
}

void ArcMinima::minimum(const StepMinimum& minimum) {
    const auto known = std::find_if(current_.begin(), current_.end(),
                                    [&](const ArcMinimum& other) { return other.event == minimum.event; });
    ArcMinimum found;
    found.event = minimum.event;
    found.time = minimum.time;
    found.value = minimum.minimum.value;
    found.lower_bound = minimum.minimum.lower_bound;
    if (known == current_.end()) {
        current_.push_back(found);
        return;
    }
    found.lower_bound = std::min(found.lower_bound, known->lower_bound);
    if (found.value < known->value)
        *known = found;
    known->lower_bound = found.lower_bound;
}

void ArcMinima::contact(const Contact& contact) {
    if (contact.kind != ContactKind::touch)
        finish();
}

void ArcMinima::finish() {
    for (ArcMinimum& entry : current_) {
        entry.arc = arc_;
        entry.mode = mode_;
        entry.start = start_;
        entry.end = end_;
        receiver_(entry);
    }
    current_.clear();
    arc_ += begun_ ? 1 : 0;
    begun_ = false;
}

} // namespace graze
