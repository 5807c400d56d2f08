#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Sizes by which the states of orbits are measured: how far each goes along the orbit. They remember how large they
/// have been, or a branch on which everything shrinks would never come to the end of it.
class StateScales {
public:
    explicit StateScales(std::size_t states) : largest_(states, 0.0), has_size_(states, true) {}

    /// Forgets the states noted so far.
    void begin();
    void note(std::span<const double> state);
    /// @param periods of cyclic states, 0 for others
    /// @param coupling greatest derivatives of states with respect to earlier ones @param arcs those along arcs alone
    std::vector<double> choose(std::span<const double> periods, const Eigen::MatrixXd& coupling,
                               const Eigen::MatrixXd& arcs);

    /// Whether a state was more than zero when scales were chosen last: that of another measures it if not.
    bool has_size(std::size_t state) const { return has_size_[state]; }

private:
    bool rests(std::size_t i) const;
    double scale_by_effect(std::size_t i, std::span<const double> own, std::span<const double> periods,
                           const Eigen::MatrixXd& arcs) const;

    std::vector<double> least_, greatest_, sizes_, largest_;
    std::vector<bool> has_size_;
};

} // namespace graze
