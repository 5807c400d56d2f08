#pragma once

#include "graze/sweep/sampling.hpp"
#include "graze/trajectory/outcome.hpp"

#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// What a motion settles on.
enum class Label {
    periodic,       ///< a stable periodic orbit, confirmed by Newton's method
    quasi_periodic, ///< averages converge fast, the largest Lyapunov exponent is zero
    chaotic,        ///< the largest Lyapunov exponent is positive, and remains so
    transient,      ///< chaotic for all `cycles`, but not for ever: it left later, or motions like it do (EscapeLaw)
    equilibrium,    ///< a stable state at which all rests but clocks and drifting states
    unbounded,      ///< grows for ever: by decades already, in a field that does not bend beyond
    unsettled,      ///< none of these could be shown within the cycles allowed
    escaped,        ///< a state left the bounds that were given
    singular,       ///< the solution ceases to exist, as by snap-through
    chattering,     ///< contacts accumulate and the model does not say what then
    ended,          ///< the model ends the motion; or the time or count asked for is reached (plain simulation)
    failed,         ///< Outcome says why
};
/// Stable name for tables and files, such as "quasi-periodic".
std::string_view name_of(Label label);

/// Values of a state beyond which a motion has escaped.
struct StateBounds {
    std::size_t state = 0;
    double least = 0, greatest = 0;
    /// NaN is beyond.
    bool contain(double value) const { return value >= least && value <= greatest; }
};
/// @throws InputError for a state that the model does not have, and bounds that are not in order
void validate_bounds(const Model& model, std::span<const StateBounds> bounds);

/// How attractors are looked for. Returns are passages of `section`.
struct AttractorOptions {
    /// Limits of `cycles`, `lyapunov_cycles` and `chaos_cycles`; of `keep`, whose returns are in memory; of
    /// `largest_period`; of `recurrence` and `disturbance`.
    static constexpr std::size_t most_cycles = 100'000'000, most_kept = 1'000'000, most_returns = 1000;
    static constexpr double most_distance = 0.1;

    std::string section;            ///< of the model
    std::size_t cycles = 150;       ///< returns after which the search gives up
    std::size_t keep = 100;         ///< last returns that are sampled when the motion is not periodic
    std::size_t largest_period = 6; ///< in returns
    /// Returns that come this close (relative to the spread of the states) are tried by Newton's method.
    double recurrence = 1e-3;
    /// Displacement of a motion that sits on an unstable orbit or equilibrium: relative to the spread of the states,
    /// or, where nothing moves, to the length over which the field is linear. 0: such a motion is unsettled.
    double disturbance = 1e-6;
    /// The last of `cycles`, over which the exponent is averaged at least: half of `cycles` if that is more, and
    /// whatever returns come behind. 0: no exponent.
    std::size_t lyapunov_cycles = 60;
    /// Returns for which a motion must remain chaotic before it is called so; `cycles` if that is more.
    std::size_t chaos_cycles = 1500;
    /// Whether a motion that looked chaotic for all `cycles` is left there: its state and samples are those of that
    /// time, and if it settles on anything when it is followed for longer it is a transient. So a sweep that carries
    /// states along does not depend on how long chaos is retested. Otherwise it is what it settles on in the end.
    bool stay_in_transients = false;
    double longest_return = 0; ///< time without a return after which a point is given up as unsettled; 0: none
    std::vector<StateBounds> bounds = {}; ///< leaving them is an escape
    /// @throws InputError naming the option that is out of range
    void validate(const Model& model) const;
};

/// How a plain simulation ends: whichever comes first; 0 means never.
struct TransientOptions {
    std::string section = {};       ///< whose passages are periods; may be empty
    double skip_time = 0, time = 0; ///< time of which nothing is sampled; then time that is
    std::size_t skip_periods = 0, periods = 0;
    std::size_t contacts = 0; ///< contacts at the events `counted`
    std::vector<std::size_t> counted = {};
    std::vector<StateBounds> bounds = {}; ///< leaving them ends it
    double greatest_speed = 0;            ///< of approach at a counted contact, after which the simulation ends; 0: any
    /// @throws InputError naming the option that is out of range, or that the simulation need not end
    void validate(const Model& model) const;
};

/// What was found at one point of a sweep or basin.
struct PointResult {
    Label label = Label::unsettled;
    std::size_t period = 0; ///< of a periodic orbit, in returns; of an equilibrium at sections of a clock, 1
    double duration = 0;    ///< and in time
    /// Labels of the transitions in one period or, when not periodic, empty; repeats as in "impact^2 release".
    std::string signature;
    std::optional<bool> symmetric; ///< whether a periodic orbit is its own image under the model's (first) symmetry
    std::vector<std::complex<double>> multipliers; ///< of the return map, largest first
    double residual = 0; ///< by which the orbit fails to close, relative to the spread of the states
    std::optional<double> lyapunov, lyapunov_error; ///< largest exponent, per unit of time, and its error (95 %)
    std::size_t cycles = 0;                         ///< returns simulated until the result was known
    std::size_t periods_run = 0;                    ///< all returns simulated, for Newton's method and exponents too
    double time = 0;                                ///< of the motion, in all
    std::vector<double> state; ///< at its end; on the section for attractors. The next point may go on from here
    std::size_t mode = 0;
    Outcome outcome;   ///< of the trajectory
    SampleSet samples; ///< over one period, the last `keep` returns, or the time asked for
};

} // namespace graze
