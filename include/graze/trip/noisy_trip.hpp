#pragma once

#include "graze/branch/yield.hpp"
#include "graze/trip/simulated_trip.hpp"
#include "graze/trip/trip_origin.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

struct NoiseSettings {
    /// Correlation time of the noise in cycles; 0: independent from cycle to cycle.
    double memory = 0;
    std::size_t motions = 1000, cycles = 100; ///< number of motions, and largest number of cycles of each
    std::uint64_t seed = 1;
    double confidence = 0.95;          ///< confidence level of the probability's interval
    int jobs = 1;                      ///< number of threads; results do not depend on it
    double tolerance = 1e-12;          ///< relative tolerance of the integration
    std::function<bool()> interrupted; ///< returns true to stop
    /// Called with the number of finished motions.
    std::function<void(std::size_t motions)> progress;
    /// @throws InputError naming the setting that is out of range
    void validate() const;
};

struct NoisyTrips {
    std::size_t motions = 0, trips = 0;
    std::size_t failed = 0; ///< motions that failed otherwise; they do not count in the probability
    std::vector<std::pair<std::string, std::size_t>> failures; ///< kinds of failure, with their counts
    std::size_t beyond = 0;         ///< motions whose parameter was beyond the loss point at any time
    ConfidenceInterval probability; ///< probability of a trip within the cycles, with Wilson limits (see yield.hpp);
                                    ///< limits are 0 and 1 if all motions failed
    std::optional<double> half;     ///< number of cycles after which half of the motions had tripped
    bool interrupted = false;
};

/// Simulates motions with a noisy parameter: its value at the origin plus noise that is constant in each cycle. The
/// noise is the k-th value of an Ornstein-Uhlenbeck process sampled once per cycle, y_{k+1} = rho y_k + (1 -
/// rho^2)^(1/2) n_k with rho = exp(-1/memory), started in its stationary distribution and multiplied by the level.
/// Random numbers depend only on the seed and the numbers of motion and cycle, so results are bit for bit the same on
/// any number of threads.
/// @param level standard deviation of the parameter
NoisyTrips noisy_trips(const System& system, const TripOrigin& origin, double level, const TripEnd& end,
                       const NoiseSettings& settings = {});

/// The same at several levels. @param progress called with the level's number, from 0 on, and the motions that are done
/// @return for each level, until settings.interrupted
std::vector<NoisyTrips> noisy_trips(const LossPoint& point, const TripOrigin& origin, const std::vector<double>& levels,
                                    const TripEnd& end, const NoiseSettings& settings,
                                    const std::function<void(std::size_t level, std::size_t motions)>& progress = {});

} // namespace graze
