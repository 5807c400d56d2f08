#pragma once

#include "graze/orbit/orbit.hpp"
#include "orbit/orbit_evaluation.hpp"
#include "orbit/orbit_flow.hpp"
#include "orbit/orbit_layout.hpp"
#include "orbit/orbit_scales.hpp"
#include "orbit/segment_ends.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// Rates of end conditions below this share of their usual size are round-off.
inline constexpr double least_rate = 1e-11;

/// The equations of a periodic orbit of one signature, as many as unknowns less the free parameters: each piece of a
/// segment takes its start x_k in a time T_k (whatever events it passes) onto the surface that ends it, and the jump
/// takes it to the start of the next. How a piece is followed is left to the discretisation: Shooting integrates it,
/// Collocation solves for a polynomial.
///
/// Long or expanding segments consist of several pieces, of which all but the last have a fixed duration. States in
/// which the orbit is periodic up to translation (drifting), or which nothing ever changes (a frame at rest), are held
/// at their first values instead of being closed.
class OrbitEquations {
public:
    virtual ~OrbitEquations() = default;

    const Simulation& simulation() const { return simulation_; }
    const System& system() const { return simulation_.system(); }
    const Model& model() const { return simulation_.model(); }
    const Signature& signature() const { return ends_.signature(); }
    std::optional<std::size_t> symmetry() const { return ends_.symmetry(); }
    const std::vector<ParameterId>& free() const { return ends_.free(); }
    /// Steps of integration since they were made.
    std::size_t work() const { return flow_.steps(); }
    const OrbitLayout& layout() const { return layout_; }
    std::size_t unknowns() const { return layout_.unknowns(); }
    std::size_t mode_of(std::size_t piece) const { return modes_[layout_.segment_of(piece)]; }
    /// Duration of each piece that is not its segment's last.
    double fixed_duration(std::size_t piece) const { return fixed_durations_[piece]; }

    Eigen::VectorXd unknowns_of(const Orbit& orbit);
    Orbit orbit_of(const Eigen::VectorXd& unknowns) const;
    /// A direction of the unknowns as one of the orbit, and back: starts of later pieces follow from those of the
    /// first.
    OrbitDirection direction_of(const Eigen::VectorXd& unknowns) const;
    /// Parameters that it does not mention stay. @param at an evaluation at the orbit that changes
    /// @throws InputError when it does not fit the orbit
    Eigen::VectorXd unknowns_of(const OrbitDirection& direction, const OrbitEvaluation& at) const;

    const Eigen::VectorXd& scales() const { return scales_; }
    /// Whether a state's scale tells its size; not that of one which is zero all along the orbit.
    bool has_size(std::size_t state) const { return orbit_scales_.has_size(state); }
    /// Chooses them anew. Evaluations keep those by which they were made.
    void set_scales(const Eigen::VectorXd& unknowns);

    OrbitEvaluation evaluation() const { return {layout_.states(), layout_.free()}; }
    /// Evaluates the equations and their derivatives. @return false where that is impossible
    bool evaluate(const Eigen::VectorXd& unknowns, OrbitEvaluation& result);

    /// The equations at an evaluation together with further ones, whose rows are the borders, as many as parameters are
    /// free: factored.
    struct Closed {
        CyclicSystem::Closed system;
        Eigen::VectorXd lack; ///< what inner unknowns lack, in the further equations
    };
    Closed close(const OrbitEvaluation& at, const Eigen::MatrixXd& borders) const;
    /// Solves derivatives * step = -equations (or 0), borders * step = right. @return false when that is singular
    bool solve(const OrbitEvaluation& at, const Closed& closed, const Eigen::VectorXd& right, bool homogeneous,
               Eigen::VectorXd& step) const;
    bool solve(const OrbitEvaluation& at, const Eigen::MatrixXd& borders, const Eigen::VectorXd& right,
               bool homogeneous, Eigen::VectorXd& step) const {
        return solve(at, close(at, borders), right, homogeneous, step);
    }
    /// The same without free parameters, where equations need not determine all: the step of least change, in all
    /// directions but `lost` ones, which they leave free. @param lost given, how many these are at least. @return false
    /// when a number is not finite
    bool solve_nearest(const OrbitEvaluation& at, Eigen::VectorXd& step, std::size_t& lost) const;
    /// What the unknowns answer to a change of the equations, piece after piece in units of the scales, without free
    /// parameters: solves derivatives * step = change. @return false when that is singular
    bool respond(const OrbitEvaluation& at, const Eigen::VectorXd& change, Eigen::VectorXd& step) const;
    /// Whether `chord` is possible.
    bool has_chords() const { return layout_.inner() == 0; }
    /// Whether derivatives cost more than many flows: by a few inputs they do not.
    bool derivatives_are_dear() const { return layout_.states() + layout_.free() >= many_inputs; }
    /// Solves the same for the equations at other unknowns, with the derivatives of the evaluation: the flow alone is
    /// enough. @param right of the further equations. @return false when the equations are not defined there
    bool chord(const OrbitEvaluation& at, const Closed& closed, const Eigen::VectorXd& unknowns,
               const Eigen::VectorXd& right, Eigen::VectorXd& step);
    /// A vector that the derivatives map to (nearly) zero and whose product with the row is zero: where the equations
    /// are singular beyond their one branch, the direction of another. For one free parameter.
    bool null_vector(const OrbitEvaluation& at, const Eigen::RowVectorXd& row, Eigen::VectorXd& vector) const;

