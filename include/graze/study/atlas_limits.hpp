#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace graze {

/// A range of an initial state from which motions begin at random.
struct AtlasStart {
    std::string state;
    double low = 0, high = 0;

    bool operator==(const AtlasStart&) const = default;
};

/// How far the exploration of a run of kind atlas goes beyond the attractors that the run itself samples. These do not
/// depend on it.
struct AtlasLimits {
    std::size_t contacts = 8; ///< largest number of contacts with barriers in one return of orbits that are followed
    std::size_t multiple = 4; ///< longest period, in returns, of orbits that are followed
    std::size_t branches = 300, curves = 100; ///< largest numbers of branches, and of curves, that are followed
    std::vector<AtlasStart> starts;           ///< empty: the ranges follow from the extents of the sampled motions
    std::size_t draws = 2;  ///< random initial states at each combination of parameters at which motions begin
    std::uint64_t seed = 1; ///< of these states
    double minutes = 0;     ///< time of exploration after which nothing further is begun; 0: no limit

    static constexpr std::size_t most_contacts = 1000, most_multiple = 1024, most_branches = 10'000,
                                 most_curves = 10'000, most_draws = 10'000;

    bool operator==(const AtlasLimits&) const = default;
};

} // namespace graze
