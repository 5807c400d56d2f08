#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Scales of the states of an orbit: their extents along it. The scales remember their largest values; otherwise a
/// branch on which the orbit shrinks to a point would never reach its end.
class StateScales {
public:
    explicit StateScales(std::size_t states) : largest_(states, 0.0), has_size_(states, true) {}

    /// Starts a new orbit: forgets the extents, keeps the largest scales.
    void begin();
    void note(std::span<const double> state);
    /// @param periods of cyclic states, 0 for others
    /// @param coupling largest derivatives of states with respect to earlier ones @param arcs the same along arcs
    /// without jumps
    std::vector<double> choose(std::span<const double> periods, const Eigen::MatrixXd& coupling,
                               const Eigen::MatrixXd& arcs);

    /// True when the state was not negligible at the last choice of scales; otherwise its scale is borrowed from
    /// another state.
    bool has_size(std::size_t state) const { return has_size_[state]; }

private:
    bool is_constant(std::size_t i) const;
    double scale_by_effect(std::size_t i, std::span<const double> own, std::span<const double> periods,
                           const Eigen::MatrixXd& arcs) const;

    std::vector<double> least_, greatest_, sizes_, largest_;
    std::vector<bool> has_size_;
};

} // namespace graze
