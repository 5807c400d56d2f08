#pragma once

#include "graze/orbit/orbit.hpp"

#include <complex>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A quantity of an orbit that is recorded along a branch, or held constant.
struct Monitor {
    enum class Kind {
        value,    ///< the expression at the end of a segment, before the jump
        start,    ///< the expression at the start of a segment
        duration, ///< duration of a segment, or the period
        maximum,  ///< maximum of the expression
        minimum,
        mean,       ///< time average of the expression
        norm,       ///< root mean square of the expression
        multiplier, ///< magnitude of a multiplier of the whole orbit; may be infinite
        conserved,  ///< a conserved quantity of the motion: its value at the first start
    };
    std::string name, unit;
    Kind kind = Kind::duration;
    Expression expression; ///< in states and independent parameters; unused for durations and multipliers
    /// The segment: its number (from 1), or the name of its end, such as "J1" or the event, with "#2" for the second of
    /// that name. Empty: the whole orbit; for values at starts and ends, the first segment.
    std::string segment;

    bool fixed = false;                    ///< hold the quantity along the branch, which needs another free parameter
    std::optional<double> held;            ///< value at which it is held; empty: its value at the candidate
    std::vector<double> crossings;         ///< values whose crossings are reported as points (UZ)
    std::optional<double> least, greatest; ///< bounds at which a branch ends
    std::size_t place = 1;                 ///< for multipliers: rank by magnitude, 1 for the largest
    /// Of a conserved quantity whose expression is not the same in all modes: that in each mode.
    std::vector<Expression> in_modes = {};

    const Expression& expression_in(std::size_t mode) const {
        return in_modes.empty() ? expression : in_modes.at(mode);
    }
};

/// Returns the monitor of a conserved quantity. @throws InputError when the model has none of this name
Monitor monitor_of_conserved(const Model& model, const std::string& name);

/// True for a maximum or minimum along the motion.
inline bool is_extreme(const Monitor& monitor) {
    return monitor.kind == Monitor::Kind::maximum || monitor.kind == Monitor::Kind::minimum;
}

/// Sets the values of monitors that are multipliers, which OrbitMonitors cannot evaluate.
/// @param multipliers largest first; the value of a monitor beyond their number is NaN
void measure_multipliers(const std::vector<Monitor>& monitors, const std::vector<std::complex<double>>& multipliers,
                         std::vector<double>& values);

/// Evaluates monitors for orbits of one signature. Extrema and means are computed from the Taylor polynomials of the
/// motion and are as accurate as the orbit.
class OrbitMonitors {
public:
    /// @throws InputError for a segment that the signature does not have
    OrbitMonitors(const System& system, const Signature& signature, std::vector<Monitor> monitors,
                  double tolerance = 1e-13);
    ~OrbitMonitors();
    OrbitMonitors(OrbitMonitors&&) noexcept;

    /// Changes the signature without compiling anew. @throws InputError as above; then nothing changes
    void set_signature(const Signature& signature);

    const std::vector<Monitor>& monitors() const;
    /// Index of a monitor's segment; empty: the whole orbit.
    std::optional<std::size_t> segment(std::size_t monitor) const;
    /// Returns one value per monitor; NaN where it is not defined, and for multipliers.
    std::vector<double> operator()(const Orbit& orbit);

private:
    class Evaluator;
    std::unique_ptr<Evaluator> evaluator_;
};

} // namespace graze
