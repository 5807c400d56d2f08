#include "heyoka_peer.hpp"

// Headers of heyoka need it, and Boost 1.74 leaves it out.
#include <boost/serialization/library_version_type.hpp>

#include <heyoka/heyoka.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace peers {

namespace {

namespace kw = heyoka::kw;
using heyoka::expression;
using Equations = std::vector<std::pair<expression, expression>>;

constexpr std::size_t count_of_states = 3;

/// The equations of motion, with the parameters that derivatives or batches need as parameters of heyoka.
struct Motion {
    expression x = expression{"x"}, v = expression{"v"}, i = expression{"i"}, sine = expression{"s"},
               cosine = expression{"c"};
    std::array<expression, 4> parameters = {heyoka::par[0], heyoka::par[1], heyoka::par[2], heyoka::par[3]};
    std::array<expression, count_of_states> rates;

    explicit Motion(const OdeintPeer::Parameters& groups) {
        const auto& [voltage, damping, resistance, inductance] = parameters;
        const expression r = 1. / (1 + groups.gap - x);
        const expression field = i * r;
        rates = {v, heyoka::pow(field, 2.) - x - 2. * damping * v,
                 (voltage * sine - resistance * i - v * r * field) / (inductance + r)};
    }

    /// Rates of the derivatives in one direction, as in HeyokaPeer.
    std::array<expression, count_of_states>
    derivative_rates(std::size_t direction, const std::array<expression, count_of_states>& column) const {
        constexpr std::size_t phase = count_of_states;
        std::array<expression, count_of_states> result;
        for (std::size_t k = 0; k < count_of_states; ++k) {
            result[k] = heyoka::diff(rates[k], x) * column[0] + heyoka::diff(rates[k], v) * column[1] +
                        heyoka::diff(rates[k], i) * column[2];
            if (direction == phase)
                result[k] = result[k] + heyoka::diff(rates[k], sine) * cosine;
            else if (direction > phase)
                result[k] = result[k] + heyoka::diff(rates[k], parameters[direction - phase - 1]);
        }
        return result;
    }

    /// Makes the phase a function of time or appends its states, and replaces parameters by numbers.
    Equations finish(Equations equations, const OdeintPeer::Parameters& groups, bool rotates, bool free_voltage) const {
        std::map<expression, expression> known = {{parameters[1], expression{groups.damping}},
                                                  {parameters[2], expression{groups.resistance}},
                                                  {parameters[3], expression{groups.inductance}}};
        if (!free_voltage)
            known.emplace(parameters[0], expression{groups.voltage});
        if (!rotates) {
            known.emplace(sine, heyoka::sin(groups.frequency * heyoka::time));
            known.emplace(cosine, heyoka::cos(groups.frequency * heyoka::time));
        }
        for (auto& [state, rate] : equations)
            rate = heyoka::subs(rate, known);
        if (rotates) {
            equations.push_back(heyoka::prime(sine) = groups.frequency * cosine);
            equations.push_back(heyoka::prime(cosine) = -groups.frequency * sine);
        }
        return equations;
    }

    expression phase_event(const OdeintPeer::Parameters& groups, bool rotates) const {
        return rotates ? sine : heyoka::sin(groups.frequency * heyoka::time);
    }
};

} // namespace

std::string HeyokaChoice::name() const {
    return std::string(rotating_phase ? "phase as states" : "phase by time") + (slp_vectorize ? ", SLP" : "");
}

class HeyokaPeer::Integrator {
public:
    Integrator(const OdeintPeer::Parameters& groups, double tolerance, HeyokaOutput output, HeyokaChoice choice,
               std::size_t directions)
        : groups_(groups), rotates_(choice.rotating_phase), output_(output), directions_(directions),
          system_(make(tolerance, choice)) {}
    Integrator(const Integrator&) = delete;
    Integrator& operator=(const Integrator&) = delete;

    void run(const State& start, double phase, double duration) {
        impacts = 0;
        passages.clear();
        double* x = system_.get_state_data();
        std::copy(start.begin(), start.end(), x);
        for (std::size_t d = 0; d < directions_; ++d)
            for (std::size_t k = 0; k < count_of_states; ++k)
                x[count_of_states * (d + 1) + k] = k == d ? 1 : 0;
        if (rotates_) {
            x[count_of_states * (directions_ + 1)] = std::sin(phase);
            x[count_of_states * (directions_ + 1) + 1] = std::cos(phase);
        }
        const double begin = phase / groups_.frequency;
        system_.set_time(begin);
        system_.reset_cooldowns();
        const auto [outcome, count] =
            output_ == HeyokaOutput::grid ? run_grid(begin, begin + duration) : run_until(begin + duration);
        steps = count;
        if (outcome != heyoka::taylor_outcome::time_limit)
            throw std::runtime_error("heyoka does not reach the end");
    }

