#pragma once

#include "graze/orbit/orbit.hpp"
#include "orbit/orbit_evaluation.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// What ends the segments of an orbit - event, section or cut, jump, the symmetry's image after a half orbit's last one
/// - with derivatives with respect to states and free parameters: the same for every discretisation.
class SegmentEnds {
public:
    SegmentEnds(const System& system, const Orbit& orbit, std::vector<ParameterId> free);

    const Signature& signature() const { return signature_; }
    std::optional<std::size_t> symmetry() const { return symmetry_; }
    const std::vector<ParameterId>& free() const { return free_; }

    void set_parameters(std::span<const double> parameters);
    /// Lays the planes of cuts across the motion, through where the next segments start in an orbit.
    /// @param scales of the states
    void lay_cuts(const Orbit& orbit, const Eigen::VectorXd& scales);
    /// The normal of the plane in which the segment after a cut starts; empty for other ends.
    const Eigen::VectorXd& cut_normal(std::size_t segment) const { return ends_[segment].normal; }
    /// Of cyclic states, 0 of others.
    const std::vector<double>& periods() const { return periods_; }
    /// Their derivatives, states x free.
    const Eigen::MatrixXd& period_rates() const { return period_rates_; }

    /// The vector field at a state.
    void field(std::size_t segment, std::span<const double> state, Eigen::VectorXd& result);
    /// Sets all but the flow of a segment's last piece from its end. @return false where the jump is not defined
    bool pass(std::size_t segment, OrbitEvaluation::Piece& piece);
    /// The same without derivatives. @param state at the segment's end, replaced by the one after the jump
    /// @param condition zero on the orbit
    bool pass(std::size_t segment, std::vector<double>& state, double& condition);
    /// Of values as System::with_gradient gives them the gradient with respect to states and free parameters.
    Eigen::VectorXd gradient_of(std::span<const double> values) const;

private:
    struct EndFunction {
        const Function* value = nullptr; ///< and its gradient, of the system; null for a cut
        bool cyclic = false;             ///< a phase section: holds up to whole periods of `state`
        std::size_t state = 0;
        Eigen::VectorXd normal, through; ///< of a cut: its plane, of states after the segment
    };
    void apply(const System::CompiledJump& map, OrbitEvaluation::Piece& piece);
    double off_cut(const EndFunction& end, std::span<const double> after, Eigen::VectorXd* turns) const;
    void pass_cut(const EndFunction& end, OrbitEvaluation::Piece& piece) const;

    System system_;
    Signature signature_;
    std::optional<std::size_t> symmetry_;
    std::vector<ParameterId> free_;
    std::size_t n_;
    std::vector<EndFunction> ends_;
    std::vector<double> parameters_, periods_, inputs_, work_, values_;
    Eigen::MatrixXd period_rates_;
};

} // namespace graze
