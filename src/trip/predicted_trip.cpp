#include "graze/trip/predicted_trip.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/rounded.hpp"
#include "grazing/return_map.hpp"
#include "trip/trip_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

void require_trip(const CycleMap& map, double overshoot, std::span<const double> disturbance) {
    if (!map.exists())
        throw InputError("there is no map of the contact: " + (map.reason.empty() ? map.contact.reason : map.reason),
                         "choose another touch");
    if (!map.clearance_rate || *map.clearance_rate == 0 || map.steady.size() != map.active.size())
        throw InputError("no parameter is known that moves the orbit from its touch",
                         "compute the map with a parameter");
    if (!std::isfinite(overshoot))
        throw InputError("the overshoot is not finite", "give the distance of the parameter from the touch");
    if (!disturbance.empty() && disturbance.size() != map.contact.touch.state.size())
        throw InputError(fmt::format("the disturbance has {} numbers for {} states", disturbance.size(),
                                     map.contact.touch.state.size()),
                         "give one for each");
    if (std::ranges::any_of(disturbance, [](double one) { return !std::isfinite(one); }))
        throw InputError("a disturbance is not finite", "give a number for each state");
    if (overshoot * std::copysign(1.0, *map.clearance_rate) > 0)
        throw InputError(
            fmt::format("with the parameter {:+g} from the touch there is no contact, and no trip", overshoot),
            *map.clearance_rate < 0 ? "contacts begin above: give a positive overshoot"
                                    : "contacts begin below: give a negative overshoot");
    if (overshoot == 0 && disturbance.empty())
        throw InputError("without overshoot and disturbance nothing happens", "give one of them");
}

double explicit_rate(const CycleMap& map) {
    double rate = *map.clearance_rate, size = std::abs(rate);
    for (std::size_t i = 0; i < map.active.size(); ++i) {
        rate -= map.gradient[i] * map.steady[i];
        size += std::abs(map.gradient[i] * map.steady[i]);
    }
    constexpr double roundoff = 1e-9;
    return std::abs(rate) > roundoff * size ? rate : 0;
}

namespace {

/// Iterates the map from pass to pass. Before the first contact the state is in units of the overshoot, to which it is
/// proportional, so that nothing underflows.
class Passes {
public:
    Passes(const CycleMap& map, double overshoot, std::span<const double> disturbance)
        : slides_(map.contact.order == MapOrder::linear), acceleration_(map.contact.acceleration),
          overshoot_(overshoot), unit_(disturbance.empty() ? std::abs(overshoot) : 1) {
        const Eigen::Index n = index(map.active.size());
        matrix_ = matrix_of(map);
        impact_ = vector_of(map.impact);
        gradient_ = vector_of(map.gradient);
        rate_ = *map.clearance_rate;
        clearance_ = rate_ * (overshoot / unit_);
        state_ = vector_of(map.steady) * (-overshoot / unit_);
        for (Eigen::Index i = 0; i < n && !disturbance.empty(); ++i)
            state_[i] += disturbance[map.active[static_cast<std::size_t>(i)]];
        begin(map, disturbance);
    }

    double speed() const { return speed_; } ///< approach speed of the contact at this pass; 0 without one
    double cycle() const { return cycle_; }
    std::vector<double> state() const { return numbers_of(state_ * unit_); }
    std::vector<double> state_before() const { return numbers_of(before_); } ///< state at the previous pass
    double speed_before() const { return speed_before_; }
    /// Advances to the next pass.
    void step() {
        before_ = state_ * unit_;
        speed_before_ = speed_;
        if (speed_ > 0) {
            // A sliding motion is shifted in proportion to the depth.
            const double gained = slides_ ? speed_ * speed_ / (2 * acceleration_) : speed_;
            state_ = (state_ * unit_ + impact_ * gained).eval();
            unit_ = 1;
            clearance_ = rate_ * overshoot_;
        }
        state_ = (matrix_ * state_).eval();
        ++cycle_;
        ++steps_;
        set_speed(clearance_ + gradient_.dot(state_));
    }
    /// Advances to the next contact. @return false if there is none
    bool find_contact() {
        constexpr int one_by_one = 100'000;
        step();
        for (int k = 1; k < one_by_one && speed_ == 0; ++k)
            step();
        return speed_ > 0 || skip_free_passes();
    }
    std::size_t steps() const { return steps_; }

private:
    void set_speed(double gap) { speed_ = gap < 0 ? std::sqrt(-2 * acceleration_ * gap) * std::sqrt(unit_) : 0; }

    /// Sets the contact at the start, which is at the touch itself: only an explicit shift of the surface, or a
    /// disturbance towards it, makes a contact there.
    void begin(const CycleMap& map, std::span<const double> disturbance) {
        if (disturbance.empty()) {
            set_speed(explicit_rate(map) * (overshoot_ / unit_));
            return;
        }
        speed_ = meeting_of(map, overshoot_, disturbance).speed;
    }

    /// Skips all passes without contact by repeated squaring of the map.
    bool skip_free_passes() {
        constexpr int most = 60;
        std::vector<Eigen::MatrixXd> powers{matrix_};
        const auto gap_after = [&](const Eigen::MatrixXd& power) { return clearance_ + gradient_.dot(power * state_); };
        while (gap_after(powers.back()) >= 0) {
            if (static_cast<int>(powers.size()) > most)
                return false;
            powers.emplace_back(powers.back() * powers.back());
        }
        double passes = 1;
        for (std::size_t i = 1; i < powers.size(); ++i)
            passes *= 2;
        for (std::size_t i = powers.size(); i-- > 0; passes /= 2)
            if (gap_after(powers[i]) >= 0) {
                state_ = (powers[i] * state_).eval();
                cycle_ += passes;
            }
        step();
        return speed_ > 0;
    }

