#pragma once

#include <array>
#include <cstddef>

#include <boost/numeric/odeint/algebra/array_algebra.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include <cmath>
#include <numbers>

/// A careful implementation of the electromagnetic vibro-impactor with Boost.odeint: nondimensional equations by hand,
/// dopri5 with dense output, event detection at the ends of steps, bisection on the dense output, restart after each
/// jump.
class OdeintPeer {
public:
    using State = std::array<double, 3>; ///< displacement, velocity, current; the phase is `frequency` times time

    struct Parameters {
        double voltage, frequency, damping, restitution, gap, stop, inductance, resistance;
    };

    OdeintPeer(const Parameters& parameters, double tolerance)
        : parameters_(parameters), stepper_(boost::numeric::odeint::make_dense_output(tolerance, tolerance, Method{})) {
    }

    void start(const State& state) {
        state_ = state;
        time_ = 0;
        impacts_ = 0;
        step_ = 1e-3;
    }

    /// Integrates whole periods, from phase 0 to phase 0.
    void run(int periods) {
        const double length = 2 * std::numbers::pi / parameters_.frequency;
        // Time is counted from the start of each run, so that its round-off does not grow.
        time_ = 0;
        run_until(periods * length);
    }

    const State& state() const { return state_; }
    std::size_t impacts() const { return impacts_; }
    std::size_t steps() const { return steps_; }

private:
    using Method =
        boost::numeric::odeint::runge_kutta_dopri5<State, double, State, double, boost::numeric::odeint::array_algebra>;
    using Stepper = decltype(boost::numeric::odeint::make_dense_output(1.0, 1.0, Method{}));

    static constexpr double time_resolution = 1e-14;

    void run_until(double end) {
        const auto rates = [p = parameters_](const State& x, State& rate, double t) {
            const double reciprocal = 1 / (1 + p.gap - x[0]);
            const double squared = reciprocal * reciprocal;
            rate[0] = x[1];
            rate[1] = x[2] * x[2] * squared - x[0] - 2 * p.damping * x[1];
            rate[2] = (p.voltage * std::sin(p.frequency * t) - (p.resistance + x[1] * squared) * x[2]) /
                      (p.inductance + reciprocal);
        };
        while (time_ < end) {
            stepper_.initialize(state_, time_, step_);
            bool impact = false;
            while (!impact) {
                stepper_.do_step(rates);
                ++steps_;
                const bool ends = stepper_.current_time() >= end;
                State last = stepper_.current_state();
                if (ends)
                    stepper_.calc_state(end, last);
                if (last[0] > parameters_.stop) {
                    time_ = bisect(ends ? end : stepper_.current_time());
                    impact = true;
                } else if (ends) {
                    state_ = last;
                    time_ = end;
                    step_ = stepper_.current_time_step();
                    return;
                }
            }
            step_ = stepper_.current_time_step();
            stepper_.calc_state(time_, state_);
            state_[0] = parameters_.stop;
            state_[1] *= -parameters_.restitution;
            ++impacts_;
        }
    }

    double bisect(double high) const {
        double low = stepper_.previous_time();
        State state;
        while (high - low > time_resolution * (1 + high)) {
            const double middle = 0.5 * (low + high);
            stepper_.calc_state(middle, state);
            (state[0] > parameters_.stop ? high : low) = middle;
        }
        return low;
    }

    Parameters parameters_;
    Stepper stepper_;
    State state_{};
    double time_ = 0, step_ = 1e-3;
    std::size_t impacts_ = 0, steps_ = 0;
};
