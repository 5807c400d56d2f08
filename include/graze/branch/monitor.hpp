#pragma once

#include "graze/orbit/orbit.hpp"

#include <complex>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A number of an orbit that is watched along a branch, or held.
struct Monitor {
    enum class Kind {
        value,    ///< of the expression at the end of a segment, before the jump
        start,    ///< of the expression at the start of a segment
        duration, ///< of a segment, or the period
        maximum,  ///< of the expression
        minimum,
        mean,       ///< of the expression over time
        norm,       ///< root of its mean square
        multiplier, ///< modulus of a multiplier of the whole orbit; may be infinite
    };
    std::string name, unit;
    Kind kind = Kind::duration;
    Expression expression; ///< in states and independent parameters; not of durations
    /// Which segment: its number (from 1), or the name of what ends it, as "J1" or its event, with "#2" for the second
    /// of that name.
    /// Empty: the whole orbit; of values at ends and starts the first segment.
    std::string segment;

    bool fixed = false;                    ///< held along the branch, which frees another parameter
    std::optional<double> held;            ///< at this value; none: the one of the candidate
    std::vector<double> crossings;         ///< values to be reported when they are taken
    std::optional<double> least, greatest; ///< bounds at which a branch ends
    std::size_t place = 1;                 ///< of multipliers: 1 for the largest
};

/// Sets the values of those monitors that are multipliers, which an orbit alone does not tell.
/// @param multipliers largest first; where there are fewer, the value is NaN: not defined
void measure_multipliers(const std::vector<Monitor>& monitors, const std::vector<std::complex<double>>& multipliers,
                         std::vector<double>& values);

/// Evaluates monitors of orbits of one signature. Extrema and means are those of the Taylor polynomials of the motion:
/// as accurate as the orbit itself.
class OrbitMonitors {
public:
    /// @throws InputError for a segment that the signature does not have
    OrbitMonitors(const System& system, const Signature& signature, std::vector<Monitor> monitors,
                  double tolerance = 1e-13);
    ~OrbitMonitors();
    OrbitMonitors(OrbitMonitors&&) noexcept;

    /// From now on of orbits of another signature. Compiles nothing. @throws InputError as above; then all is as before
    void set_signature(const Signature& signature);

    const std::vector<Monitor>& monitors() const;
    /// Index of a monitor's segment; none: the whole orbit.
    std::optional<std::size_t> segment(std::size_t monitor) const;
    /// One value for each, NaN where it is not defined, and for multipliers.
    std::vector<double> operator()(const Orbit& orbit);

private:
    class Evaluator;
    std::unique_ptr<Evaluator> evaluator_;
};

} // namespace graze