    bool slides_;
    double acceleration_, overshoot_, unit_, rate_ = 0, clearance_ = 0, speed_ = 0, speed_before_ = 0, cycle_ = 0;
    Eigen::MatrixXd matrix_;
    Eigen::VectorXd impact_, gradient_, state_, before_;
    std::size_t steps_ = 0;
};

/// Stores the state from which a simulation may continue. For half orbits only every second pass has the model's own
/// states; otherwise the previous pass is used, if it has no contact. @return false where that is impossible
bool hand_over(PredictedTrip& trip, const Passes& passes, bool half) {
    const bool image = half && std::fmod(passes.cycle(), 2) != 0;
    if (image && (passes.speed_before() > 0 || passes.cycle() < 1))
        return false;
    trip.handed = image ? passes.state_before() : passes.state();
    trip.handed_cycles = passes.cycle() - (image ? 1 : 0);
    trip.handed_contacts = trip.contacts;
    return true;
}

} // namespace

std::vector<double> usual_overshoots(double value, int side) {
    const int size = value != 0 ? static_cast<int>(std::floor(std::log10(std::abs(value)))) : 0;
    constexpr int least = 20;
    std::vector<double> result;
    for (int digits = 2; digits <= least; digits += 2)
        if (const double overshoot = rounded(std::pow(10.0, size - digits), 1);
            overshoot > 0) // skip values that underflow
            result.push_back(side < 0 ? -overshoot : overshoot);
    return result;
}

TouchMeeting meeting_of(const CycleMap& map, double overshoot, std::span<const double> disturbance) {
    TouchMeeting meeting;
    meeting.gap = explicit_rate(map) * overshoot;
    for (std::size_t i = 0; i < disturbance.size(); ++i) {
        meeting.gap += map.contact.gradient[i] * disturbance[i];
        meeting.rate += map.contact.rate_gradient[i] * disturbance[i];
    }
    const double square = meeting.rate * meeting.rate - 2 * map.contact.acceleration * meeting.gap;
    if ((meeting.gap < 0 || meeting.rate < 0) && square > 0)
        meeting.speed = std::sqrt(square);
    return meeting;
}

/// Share of the reach of the growth up to which the map is trusted.
constexpr double trusted_share = 0.1;

double level_of_map(const CycleMap& map, const Verdict& verdict) {
    const bool slides = map.contact.order == MapOrder::linear;
    if (verdict.outcome != GrazingOutcome::lost || (!verdict.reach && !slides))
        throw InputError(fmt::format("the verdict is {}{}: there is no trip", name_of(verdict.outcome),
                                     verdict.reason.empty() ? "" : " (" + verdict.reason + ")"),
                         "choose a grazing at which the motion is lost");
    double size = 0;
    const TouchState& touch = map.contact.touch;
    for (std::size_t i = 0; i < touch.state.size(); ++i)
        size += std::abs(map.contact.gradient[i]) * touch.scales[i];
    const double fastest = std::sqrt(2 * map.contact.acceleration * size);
    return trusted_share * (slides ? fastest : std::min(*verdict.reach, fastest));
}

PredictedTrip predicted_trip(const CycleMap& map, const Verdict& verdict, double overshoot,
                             const PredictionOptions& options) {
    const double trusted = level_of_map(map, verdict);
    require_trip(map, overshoot, options.disturbance);
    if (!(options.level >= 0 && std::isfinite(options.level)))
        throw InputError(fmt::format("the approach speed {} cannot be reached", options.level), "give a positive one");
    PredictedTrip trip;
    trip.level = options.level > 0 ? options.level : trusted;
    constexpr std::size_t most_steps = 20'000'000;
    Passes passes(map, overshoot, options.disturbance);
    trip.handed = passes.state();
    bool handed = false, found = passes.speed() > 0 || passes.find_contact();
    while (found) {
        trip.speed = passes.speed();
        trip.cycles = passes.cycle();
        trip.ended = trip.speed >= trip.level;
        if (trip.contacts == 0) {
            trip.first_speed = trip.speed;
            trip.first_cycles = trip.cycles;
        }
        const bool last = trip.ended || trip.contacts + 1 >= options.contacts || passes.steps() > most_steps;
        // Hand over at a contact that a simulation resolves but that is soft enough for the map, whose relative error
        // is about speed over reach.
        constexpr double soft = 1e-4;
        if (!handed && (last || trip.speed > soft * trusted))
            handed = (trip.contacts == 0 && trip.speed > soft * trusted) || hand_over(trip, passes, map.half);
        ++trip.contacts;
        if (last)
            break;
        found = passes.find_contact();
    }
    // So far beyond the touch the map is not valid.
    const bool too_far = trip.first_speed > trusted / trusted_share;
    trip.ended = trip.ended && !too_far;
    trip.ending = trip.ended ? "speed" : (too_far ? "too-far" : "none");
    // A contact precedes the pass by its speed over the acceleration.
    trip.time = trip.cycles * map.time - trip.speed / map.contact.acceleration;
    return trip;
}

} // namespace graze