    double value(std::size_t index) const { return system_.get_state()[index]; }

    std::size_t impacts = 0, steps = 0;
    std::vector<State> passages;

private:
    using System = heyoka::taylor_adaptive<double>;

    System make(double tolerance, HeyokaChoice choice) {
        const Motion motion(groups_);
        Equations equations = {heyoka::prime(motion.x) = motion.rates[0], heyoka::prime(motion.v) = motion.rates[1],
                               heyoka::prime(motion.i) = motion.rates[2]};
        for (std::size_t d = 0; d < directions_; ++d) {
            std::array<expression, count_of_states> column;
            for (std::size_t k = 0; k < count_of_states; ++k)
                column[k] = expression{"d" + std::to_string(d) + std::to_string(k)};
            const std::array<expression, count_of_states> rates = motion.derivative_rates(d, column);
            for (std::size_t k = 0; k < count_of_states; ++k)
                equations.push_back(heyoka::prime(column[k]) = rates[k]);
        }
        equations = motion.finish(equations, groups_, rotates_, false);
        std::vector<heyoka::nt_event<double>> watched;
        const auto keep = [this](System& system, double time, int) {
            const std::vector<double>& all = system.update_d_output(time);
            passages.push_back({all[0], all[1], all[2]});
        };
        if (output_ == HeyokaOutput::sections || output_ == HeyokaOutput::extrema)
            watched.emplace_back(motion.phase_event(groups_, rotates_), keep);
        if (output_ == HeyokaOutput::extrema)
            watched.emplace_back(motion.v, keep, kw::direction = heyoka::event_direction::negative);
        const heyoka::t_event<double> stop(
            groups_.stop - motion.x, kw::direction = heyoka::event_direction::negative,
            kw::callback = [this](System& system, int) {
                meet_stop(system.get_state_data());
                return true;
            });
        return System(equations, std::vector<double>(equations.size()), kw::tol = tolerance,
                      kw::t_events = std::vector{stop}, kw::nt_events = watched, kw::opt_level = 3u,
                      kw::fast_math = true, kw::slp_vectorize = choice.slp_vectorize);
    }

    /// Newton's law, and for derivatives the changed time of the impact.
    void meet_stop(double* x) {
        ++impacts;
        x[0] = groups_.stop;
        const double before = x[1], after = -groups_.restitution * before;
        x[1] = after;
        if (directions_ == 0)
            return;
        const double r = 1 / (1 + groups_.gap - x[0]), force = x[2] * x[2] * r * r - x[0];
        const double acceleration = force - 2 * groups_.damping * before,
                     acceleration_after = force - 2 * groups_.damping * after;
        const double change_of_current_rate = -(before - after) * r * r * x[2] / (groups_.inductance + r);
        for (std::size_t d = 0; d < directions_; ++d) {
            double* column = x + count_of_states * (d + 1);
            const double later = -column[0] / before;
            column[0] *= -groups_.restitution;
            column[1] = -groups_.restitution * (column[1] + acceleration * later) - acceleration_after * later;
            column[2] += change_of_current_rate * later;
        }
    }

    using Ending = std::pair<heyoka::taylor_outcome, std::size_t>; ///< with the number of steps

    Ending run_until(double end) {
        const auto result = system_.propagate_until(end);
        return {std::get<0>(result), std::get<3>(result)};
    }

    Ending run_grid(double begin, double end) {
        const double half_turn = std::numbers::pi / groups_.frequency;
        std::vector<double> times = {begin};
        for (double count = std::ceil(begin / half_turn); count * half_turn < end; ++count)
            times.push_back(count * half_turn);
        times.push_back(end);
        const auto result = system_.propagate_grid(std::move(times));
        const std::vector<double>& all = std::get<5>(result);
        const std::size_t size = system_.get_dim(), count = all.size() / size;
        for (std::size_t p = 1; p + 1 < count; ++p)
            passages.push_back({all[p * size], all[p * size + 1], all[p * size + 2]});
        return {std::get<0>(result), std::get<3>(result)};
    }

    OdeintPeer::Parameters groups_;
    bool rotates_;
    HeyokaOutput output_;
    std::size_t directions_;
    System system_;
};

