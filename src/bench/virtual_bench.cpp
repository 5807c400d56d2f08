#include "graze/bench/virtual_bench.hpp"

#include "base/random_number.hpp"
#include "bench/anti_alias.hpp"
#include "graze/trajectory/jet_set.hpp"
#include "graze/trajectory/recorder.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace graze {

namespace {

constexpr double usual_rate = 1000, least_rate = 1e-3, most_rate = 1e7;
constexpr std::size_t kept_marks = 4;
constexpr std::size_t least_oversampling = 8;
constexpr double samples_of_corner = 16; ///< the filter needs samples of all frequencies that it must remove

/// The reading of a converter for a value.
double converted(double value, double range, int bits) {
    if (range == 0)
        return value;
    const double step = std::ldexp(range, 1 - bits), most = std::ldexp(1.0, bits - 1) - 1;
    return step * std::clamp(std::nearbyint(value / step), -most - 1, most);
}

std::vector<Expression> values_of(const BenchSettings& settings) {
    std::vector<Expression> values;
    for (const BenchChannel& channel : settings.channels)
        values.push_back(channel.value.value);
    return values;
}

/// The motion of a model that is driven by a generator.
class BenchMotion {
public:
    /// State of the motion at a time.
    struct Moment {
        double time = 0; ///< seconds
        std::size_t mode = 0;
        std::vector<double> state{};
        std::string ended{};
    };

    explicit BenchMotion(const BenchSettings& settings)
        : model_(settings.model), amplitude_(settings.amplitude), frequency_(settings.frequency),
          offset_(settings.offset), time_unit_(settings.time_unit),
          simulation_(System(settings.model), {}, {}, {.tolerance = settings.tolerance}),
          jets_(simulation_, LaneKind::single), channels_(simulation_.system().function_of(values_of(settings))),
          parameters_(model_.parameter_values()), inputs_(channels_.inputs()), values_(channels_.outputs()),
          work_(channels_.workspace()) {
        now_.mode = model_.initial_mode;
        now_.state = model_.initial_state();
        periods_ = model_.periods();
        drive({});
    }

