#pragma once

#include "graze/branch/fold_passage.hpp"
#include "graze/branch/yield.hpp"
#include "graze/grazing/trip_time.hpp"
#include "graze/trajectory/observer.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// A stable orbit at a value of the parameter before that at which it is lost: where a disturbed motion begins.
struct TripOrigin {
    ParameterId parameter;
    double value = 0; ///< of the parameter
    double point = 0; ///< at which the orbit is lost
    double cycle = 0; ///< time of one
    /// Amid the orbit's longest arc: what changes from cycle to cycle changes there, and not together with an event.
    std::vector<double> state, parameters;
    std::size_t mode = 0;
    std::optional<std::size_t> event; ///< whose contacts' speeds may end a trip
    bool half = false;                ///< so may those of its image

    bool counts(const Contact& contact) const;
};

/// @param map of the touch at which the orbit is lost, with respect to the parameter; @param orbit that touches
/// @throws InputError where no stable orbit of the same kind is found at the value, or it lies beyond the point
TripOrigin trip_origin(const System& system, const Orbit& orbit, const CycleMap& map, ParameterId parameter,
                       double value);
/// The same before a fold.
TripOrigin trip_origin(const System& system, const FoldPassage& fold, double value);

struct RampedTrip {
    TripTime trip;    ///< cycles and time since the ramp began
    double value = 0; ///< of the parameter at its end
};

/// The parameter rises (or falls) steadily from that of the origin, as a state of constant rate, by simulation.
/// @param rate of the parameter by time; @param options cycles are those beyond the point at most
/// @throws InputError for a rate of zero or that leads away from the point, and as drive_parameter does
RampedTrip ramped_trip(const System& system, const TripOrigin& origin, double rate, const TripEnd& end,
                       const TripOptions& options = {});

/// By how much a slow ramp overshoots a fold until the motion is gone, with the ramp's sign: with the change r of the
/// parameter in a cycle, 2.338 r^(2/3) (a b)^(-1/3), where -2.338 is the first zero of the Airy function (R. Haberman,
/// SIAM J. Appl. Math. 37, 1979).
double delay_of_ramp(const FoldPassage& fold, double rate);

/// The parameter swings about that of the origin, value + amplitude sin(2 pi t/period), by simulation.
/// @throws InputError for a period that is not positive, and as drive_parameter does
TripTime swung_trip(const System& system, const TripOrigin& origin, double amplitude, double period, const TripEnd& end,
                    const TripOptions& options = {});

struct NoiseSettings {
    /// Cycles after which the noise has forgotten all but 1/e of itself; 0: it is independent from cycle to cycle.
    double memory = 0;
    std::size_t motions = 1000, cycles = 100; ///< cycles of each, at most
    std::uint64_t seed = 1;
    double confidence = 0.95;
    int jobs = 1;                                      ///< threads, on which nothing depends
    double tolerance = 1e-12;                          ///< of the integration
    std::function<bool()> interrupted;                 ///< asked from any thread
    std::function<void(std::size_t motions)> progress; ///< how many are done; called from the calling thread
    /// @throws InputError naming what is out of range
    void validate() const;
};

struct NoisyTrips {
    std::size_t motions = 0, trips = 0;
    std::size_t failed = 0; ///< that ended otherwise: they are not counted in the share
    std::vector<std::pair<std::string, std::size_t>> failures; ///< how these ended, and how many each way
    std::size_t beyond = 0;                                    ///< whose parameter was beyond the point at any time
    ConfidenceInterval probability; ///< of a trip within the cycles, with limits by E. B. Wilson (see yield.hpp), which
                                    ///< are 0 and 1 where all failed
    std::optional<double> half;     ///< cycles after which half of the motions had tripped
    bool interrupted = false;
};

/// The parameter is that of the origin plus noise, constant in each cycle: the k-th value of an Ornstein-Uhlenbeck
/// process that is sampled once a cycle, y_{k+1} = rho y_k + (1 - rho^2)^(1/2) n_k with rho = exp(-1/memory), begun
/// with its stationary distribution and multiplied by the level. What is drawn depends on the seed, the motion's number
/// and the cycle's, not on the level: results are the same bit for bit on any number of threads.
/// @param level standard deviation of the parameter
NoisyTrips noisy_trips(const System& system, const TripOrigin& origin, double level, const TripEnd& end,
                       const NoiseSettings& settings = {});

} // namespace graze
