#pragma once

#include "graze/orbit/orbit.hpp"
#include "orbit/orbit_evaluation.hpp"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace graze {

/// The ends of an orbit's segments, with derivatives with respect to states and free parameters, for every
/// discretisation: the end condition (event, section or cut), the jump and, after the last segment of a half orbit, the
/// symmetry.
class SegmentEnds {
public:
    SegmentEnds(const System& system, const Orbit& orbit, std::vector<ParameterId> free);

    const Signature& signature() const { return signature_; }
    std::optional<std::size_t> symmetry() const { return symmetry_; }
    const std::vector<ParameterId>& free() const { return free_; }

    void set_parameters(std::span<const double> parameters);
    /// Lays the planes of cuts across the motion, through the starts of the next segments of an orbit.
    /// @param scales of the states
    void lay_cuts(const Orbit& orbit, const Eigen::VectorXd& scales);
    /// The normal of the plane in which the segment after a cut starts; empty for other ends.
    const Eigen::VectorXd& cut_normal(std::size_t segment) const { return ends_[segment].normal; }
    /// Periods of cyclic states, 0 for others.
    const std::vector<double>& periods() const { return periods_; }
    /// Derivatives of the periods, states x free.
    const Eigen::MatrixXd& period_rates() const { return period_rates_; }

    /// Evaluates the vector field of a segment's mode at a state.
    void field(std::size_t segment, std::span<const double> state, Eigen::VectorXd& result);
    /// Which end of a segment is passed: its own, or a contact within a chatter sequence.
    enum class Passed { end, contact };
    /// Sets end condition, jump and state after it, with derivatives, from the end of a segment's last piece. Where
    /// contacts accumulate there is no end condition: the accumulation is known. @return false where the jump is not
    /// defined
    bool pass(std::size_t segment, OrbitEvaluation::Piece& piece, Passed passed = Passed::end);
    /// The same without derivatives. @param state at the end of the segment; replaced by the state after the jump
    /// @param condition value of the end condition, zero on the orbit
    bool pass(std::size_t segment, std::vector<double>& state, double& condition, Passed passed = Passed::end);
    /// Returns the gradient with respect to states and free parameters, from values in the order of
    /// System::with_gradient.
    Eigen::VectorXd gradient_of(std::span<const double> values) const;

private:
    struct EndFunction {
        /// Value and gradient of the condition, owned by the system; null for a cut and for the approach to a saddle,
        /// where HomoclinicEnds has the condition. Of a chatter sequence it is that of its contacts.
        const Function* value = nullptr;
        bool cyclic = false; ///< phase section: the condition holds up to whole periods of `state`
        std::size_t state = 0;
        /// Plane of a cut, in the state space of the next segment; empty for other ends.
        Eigen::VectorXd normal, through;
    };
    /// The condition that is met; null: there is none, or it is a plane.
    const Function* condition_of(std::size_t segment, Passed passed) const;
    /// The jumps made there, one after another.
    std::vector<const System::CompiledJump*> jumps_of(std::size_t segment, Passed passed) const;
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