    /// Sets the generator from now on.
    void drive(const GeneratorOutput& output) {
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
    double time() const { return now_.time; }
    const std::string& ended() const { return now_.ended; }
    /// Returns the present state, and restarts the trajectory from it: later values then depend on that state alone,
    /// not on the steps that led to it.
    Moment moment() {
        trajectory_.reset();
        return now_;
    }
    void go_back(const Moment& moment) {
        now_ = moment;
        trajectory_.reset();
    }

    /// Receives the values of the channels. @param values valid during the call
    using Receiver = std::function<void(std::span<const double> values)>;
    /// Passes on values now, `spacing` seconds later, and so on, and advances time by count spacings.
    void advance(double spacing, std::size_t count, const Receiver& receiver) {
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

private:
    /// Forwards steps to the current observer.
    class Listener : public Observer {
    public:
        Observer* to = nullptr;
        void step(const Step& step) override {
            if (to != nullptr)
                to->step(step);
        }
    };
    void go_on(double spacing, std::size_t count) {
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

    Model model_;
    DrivenInput amplitude_, frequency_;
    std::optional<DrivenInput> offset_;
    double time_unit_;
    Simulation simulation_;
    JetSet jets_;
    Function channels_;
    std::vector<double> parameters_, periods_, inputs_, values_, work_;
    Listener listener_;
    Moment now_;
    std::optional<Trajectory> trajectory_; ///< empty: a new one starts from now_
    double began_ = 0;                     ///< start of the trajectory's time
};

} // namespace

struct VirtualBench::State {
    /// State that changes with time.
    struct Moment {
        std::uint64_t number = 0;
        BenchMotion::Moment motion{};
        std::vector<AntiAlias> filters{};
        std::size_t taken = 0; ///< number of samples taken
        bool settled = false;  ///< whether the filters have been initialised
    };

    BenchSettings settings;
    BenchMotion motion;
    RecordHeader header{};
    double rate = usual_rate;
    Moment now{};
    std::deque<Moment> marks{};
    std::string ended{};

    std::size_t oversampling() const {
        if (settings.anti_alias == 0)
            return 1;
        return std::max(least_oversampling,
                        static_cast<std::size_t>(std::ceil(samples_of_corner * settings.anti_alias / rate)));
    }
    void renew_filters() {
        now.settled = false;
        now.filters.clear();
        if (settings.anti_alias > 0)
            now.filters.assign(settings.channels.size(),
                               AntiAlias(settings.anti_alias / (rate * static_cast<double>(oversampling()))));
    }
    double measured(std::size_t c, double value, double time) const {
        const BenchChannel& channel = settings.channels[c];
        value += channel.offset + channel.drift * time;
        if (channel.noise > 0)
            value += channel.noise * drawn_normal(settings.seed, c, now.taken);
        return converted(value, channel.range, settings.bits);
    }
};

VirtualBench::VirtualBench(const BenchSettings& settings) {
    settings.validate();
    state_ = std::make_unique<State>(State{settings, BenchMotion(settings)});
    state_->header.time = {"t", "s"};
    for (const BenchChannel& channel : settings.channels)
        state_->header.channels.push_back({channel.value.name, channel.value.unit});
    set_rate(std::max(usual_rate, 4 * settings.anti_alias));
}

VirtualBench::~VirtualBench() = default;

void VirtualBench::drive(const GeneratorOutput& output) {
    state_->motion.drive(output);
}

const RecordHeader& VirtualBench::header() const {
    return state_->header;
}

double VirtualBench::rate() const {
    return state_->rate;
}

void VirtualBench::set_rate(double rate) {
    if (!(rate >= least_rate && rate <= most_rate) || !(rate > 2 * state_->settings.anti_alias))
        throw InputError(
            fmt::format("{} samples per second are not possible", rate),
            fmt::format("give from {} to {}, and more than twice the corner of the filter", least_rate, most_rate));
    if (rate == state_->rate && state_->now.taken > 0)
        return; // filters keep their state
    state_->rate = rate;
    state_->renew_filters();
}

double VirtualBench::time() const {
    return state_->motion.time();
}

const std::string& VirtualBench::ended() const {
    return state_->ended.empty() ? state_->motion.ended() : state_->ended;
}

void VirtualBench::sample(std::size_t count, Samples& samples) {
    State& state = *state_;
    samples.clear(state.header.channels.size());
    const std::size_t parts = state.oversampling();
    const double begin = time(), spacing = 1 / state.rate;
    std::size_t part = 0;
    const auto take = [&](std::span<const double> values) {
        const bool wanted = part++ % parts == 0;
        const double at = begin + static_cast<double>(samples.rows()) * spacing;
        for (std::size_t c = 0; c < values.size() && state.ended.empty(); ++c) {
            double value = values[c];
            if (!std::isfinite(value)) {
                state.ended = fmt::format("channel '{}' has no finite value", state.header.channels[c].name);
                break;
            }
            if (!state.now.filters.empty()) {
                if (!state.now.settled)
                    state.now.filters[c].settle(value);
                value = state.now.filters[c].filtered(value);
            }
            if (wanted)
                samples.values[c].push_back(state.measured(c, value, at));
        }
        if (!state.ended.empty())
            return;
        state.now.settled = true;
        if (wanted) {
            samples.times.push_back(at);
            ++state.now.taken;
        }
    };
    if (!ended().empty())
        return;
    state.motion.advance(spacing / static_cast<double>(parts), count * parts, take);
    for (std::vector<double>& column : samples.values)
        column.resize(samples.rows());
}

void VirtualBench::pass(double seconds) {
    if (!(seconds > 0) || !ended().empty())
        return;
    state_->motion.advance(seconds, 1, nullptr);
    state_->now.settled = false;
}

void VirtualBench::mark(std::uint64_t number) {
    State& state = *state_;
    std::erase_if(state.marks, [&](const State::Moment& moment) { return moment.number == number; });
    if (state.marks.size() == kept_marks)
        state.marks.pop_front();
    state.now.number = number;
    state.now.motion = state.motion.moment();
    state.marks.push_back(state.now);
}

bool VirtualBench::return_to(std::uint64_t number) {
    State& state = *state_;
    const auto found = std::find_if(state.marks.begin(), state.marks.end(),
                                    [&](const State::Moment& moment) { return moment.number == number; });
    if (found == state.marks.end())
        return false;
    state.now = *found;
    state.motion.go_back(state.now.motion);
    state.ended.clear();
    return true;
}

} // namespace graze
