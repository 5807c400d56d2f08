#include "bench/bench_motion.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

std::vector<Expression> values_of(const BenchSettings& settings) {
    std::vector<Expression> values;
    for (const BenchChannel& channel : settings.channels)
        values.push_back(channel.value.value);
    return values;
}

} // namespace

BenchMotion::BenchMotion(const BenchSettings& settings)
    : model_(settings.model), amplitude_(settings.amplitude), frequency_(settings.frequency), offset_(settings.offset),
      time_unit_(settings.time_unit), simulation_(System(settings.model), {}, {}, {.tolerance = settings.tolerance}),
      jets_(simulation_, LaneKind::single), channels_(simulation_.system().function_of(values_of(settings))),
      parameters_(model_.parameter_values()), inputs_(channels_.inputs()), values_(channels_.outputs()),
      work_(channels_.workspace()) {
    now_.mode = model_.initial_mode;
    now_.state = model_.initial_state();
    periods_ = model_.periods();
    drive({});
}

void BenchMotion::drive(const GeneratorOutput& output) {
    std::vector<double> parameters = parameters_;
    const auto set = [&](const DrivenInput& input, double value) {
        parameters[input.parameter.place()] = input.factor * value;
    };
    set(amplitude_, output.fundamental() / 2);
    set(frequency_, output.frequency);
    if (offset_)
        set(*offset_, output.offset);
    if (parameters == parameters_)
        return;
    moment();
    parameters_ = std::move(parameters);
}

/// Returns the present state, and restarts the trajectory from it: later values then depend on that state alone, not on
/// the steps that led to it.
BenchMotion::Moment BenchMotion::moment() {
    trajectory_.reset();
    return now_;
}

void BenchMotion::go_back(const Moment& moment) {
    now_ = moment;
    trajectory_.reset();
}

void BenchMotion::go_on(double spacing, std::size_t count) {
    const double length = static_cast<double>(count) * spacing;
    if (trajectory_) {
        trajectory_->extend(trajectory_->time() + length);
    } else {
        trajectory_.emplace(simulation_, parameters_, borrowed(listener_));
        trajectory_->start(now_.state, now_.mode, 0, length);
        began_ = now_.time;
    }
    run(*trajectory_, jets_);
}

void BenchMotion::advance(double spacing, std::size_t count, const Receiver& receiver) {
    // Limits the work between two calls of the receiver.
    constexpr std::size_t part = 1024;
    while (count > 0 && now_.ended.empty()) {
        const std::size_t now = std::min(count, part);
        const double start = trajectory_ ? trajectory_->time() : 0, step = spacing / time_unit_;
        std::optional<Sampler> sampler;
        if (receiver)
            sampler.emplace(start, step, now, periods_, [&](double, std::size_t, std::span<const double> state) {
                std::copy(state.begin(), state.end(), inputs_.begin());
                std::copy(parameters_.begin(), parameters_.end(),
                          inputs_.begin() + static_cast<std::ptrdiff_t>(state.size()));
                channels_.evaluate(inputs_, values_, work_);
                receiver(values_);
            });
        listener_.to = sampler ? &*sampler : nullptr;
        go_on(step, now);
        listener_.to = nullptr;
        now_.mode = trajectory_->mode();
        now_.state.assign(trajectory_->state().begin(), trajectory_->state().end());
        now_.time = began_ + trajectory_->time() * time_unit_;
        if (const Outcome& outcome = trajectory_->outcome(); outcome.ending != Ending::end_time)
            now_.ended = fmt::format("the model's motion has ended ({}){}", name_of(outcome.ending),
                                     outcome.detail.empty() ? std::string() : ": " + outcome.detail);
        count -= now;
    }
}

} // namespace graze
