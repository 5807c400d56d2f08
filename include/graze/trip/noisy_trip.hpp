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

/// The same at several levels. @param progress called with the level's number, from 0 on, and the motions that are done
/// @return for each level, until settings.interrupted
std::vector<NoisyTrips> noisy_trips(const LossPoint& point, const TripOrigin& origin, const std::vector<double>& levels,
                                    const TripEnd& end, const NoiseSettings& settings,
                                    const std::function<void(std::size_t level, std::size_t motions)>& progress = {});

} // namespace graze
