#pragma once

#include "orbit/accumulation.hpp"
#include "orbit/cycle_ends.hpp"
#include "orbit/homoclinic_ends.hpp"
#include "orbit/orbit_scales.hpp"
#include "orbit/segment_ends.hpp"

#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Returns a matrix of derivatives of the state before the jump of a piece as those of the state after it. Of many
/// states a jump changes few.
Eigen::MatrixXd jump_times(const OrbitEvaluation::Piece& piece, const Eigen::MatrixXd& derivatives);

/// Rates of end conditions below this share of their typical rate are round-off.
inline constexpr double least_rate = 1e-11;

/// The equations of a periodic orbit with one signature; there are as many equations as unknowns without the free
/// parameters. The flow takes the start x_k of each piece of a segment in the time T_k onto the surface that ends it,
/// whatever other events it passes, and the jump leads to the start of the next. The discretisation decides how a piece
/// is followed: Shooting integrates it, Collocation solves for a polynomial.
///
/// Long or expanding segments consist of several pieces, of which all but the last have a fixed duration. A complete
/// chatter sequence consists of a piece for each contact that is resolved, and a last one for all others. Drifting
/// states (periodic up to translation) and neutral states (returned unchanged, as a frame at rest) are held at their
/// first values instead of being closed.
///
/// A homoclinic orbit, whose last segment approaches a saddle, does not close: the equations demand that it begins in
/// the linear unstable space of the saddle and ends in the stable one, at a given distance. It exists for one value of
/// a free parameter, which the distance at which it begins determines as a border equation (`departure_row`). An orbit
/// that is homoclinic to a cycle does not close either, and exists without such a condition (`CycleEnds`).
class OrbitEquations {
public:
    virtual ~OrbitEquations() = default;

    const Simulation& simulation() const { return simulation_; }
    const System& system() const { return simulation_.system(); }
    const Model& model() const { return simulation_.model(); }
    const Signature& signature() const { return ends_.signature(); }
    std::optional<std::size_t> symmetry() const { return ends_.symmetry(); }
    const std::vector<ParameterId>& free() const { return ends_.free(); }
    /// Number of integration steps since construction.
    std::size_t work() const { return flow_.steps(); }
    const OrbitLayout& layout() const { return layout_; }
    std::size_t unknowns() const { return layout_.unknowns(); }
    std::size_t mode_of(std::size_t piece) const { return modes_[layout_.segment_of(piece)]; }
    /// Duration of a piece that is not the last of its segment.
    double fixed_duration(std::size_t piece) const { return fixed_durations_[piece]; }

    Eigen::VectorXd unknowns_of(const Orbit& orbit);
    Orbit orbit_of(const Eigen::VectorXd& unknowns) const;
    /// Converts a direction of the unknowns to a direction of the orbit. The inverse computes starts of later pieces
    /// from those of the first by the variational flow.
    OrbitDirection direction_of(const Eigen::VectorXd& unknowns) const;
    /// Parameters without an entry do not change. @param at an evaluation at the orbit
    /// @throws InputError when the direction does not fit the orbit
    Eigen::VectorXd unknowns_of(const OrbitDirection& direction, const OrbitEvaluation& at) const;

    const Eigen::VectorXd& scales() const { return scales_; }
    /// True when the scale of a state is its own size; false for a state that is zero all along the orbit.
    bool has_size(std::size_t state) const { return orbit_scales_.has_size(state); }
    /// Recomputes the scales. Existing evaluations keep the scales with which they were made.
    void set_scales(const Eigen::VectorXd& unknowns);
    /// The same with the memory of an earlier choice of scales, which forgets larger ones since.
    void set_scales(const Eigen::VectorXd& unknowns, const OrbitScales& memory) {
        orbit_scales_ = memory;
        set_scales(unknowns);
    }
    const OrbitScales& memory_of_scales() const { return orbit_scales_; }

    OrbitEvaluation evaluation() const { return {layout_.states(), layout_.free()}; }
    /// Evaluates the equations and their derivatives. @return false where they are undefined; `result.problem` says why
    bool evaluate(const Eigen::VectorXd& unknowns, OrbitEvaluation& result);

