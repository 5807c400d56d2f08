#pragma once

#include "graze/model/model.hpp"
#include "graze/results/run_kind.hpp"
#include "graze/study/atlas_limits.hpp"
#include "graze/sweep/attractor.hpp"
#include "graze/sweep/sampling.hpp"
#include "graze/trajectory/simulation.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A parameter or an initial state that differs from point to point.
struct Variation {
    std::string name, unit;
    std::optional<std::size_t> state = std::nullopt; ///< whose initial value varies; none: the parameter varies
    ParameterId parameter{};
    std::vector<double> values; ///< in rising order as studies give them; empty: values are drawn at random
    double low = 0, high = 0;   ///< range of random draws
    bool logarithmic = false;   ///< draws are uniform in the logarithm
    double offset = 0;          ///< is added to each draw
};

/// An initial state that is a function of what varies.
struct FollowingState {
    std::size_t state = 0;
    Expression value{}; ///< in parameters and in states that vary
};

/// The order in which a sweep goes through the values of its first axis.
enum class SweepDirection { up, down, both };

/// What varies from point to point, and in which order.
struct VariedValues {
    /// A sweep goes along the first axis; each combination of values of the others makes a chain of its own.
    std::vector<Variation> axes;
    SweepDirection direction = SweepDirection::up; ///< of sweeps
    bool carry = true;                             ///< sweeps: each point begins in the state in which the last ended
    std::uint64_t seed = 1;                        ///< of what is random
};

/// What runs of the kinds simulate, sweep, basin and atlas ask for.
struct MotionRequest : VariedValues {
    std::vector<FollowingState> following; ///< initial states that are computed anew for each point
    std::size_t draws = 0;      ///< random points for each combination of the listed values; 0: nothing is random
    TransientOptions transient; ///< of kind simulate: how long motions last
    AttractorOptions attractor; ///< of sweeps and basins: how the attractor is found
    SimulationOptions simulation;
    std::vector<Sampling> samplings;
    AtlasLimits atlas; ///< of kind atlas: what is explored from the sampled attractors

    /// How many points there are, and how many rows they make: sweeps have a row for each combination of the values of
    /// the axes after the first. Numbers too large to be counted are possible.
    double points() const;
    double rows(RunKind kind) const;
};

} // namespace graze