HeyokaPeer::HeyokaPeer(const OdeintPeer::Parameters& groups, double tolerance, HeyokaOutput output, HeyokaChoice choice,
                       std::size_t directions)
    : integrator_(std::make_unique<Integrator>(groups, tolerance, output, choice, directions)) {}
HeyokaPeer::~HeyokaPeer() = default;
HeyokaPeer::HeyokaPeer(HeyokaPeer&&) noexcept = default;

void HeyokaPeer::run(const State& start, double phase, double duration) {
    integrator_->run(start, phase, duration);
}
HeyokaPeer::State HeyokaPeer::state() const {
    return {integrator_->value(0), integrator_->value(1), integrator_->value(2)};
}
double HeyokaPeer::derivative(std::size_t state, std::size_t direction) const {
    return integrator_->value(count_of_states * (direction + 1) + state);
}
std::size_t HeyokaPeer::impacts() const {
    return integrator_->impacts;
}
std::size_t HeyokaPeer::steps() const {
    return integrator_->steps;
}
const std::vector<HeyokaPeer::State>& HeyokaPeer::passages() const {
    return integrator_->passages;
}

class HeyokaEnsemble::Integrator {
public:
    Integrator(const OdeintPeer::Parameters& groups, double tolerance, HeyokaChoice choice)
        : groups_(groups), rotates_(choice.rotating_phase), system_(make(tolerance)) {}
    Integrator(const Integrator&) = delete;
    Integrator& operator=(const Integrator&) = delete;

    void run(const State& start, double phase, std::span<const double> voltages, double duration) {
        impacts = 0;
        ends.resize(voltages.size());
        const double begin = phase / groups_.frequency;
        for (std::size_t first = 0; first < voltages.size(); first += batch) {
            double* x = system_.get_state_data();
            for (std::size_t lane = 0; lane < batch; ++lane) {
                for (std::size_t k = 0; k < count_of_states; ++k)
                    x[k * batch + lane] = start[k];
                if (rotates_) {
                    x[count_of_states * batch + lane] = std::sin(phase);
                    x[(count_of_states + 1) * batch + lane] = std::cos(phase);
                }
                system_.get_pars_data()[lane] = voltages[first + lane];
            }
            system_.set_time(begin);
            system_.reset_cooldowns();
            system_.propagate_until(begin + duration);
            for (const auto& result : system_.get_propagate_res())
                if (std::get<0>(result) != heyoka::taylor_outcome::time_limit)
                    throw std::runtime_error("heyoka does not reach the end");
            for (std::size_t lane = 0; lane < batch; ++lane)
                ends[first + lane] = {x[lane], x[batch + lane], x[2 * batch + lane]};
        }
    }

    std::vector<State> ends;
    std::size_t impacts = 0;

private:
    using System = heyoka::taylor_adaptive_batch<double>;

    System make(double tolerance) {
        const Motion motion(groups_);
        const Equations equations =
            motion.finish({heyoka::prime(motion.x) = motion.rates[0], heyoka::prime(motion.v) = motion.rates[1],
                           heyoka::prime(motion.i) = motion.rates[2]},
                          groups_, rotates_, true);
        const heyoka::t_event_batch<double> stop(
            groups_.stop - motion.x, kw::direction = heyoka::event_direction::negative,
            kw::callback = [this](System& system, int, std::uint32_t lane) {
                double* x = system.get_state_data();
                ++impacts;
                x[lane] = groups_.stop;
                x[batch + lane] *= -groups_.restitution;
                return true;
            });
        return System(equations, std::vector<double>(batch * equations.size()), static_cast<std::uint32_t>(batch),
                      kw::tol = tolerance, kw::t_events = std::vector{stop}, kw::opt_level = 3u, kw::fast_math = true,
                      kw::force_avx512 = true);
    }

    OdeintPeer::Parameters groups_;
    bool rotates_;
    System system_;
};

HeyokaEnsemble::HeyokaEnsemble(const OdeintPeer::Parameters& groups, double tolerance, HeyokaChoice choice)
    : integrator_(std::make_unique<Integrator>(groups, tolerance, choice)) {}
HeyokaEnsemble::~HeyokaEnsemble() = default;
HeyokaEnsemble::HeyokaEnsemble(HeyokaEnsemble&&) noexcept = default;

void HeyokaEnsemble::run(const State& start, double phase, std::span<const double> voltages, double duration) {
    integrator_->run(start, phase, voltages, duration);
}
const std::vector<HeyokaEnsemble::State>& HeyokaEnsemble::states() const {
    return integrator_->ends;
}
std::size_t HeyokaEnsemble::impacts() const {
    return integrator_->impacts;
}

} // namespace peers