    /// The factored equations at an evaluation, bordered by one row per free parameter.
    struct Closed {
        CyclicSystem::Closed system;
        Eigen::VectorXd lack; ///< contribution of the inner defects to the border equations
    };
    Closed close(const OrbitEvaluation& at, const Eigen::MatrixXd& borders) const;
    /// Solves derivatives * step = -residuals (0 if homogeneous), borders * step = right. @return false when the matrix
    /// is singular
    bool solve(const OrbitEvaluation& at, const Closed& closed, const Eigen::VectorXd& right, bool homogeneous,
               Eigen::VectorXd& step) const;
    bool solve(const OrbitEvaluation& at, const Eigen::MatrixXd& borders, const Eigen::VectorXd& right,
               bool homogeneous, Eigen::VectorXd& step) const {
        return solve(at, close(at, borders), right, homogeneous, step);
    }
    /// The minimum-norm step without free parameters, for equations that may be singular. @param deficiency number of
    /// directions that the equations leave undetermined; on entry a lower bound for it. @return false when a number is
    /// not finite
    bool solve_nearest(const OrbitEvaluation& at, Eigen::VectorXd& step, std::size_t& deficiency) const;
    /// Solves derivatives * step = change without free parameters. @param change of the equations, piece after piece,
    /// scaled. @return false when the matrix is singular
    bool respond(const OrbitEvaluation& at, const Eigen::VectorXd& change, Eigen::VectorXd& step) const;
    /// True when `chord` is available.
    bool has_chords() const { return layout_.inner() == 0 && !homoclinic_ && !cycle_; }
    /// True when an evaluation with derivatives costs much more than the flow alone, as with many states and
    /// parameters.
    bool derivatives_are_expensive() const { return layout_.states() + layout_.free() >= many_inputs; }
    /// Solves for a chord step (simplified Newton): residuals at other unknowns, derivatives of the evaluation. It
    /// needs the flow without derivatives only. @param right of the border equations. @return false when the equations
    /// are not defined there
    /// @param other flow of the same modes, without derivatives, to be used instead of that of the equations
    bool chord(const OrbitEvaluation& at, const Closed& closed, const Eigen::VectorXd& unknowns,
               const Eigen::VectorXd& right, Eigen::VectorXd& step, ModeFlow* other = nullptr);
    /// Computes a null vector of the derivatives that is orthogonal to the row, for one free parameter. At a branch
    /// point, with the tangent of one branch as the row, it is the direction of the other branch.
    bool null_vector(const OrbitEvaluation& at, const Eigen::RowVectorXd& row, Eigen::VectorXd& vector) const;

    /// Returns the gradient with respect to states and free parameters, from values in the order of
    /// System::with_gradient.
    Eigen::VectorXd gradient_of(std::span<const double> values) const { return ends_.gradient_of(values); }
    /// Returns the derivatives, with respect to all unknowns, of a function of states and free parameters at the end of
    /// a piece, before the jump. @param gradient of the function: states + free
    Eigen::RowVectorXd row_at_end(const OrbitEvaluation& at, std::size_t piece, const Eigen::VectorXd& gradient) const;
    /// Returns the derivatives of OrbitEvaluation::departure with respect to all unknowns.
    Eigen::RowVectorXd departure_row(const OrbitEvaluation& at) const;
    /// The ends of a homoclinic orbit; null for others.
    const HomoclinicEnds* homoclinic_ends() const { return homoclinic_ ? &*homoclinic_ : nullptr; }
    /// The ends of an orbit that is homoclinic to a cycle; null for others.
    const CycleEnds* cycle_ends() const { return cycle_ ? &*cycle_ : nullptr; }
    /// Returns the rate of the end condition of a segment along the flow at its end: minus the approach speed.
    double rate_at_end(const OrbitEvaluation& at, std::size_t segment) const;
    /// Returns the typical size of this rate: the change of the end condition over the scales of the states, divided by
    /// the scale of time.
    double typical_rate(const OrbitEvaluation& at, std::size_t segment) const;
    /// The same for the end of a piece that has an end condition.
    double typical_rate_of_piece(const OrbitEvaluation& at, std::size_t piece) const;
    /// True when other contacts of a chatter sequence should be resolved: the remaining ones are not slow enough to be
    /// summed, or the last ones are so slow that round-off moves them.
    bool contacts_need_renewal(const OrbitEvaluation& at) const;
    /// Returns the round-off of the durations of chatter sequences at an evaluation, in units of their scales;
    /// otherwise 0.
    double round_off(const OrbitEvaluation& at) const;
    /// True when a segment is a complete chatter sequence.
    bool has_chatter() const;
    /// The same for the function of another event.
    double typical_rate(const OrbitEvaluation& at, std::size_t segment, std::size_t event) const;
    /// The normal of the plane in which the segment after a cut starts; empty for other ends.
    const Eigen::VectorXd& cut_normal(std::size_t segment) const { return ends_.cut_normal(segment); }
    /// Returns the flow of the modes, with the parameters of the evaluation.
    ModeFlow& flow_at(const OrbitEvaluation& at);

protected:
    OrbitEquations(const Simulation& simulation, const Orbit& orbit, std::vector<ParameterId> free,
                   std::vector<double> ranges);
    /// Lays out the unknowns and chooses scales; must be called at the end of the constructor of a discretisation.
    /// @param counts number of pieces of each segment; @param inner number of inner unknowns of each piece
    void lay_out(const Orbit& orbit, const std::vector<std::size_t>& counts, std::size_t inner = 0);

