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

/// The long-term behaviour of a motion.
enum class Label {
    periodic,       ///< a stable periodic orbit, confirmed by Newton's method
    quasi_periodic, ///< averages converge fast and the largest Lyapunov exponent is zero
    chaotic,        ///< the largest Lyapunov exponent is positive and remains so
    transient,      ///< chaotic for all `cycles` but not forever: it left later, or similar motions do (EscapeLaw)
    equilibrium,    ///< a stable state at which everything except clocks and drifting states is at rest
    unbounded,      ///< grows forever: it has grown by decades, and the field is affine beyond
    unsettled,      ///< none of these could be shown within the allowed cycles
    escaped,        ///< a state left the bounds that were given
    singular,       ///< the solution ceases to exist, as by snap-through
    chattering,     ///< contacts accumulate and the model declares no sticking mode
    ended,          ///< the model ends the motion, or a plain simulation reached its time or count
    failed,         ///< Outcome says why
};
/// Stable name for tables and files, such as "quasi-periodic".
std::string_view name_of(Label label);

/// Values of a state beyond which a motion has escaped.
struct StateBounds {
    std::size_t state = 0;
    double least = 0, greatest = 0;
    /// Returns false for NaN.
    bool contain(double value) const { return value >= least && value <= greatest; }
};
/// @throws InputError for a state that the model does not have, and for bounds in the wrong order
void validate_bounds(const Model& model, std::span<const StateBounds> bounds);

/// Options of the search for attractors. A return is a passage of `section`.
struct AttractorOptions {
    /// Upper limits: of `cycles`, `lyapunov_cycles` and `chaos_cycles`; of `keep`, whose returns are held in memory; of
    /// `largest_period`; of `recurrence` and `disturbance`.
    static constexpr std::size_t most_cycles = 100'000'000, most_kept = 1'000'000, most_returns = 1000;
    static constexpr double most_distance = 0.1;

    std::string section;            ///< name of a section of the model; its passages are returns
    std::size_t cycles = 150;       ///< returns after which the search gives up; more for slow transients
    std::size_t keep = 100;         ///< number of last returns that are sampled when the motion is not periodic
    std::size_t largest_period = 6; ///< longest period that is searched, in returns
    /// A return this close to an earlier one (relative to the spread of the states) starts Newton's method; smaller
    /// values start it later but with fewer failures.
    double recurrence = 1e-3;
    /// Displacement of a motion that lies on an unstable orbit or equilibrium, relative to the spread of the states or,
    /// where nothing moves, to the length over which the field is linear. 0: such a motion is labelled unsettled.
    double disturbance = 1e-6;
    /// The exponent is averaged over this number of the last `cycles`, over half of `cycles` if that is more, and over
    /// any later returns. 0: no exponent.
    std::size_t lyapunov_cycles = 60;
    /// Returns for which a motion must remain chaotic before it is labelled so; at least `cycles`.
    std::size_t chaos_cycles = 1500;
    /// If true, a motion that looked chaotic for all `cycles` keeps its state and samples of that time, and is labelled
    /// transient if it settles when followed for longer: a sweep that carries states along then does not depend on the
    /// length of the test. If false, the result is what the motion finally settles on.
    bool stay_in_transients = false;
    double longest_return = 0; ///< time without a return after which a point is labelled unsettled; 0: no limit
    std::vector<StateBounds> bounds = {}; ///< a motion that leaves them has escaped
    /// @throws InputError naming the option that is out of range
    void validate(const Model& model) const;
};

/// End conditions of a plain simulation: whichever comes first; 0 means never.
struct TransientOptions {
    std::string section = {};                  ///< whose passages are periods; may be empty
    double skip_time = 0, time = 0;            ///< time without samples; then time with samples
    std::size_t skip_periods = 0, periods = 0; ///< periods without samples; then periods with samples
    std::size_t contacts = 0;                  ///< number of contacts at the events `counted`
    std::vector<std::size_t> counted = {};     ///< indices of events in the model
    std::vector<StateBounds> bounds = {};      ///< leaving them ends the simulation
    /// Approach speed at a counted contact above which the simulation ends; 0: no limit.
    double greatest_speed = 0;
    /// @throws InputError naming the option that is out of range, or if no end condition is given
    void validate(const Model& model) const;
};

/// The result for one point of a sweep or basin.
struct PointResult {
    Label label = Label::unsettled;
    std::size_t period = 0; ///< period of the orbit in returns; 1 for an equilibrium with the section of a clock
    double duration = 0;    ///< period in units of time
    /// Labels of the transitions in one period (in a unique order) as in "impact^2 release"; empty when not periodic.
    std::string signature;
    std::optional<bool> symmetric; ///< whether a periodic orbit is its own image under the model's (first) symmetry
    std::vector<std::complex<double>> multipliers; ///< of the return map, largest first
    std::vector<std::complex<double>>
        eigenvalues;     ///< of an equilibrium on which no clock acts, largest real part first
    double residual = 0; ///< defect of the periodic orbit, relative to the spread of the states
    std::optional<double> lyapunov, lyapunov_error; ///< largest exponent, per unit of time, and its error (95 %)
    std::size_t cycles = 0;                         ///< returns simulated until the result was known
    std::size_t periods_run = 0; ///< all returns simulated, including those for Newton's method and exponents
    double time = 0;             ///< simulated time
    std::vector<double> state;   ///< final state; on the section for attractors. The next point may start from it
    std::size_t mode = 0;
    Outcome outcome;   ///< outcome of the trajectory
    SampleSet samples; ///< over one period, the last `keep` returns, or the requested time
};

} // namespace graze
