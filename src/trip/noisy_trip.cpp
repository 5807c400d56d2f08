#include "graze/trip/noisy_trip.hpp"
#include "base/random_number.hpp"
#include "base/thread_team.hpp"
#include "base/turns.hpp"
#include "graze/base/input_error.hpp"
#include "graze/model/driven_parameter.hpp"
#include "graze/trajectory/ensemble.hpp"
#include "orbit/newton.hpp"
#include "trip/end_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>

namespace graze {

namespace {

/// The Ornstein-Uhlenbeck noise of unit variance, one value per cycle.
class Noise {
public:
    Noise(const NoiseSettings& settings, std::size_t motion)
        : seed_(settings.seed), motion_(motion), correlation_(settings.memory > 0 ? std::exp(-1 / settings.memory) : 0),
          innovation_(std::sqrt(1 - correlation_ * correlation_)), value_(drawn_normal(seed_, motion, 0)) {}
    double value() const { return value_; }
    void step() { value_ = correlation_ * value_ + innovation_ * drawn_normal(seed_, motion_, ++count_); }

private:
    std::uint64_t seed_;
    std::size_t motion_, count_ = 0;
    double correlation_, innovation_, value_;
};

enum class Fate { not_made, rests, trips, fails };
struct Motion {
    Fate fate = Fate::not_made;
    double cycles = 0;                ///< cycles until the trip
    Ending ending = Ending::end_time; ///< how the simulation ended
};

/// Simulates all motions at one level of the noise.
class NoisyMotions {
public:
    NoisyMotions(const TripOrigin& origin, const Simulation& simulation, double level, const TripEnd& end,
                 const NoiseSettings& settings)
        : origin_(origin), simulation_(simulation), level_(level), end_(end), settings_(settings),
          parameters_(origin.parameters), motions_(settings.motions) {
        parameters_.push_back(0); // rate of the parameter, which changes only from cycle to cycle
    }

    std::vector<Motion> make() {
        constexpr std::size_t enough = 16; // number of motions that justifies a thread
        const std::size_t jobs =
            std::clamp<std::size_t>(settings_.motions / enough, 1, static_cast<std::size_t>(settings_.jobs));
        team_.run(jobs, [&](bool calling) { work(calling); });
        return std::move(motions_);
    }
    bool stopped() const { return team_.is_stopped(); }

private:
    /// A lane of the ensemble, in which motions are simulated one after another, cycle by cycle.
    struct Slot {
        Slot(const NoisyMotions& all)
            : watch(all.end_, [&all](const Contact& contact) { return all.origin_.counts(contact); }, {}),
              trajectory(all.simulation_, all.parameters_, borrowed(watch)), noise(all.settings_, 0) {}
        EndWatch watch;
        Trajectory trajectory;
        Noise noise;
        std::size_t motion = 0, cycle = 0;
        bool used = false;
    };

    void work(bool reports_progress) {
        Ensemble ensemble(simulation_);
        std::vector<std::unique_ptr<Slot>> slots;
        std::vector<Trajectory*> places(static_cast<std::size_t>(ensemble.lanes()), nullptr);
        for (std::size_t i = 0; i < places.size(); ++i) {
            slots.push_back(std::make_unique<Slot>(*this));
            if (begin(*slots[i]))
                places[i] = &slots[i]->trajectory;
        }
        ensemble.run(places, [&](std::size_t i) -> Trajectory* {
            Slot& slot = *slots[i];
            if (continues(slot))
                return &slot.trajectory;
            if (reports_progress && progress_)
                progress_(done_);
            return begin(slot) ? &slot.trajectory : nullptr;
        });
    }

    bool is_stopped() {
        if (interrupted_ && interrupted_())
            team_.stop();
        return team_.is_stopped();
    }
    /// Starts the next motion in a slot. @return false if none is left
    bool begin(Slot& slot) {
        if (is_stopped() || (slot.motion = next_++) >= settings_.motions)
            return false;
        slot.cycle = 0;
        slot.noise = Noise(settings_, slot.motion);
        slot.watch.forget();
        std::vector<double> state = origin_.state;
        state.push_back(0);
        start(slot, std::move(state), origin_.mode);
        return true;
    }
    void start(Slot& slot, std::vector<double> state, std::size_t mode) {
        const auto cycle = static_cast<double>(slot.cycle);
        state.back() = level_ * slot.noise.value();
        slot.trajectory.start(state, mode, cycle * origin_.cycle, (cycle + 1) * origin_.cycle);
    }
    /// Starts the next cycle of a motion. @return false when the motion has ended, after recording its outcome
    bool continues(Slot& slot) {
        const Outcome& outcome = slot.trajectory.outcome();
        Motion& motion = motions_[slot.motion];
        const TripTime trip = slot.watch.trip(outcome);
        if (trip.ended) {
            motion = {Fate::trips, trip.time / origin_.cycle, outcome.ending};
        } else if (outcome.ending != Ending::end_time) {
            motion = {Fate::fails, 0, outcome.ending};
        } else if (++slot.cycle == settings_.cycles) {
            motion.fate = Fate::rests;
        } else if (is_stopped()) {
            return false;
        } else {
            slot.noise.step();
            const std::span<const double> state = slot.trajectory.state();
            start(slot, {state.begin(), state.end()}, slot.trajectory.mode());
            return true;
        }
        ++done_;
        return false;
    }