    /// Of values as System::with_gradient gives them the gradient with respect to states and free parameters.
    Eigen::VectorXd gradient_of(std::span<const double> values) const { return ends_.gradient_of(values); }
    /// Derivatives of a function of states and free parameters at the end of a piece, before the jump, with respect to
    /// all unknowns. @param gradient states + free
    Eigen::RowVectorXd row_at_end(const OrbitEvaluation& at, std::size_t piece, const Eigen::VectorXd& gradient) const;
    /// The rate at which the end condition of a segment changes along the flow at its end: the negative approach speed.
    double rate_at_end(const OrbitEvaluation& at, std::size_t segment) const;
    /// Size of such rates: how much the end condition changes along the scales of the states, in the time of the orbit.
    double usual_rate(const OrbitEvaluation& at, std::size_t segment) const;
    /// The same of another event's function there.
    double usual_rate(const OrbitEvaluation& at, std::size_t segment, std::size_t event) const;
    /// The normal of the plane in which the segment after a cut starts; empty for other ends.
    const Eigen::VectorXd& cut_normal(std::size_t segment) const { return ends_.cut_normal(segment); }
    /// The flow of the modes at an evaluation's parameters.
    ModeFlow& flow_at(const OrbitEvaluation& at);

protected:
    OrbitEquations(const Simulation& simulation, const Orbit& orbit, std::vector<ParameterId> free,
                   std::vector<double> ranges);
    /// To be called at the end of the constructor of a discretisation.
    /// @param counts of the pieces of each segment; @param inner unknowns of each piece
    void lay_out(const Orbit& orbit, const std::vector<std::size_t>& counts, std::size_t inner = 0);

    ModeFlow& flow() { return flow_; }
    SegmentEnds& ends() { return ends_; }
    OrbitScales& orbit_scales() { return orbit_scales_; }

private:
    static constexpr std::size_t many_inputs = 12;

    void raise_above_round_off(const Eigen::VectorXd& unknowns, const std::vector<double>& parameters);

    /// Sets the end of a piece with its derivatives, and its field. @return false, with the problem said, where it
    /// cannot be followed
    virtual bool follow(std::size_t piece, const Eigen::VectorXd& unknowns, OrbitEvaluation& at) = 0;
    /// Sets the inner unknowns of an orbit, from its flow.
    virtual void set_inner(const Orbit&, Eigen::VectorXd&) {}

    void take_segments(const Eigen::VectorXd& unknowns, std::vector<std::vector<double>>& starts,
                       std::vector<double>& durations) const;
    double usual_change(const OrbitEvaluation& at, const Eigen::VectorXd& gradient) const;
    void set_parameters(const Eigen::VectorXd& unknowns, std::vector<double>& parameters);
    bool evaluate_piece(std::size_t k, const Eigen::VectorXd& unknowns, OrbitEvaluation& at);
    void assemble(const Eigen::VectorXd& unknowns, OrbitEvaluation& at);
    void assemble_end(std::size_t k, OrbitEvaluation& at) const;
    void assemble_closure(std::size_t k, const Eigen::VectorXd& unknowns, OrbitEvaluation& at,
                          std::vector<bool>& neutral) const;
    void drop_neutral_by_chance(const OrbitEvaluation& at, std::vector<bool>& neutral);
    void pin(const Eigen::VectorXd& unknowns, const std::vector<bool>& neutral, OrbitEvaluation& at) const;
    bool set_right(std::size_t k, const Eigen::VectorXd& unknowns, const OrbitEvaluation& at, Eigen::VectorXd& right);
    Eigen::MatrixXd condensed(const OrbitEvaluation& at, const Eigen::MatrixXd& borders, Eigen::VectorXd& lack) const;
    Eigen::VectorXd expanded(const OrbitEvaluation& at, const Eigen::VectorXd& outer, bool homogeneous) const;
    void clear_remnants(Eigen::VectorXd& unknowns) const;

    Simulation simulation_;
    SegmentEnds ends_;
    std::vector<std::size_t> modes_; ///< of the segments
    ModeFlow flow_;
    OrbitLayout layout_;
    OrbitScales orbit_scales_;
    Eigen::VectorXd scales_;
    std::vector<double> fixed_durations_; ///< of the pieces
    std::vector<double> parameters_;      ///< those that are not free stay
    std::vector<double> reference_;       ///< at which drifting and unchanged states are held
};

} // namespace graze