    ModeFlow& flow() { return flow_; }
    SegmentEnds& ends() { return ends_; }
    OrbitScales& orbit_scales() { return orbit_scales_; }
    /// The contacts of a chatter sequence of the orbit with which the equations were made.
    const ChatterContacts& contacts(std::size_t segment) const { return contacts_[segment]; }

private:
    static constexpr std::size_t many_inputs = 12;

    void raise_above_round_off(const Eigen::VectorXd& unknowns, const std::vector<double>& parameters);

    /// Sets the end of a piece, its derivatives and the vector field there. @return false, with `at.problem` set, where
    /// the piece cannot be followed
    virtual bool follow(std::size_t piece, const Eigen::VectorXd& unknowns, OrbitEvaluation& at) = 0;
    /// Sets the inner unknowns of an orbit by its flow.
    virtual void set_inner(const Orbit&, Eigen::VectorXd&) {}

    void take_segments(const Eigen::VectorXd& unknowns, std::vector<std::vector<double>>& starts,
                       std::vector<double>& durations) const;
    double typical_change(const OrbitEvaluation& at, const Eigen::VectorXd& gradient) const;
    void set_parameters(const Eigen::VectorXd& unknowns, std::vector<double>& parameters);
    void follow_contacts(const Orbit& orbit);
    SegmentEnds::Passed passed_at(std::size_t piece) const;
    double duration_of_segment(const Eigen::VectorXd& unknowns, std::size_t segment) const;
    void set_contacts(const Orbit& orbit, std::size_t segment, Eigen::VectorXd& unknowns);
    Eigen::VectorXd extents(const Eigen::VectorXd& unknowns, std::vector<double>& parameters, std::vector<double>& end);
    void keep_distances(const Eigen::VectorXd& unknowns);
    bool accumulate(std::size_t k, const Eigen::VectorXd& unknowns, OrbitEvaluation& at);
    bool evaluate_piece(std::size_t k, const Eigen::VectorXd& unknowns, OrbitEvaluation& at);
    void assemble(const Eigen::VectorXd& unknowns, OrbitEvaluation& at);
    /// Returns the duration that a flight of a chatter sequence has in the orbit with which the equations were made.
    double first_duration(std::size_t flight) const;
    void assemble_end(std::size_t k, double duration, OrbitEvaluation& at) const;
    void assemble_accumulation(std::size_t k, OrbitEvaluation& at) const;
    void assemble_closure(std::size_t k, const Eigen::VectorXd& unknowns, OrbitEvaluation& at,
                          std::vector<bool>& neutral) const;
    void assemble_ends_at_saddle(const Eigen::VectorXd& unknowns, OrbitEvaluation& at) const;
    void assemble_ends_at_cycle(const Eigen::VectorXd& unknowns, OrbitEvaluation& at) const;
    void drop_accidentally_neutral(const OrbitEvaluation& at, std::vector<bool>& neutral);
    void close_with(std::size_t state, std::size_t drifting, OrbitEvaluation& at) const;
    void pin(const Eigen::VectorXd& unknowns, const std::vector<bool>& neutral, OrbitEvaluation& at) const;
    bool set_right(std::size_t k, const Eigen::VectorXd& unknowns, const OrbitEvaluation& at, Eigen::VectorXd& right,
                   ModeFlow& flow);
    Eigen::MatrixXd condensed(const OrbitEvaluation& at, const Eigen::MatrixXd& borders, Eigen::VectorXd& lack) const;
    Eigen::VectorXd expanded(const OrbitEvaluation& at, const Eigen::VectorXd& outer, bool homogeneous) const;
    void clear_vanishing_states(Eigen::VectorXd& unknowns) const;

    Simulation simulation_;
    SegmentEnds ends_;
    std::vector<std::size_t> modes_; ///< of the segments
    std::optional<HomoclinicEnds> homoclinic_;
    std::optional<CycleEnds> cycle_;
    ModeFlow flow_;
    OrbitLayout layout_;
    OrbitScales orbit_scales_;
    Eigen::VectorXd scales_;
    std::vector<std::optional<Accumulation>> accumulations_; ///< of the segments that are chatter sequences
    std::vector<ChatterContacts> contacts_;                  ///< of the same, when the equations were made
    std::string contacts_problem_;                           ///< why the contacts of the last orbit do not accumulate
    std::vector<double> fixed_durations_;                    ///< of the pieces
    std::vector<double> parameters_;                         ///< all parameters; those that are not free are constant
    std::vector<double> reference_;                          ///< state at which drifting and neutral states are held
};

} // namespace graze