    const TripOrigin& origin_;
    const Simulation& simulation_;
    double level_;
    const TripEnd& end_;
    const NoiseSettings& settings_;
    std::vector<double> parameters_;
    std::vector<Motion> motions_;
    std::atomic<std::size_t> next_{0}, done_{0};
    Turns turns_;
    std::function<bool()> interrupted_ = turns_.asking(settings_.interrupted);
    std::function<void(std::size_t)> progress_ = turns_.taking(settings_.progress);
    ThreadTeam team_;
};

/// Counts the motions whose parameter is beyond the loss point at any time, whether they trip or not; none when
/// interrupted.
std::optional<std::size_t> count_beyond(const TripOrigin& origin, double level, const NoiseSettings& settings) {
    constexpr std::size_t cycles_between_questions = 10'000;
    std::size_t count = 0, done = 0;
    const double margin = origin.point - origin.value;
    for (std::size_t motion = 0; motion < settings.motions; ++motion) {
        Noise noise(settings, motion);
        bool beyond = false;
        for (std::size_t cycle = 0; cycle < settings.cycles && !beyond; ++cycle, noise.step()) {
            beyond = level * noise.value() * std::copysign(1.0, margin) > std::abs(margin);
            if (++done % cycles_between_questions == 0 && settings.interrupted && settings.interrupted())
                return std::nullopt;
        }
        count += beyond ? 1 : 0;
    }
    return count;
}

} // namespace

void NoiseSettings::validate() const {
    constexpr std::size_t most = 100'000'000;
    if (!(memory >= 0 && memory <= 1e9))
        throw InputError(fmt::format("the memory of {} cycles is out of range", memory), "give 0 to 1e9");
    if (motions == 0 || motions > most)
        throw InputError(fmt::format("{} motions are out of range", motions), fmt::format("choose from 1 to {}", most));
    if (cycles == 0 || cycles > most)
        throw InputError(fmt::format("{} cycles are out of range", cycles), fmt::format("choose from 1 to {}", most));
    if (jobs < 1)
        throw InputError(fmt::format("{} jobs cannot do anything", jobs), "give at least one");
    require_tolerance_in_range(tolerance);
    wilson_interval(0, 1, confidence); // refuses an invalid confidence
}

NoisyTrips noisy_trips(const System& system, const TripOrigin& origin, double level, const TripEnd& end,
                       const NoiseSettings& settings) {
    settings.validate();
    if (!(level >= 0 && std::isfinite(level)))
        throw InputError(fmt::format("the level of noise {} is out of range", level), "give a standard deviation");
    const std::string name = system.model().independent_parameters().at(origin.parameter.place());
    const DrivenParameter driven = drive_parameter(system.model(), name, DriveKind::shift);
    TripEnd here = end;
    if (end.quantity)
        here.quantity = driven.of(*end.quantity);
    TripOptions options;
    options.tolerance = settings.tolerance;
    const Simulation simulation = simulation_until(System(driven.model), here, options);
    NoisyMotions work(origin, simulation, level, here, settings);
    const std::vector<Motion> motions = work.make();
    NoisyTrips result;
    result.interrupted = work.stopped();
    std::vector<double> cycles;
    std::map<std::string, std::size_t> failures;
    for (const Motion& one : motions) {
        result.motions += one.fate != Fate::not_made ? 1 : 0;
        result.failed += one.fate == Fate::fails ? 1 : 0;
        if (one.fate == Fate::fails)
            ++failures[std::string(name_of(one.ending))];
        if (one.fate == Fate::trips)
            cycles.push_back(one.cycles);
    }
    result.failures.assign(failures.begin(), failures.end());
    result.trips = cycles.size();
    if (!result.interrupted) {
        const std::optional<std::size_t> beyond = count_beyond(origin, level, settings);
        result.beyond = beyond.value_or(0);
        result.interrupted = !beyond;
    }
    const std::size_t decided = result.motions - result.failed;
    if (decided > 0)
        result.probability = wilson_interval(result.trips, decided, settings.confidence);
    else
        result.probability = {0, 0, 1}; // nothing is known
    const std::size_t half = (decided + 1) / 2;
    if (half > 0 && cycles.size() >= half) {
        std::nth_element(cycles.begin(), cycles.begin() + static_cast<std::ptrdiff_t>(half - 1), cycles.end());
        result.half = cycles[half - 1];
    }
    return result;
}

std::vector<NoisyTrips> noisy_trips(const LossPoint& point, const TripOrigin& origin, const std::vector<double>& levels,
                                    const TripEnd& end, const NoiseSettings& settings,
                                    const std::function<void(std::size_t level, std::size_t motions)>& progress) {
    std::vector<NoisyTrips> all;
    NoiseSettings here = settings;
    if (progress)
        here.progress = [&](std::size_t motions) { progress(all.size(), motions); };
    for (const double level : levels) {
        NoisyTrips trips = noisy_trips(point.system, origin, level, end, here);
        if (trips.interrupted)
            break;
        all.push_back(std::move(trips));
    }
    return all;
}

} // namespace graze
