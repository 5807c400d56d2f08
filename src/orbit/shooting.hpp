#pragma once

#include "graze/orbit/orbit.hpp"
#include "orbit/cyclic_system.hpp"
#include "orbit/orbit_flow.hpp"
#include "orbit/state_scales.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// Rates of end conditions below this share of their usual size are round-off.
inline constexpr double least_rate = 1e-11;

/// The equations of a periodic orbit, by multiple shooting: each piece of a segment flows from its start x_k for a time
/// T_k (whatever events it passes) onto the surface that ends it, and the jump takes it to the start of the next. Long
/// or expanding segments are split into several pieces, of which all but the last have a fixed duration.
///
/// Unknowns u are (x_0, T_0, x_1, T_1, ..., free parameters). Equations are as many as unknowns less the free
/// parameters. States in which the orbit is periodic up to translation (drifting), or which nothing ever changes (a
/// frame at rest), are held at their first values instead of being closed.
class Shooting {
public:
    /// @param simulation whose model the orbit belongs to
    /// @param free parameters that are unknown
    /// @param ranges in which they are looked at, where that is known; 0 where it is not
    Shooting(const Simulation& simulation, const Orbit& orbit, std::vector<std::size_t> free,
             std::vector<double> ranges = {});

    const Model& model() const { return simulation_.model(); }
    std::size_t states() const { return n_; }
    std::size_t pieces() const { return pieces_.size(); }
    const std::vector<std::size_t>& free() const { return free_; }
    std::size_t unknowns() const { return system_.unknowns(); }
    /// Where the start of a piece, its duration, and a free parameter are among the unknowns.
    std::size_t start_of(std::size_t piece) const { return piece * (n_ + 1); }
    std::size_t duration_of(std::size_t piece) const { return piece * (n_ + 1) + n_; }
    std::size_t place_of_parameter(std::size_t index) const { return pieces() * (n_ + 1) + index; }
    /// The last piece of a segment, which its event ends; the first one.
    std::size_t last_piece(std::size_t segment) const { return last_pieces_[segment]; }
    std::size_t first_piece(std::size_t segment) const { return segment == 0 ? 0 : last_pieces_[segment - 1] + 1; }

    Eigen::VectorXd unknowns_of(const Orbit& orbit);
    Orbit orbit_of(const Eigen::VectorXd& unknowns) const;
    /// Sizes of the unknowns, by which residuals and steps are measured: extents of the states along the orbit, the
    /// period, the parameters. Those of the parameters never shrink, those of the states only so far. A parameter that
    /// is small or zero is measured by what it does to the orbit.
    const Eigen::VectorXd& scales() const { return scales_; }
    void set_scales(const Eigen::VectorXd& unknowns);

    /// Evaluates the equations and their derivatives. @return false where that is impossible: `problem` says why
    bool evaluate(const Eigen::VectorXd& unknowns);
    const std::string& problem() const { return problem_; }
    /// Whether that was because a segment takes too many steps: not to be tried too often.
    bool took_too_long() const { return took_too_long_; }
    /// Largest residual, in units of the scales.
    double residual() const { return residual_; }
    /// Solves derivatives * step = -equations (or 0), borders * step = right. See CyclicSystem.
    bool solve(const Eigen::MatrixXd& borders, const Eigen::VectorXd& right, bool homogeneous, Eigen::VectorXd& step,
               double* determinant = nullptr) const;
    const CyclicSystem& system() const { return system_; }
    /// A vector that the derivatives map to (nearly) zero and whose product with the row is zero: where the equations
    /// are singular beyond their one branch, the direction of another. For one free parameter, after `evaluate`.
    bool null_vector(const Eigen::RowVectorXd& row, Eigen::VectorXd& vector) const;
    /// Of values as System::with_gradient gives them the gradient with respect to states and free parameters.
    Eigen::VectorXd gradient_of(std::span<const double> values) const;

    /// What `evaluate` has found for a piece.
    struct Piece {
        std::size_t segment = 0;
        bool last = true;           ///< ends with the segment's event or section
        double fixed_duration = 0;  ///< of all others
        std::vector<double> end;    ///< state at its end, before the jump
        std::vector<double> after;  ///< and after
        Eigen::MatrixXd flow;       ///< derivatives of `end`, states x (states + free)
        Eigen::VectorXd field;      ///< rates at its end
        Eigen::MatrixXd jump;       ///< derivatives of `after`, states x (states + free)
        Eigen::VectorXd condition;  ///< gradient of the end condition: states + free
        double condition_value = 0; ///< zero on the orbit
    };
    const Piece& piece(std::size_t k) const { return pieces_[k]; }
    const std::vector<double>& parameters() const { return parameters_; }
    const std::vector<double>& periods() const { return periods_; }
    /// Derivatives of a function of states and free parameters at the end of a piece, before the jump, with respect to
    /// all unknowns. @param gradient states + free
    Eigen::RowVectorXd row_at_end(std::size_t piece, const Eigen::VectorXd& gradient) const;
    /// The rate at which the end condition of a segment changes along the flow at its end: the negative approach speed.
    double rate_at_end(std::size_t segment) const;
    /// Size of such rates: how much the end condition changes along the scales of the states, in the time of the orbit.
    double usual_rate(std::size_t segment) const;
    /// States that are neither drifting nor unchanged by everything.
    const std::vector<std::size_t>& active() const { return active_; }
    ModeFlow& flow() { return flow_; }
    const Simulation& simulation() const { return simulation_; }
    const Signature& signature() const { return signature_; }
    std::optional<std::size_t> symmetry() const { return symmetry_; }

private:
    struct EndFunction {
        const Function* value = nullptr; ///< and its gradient, of the system
        bool cyclic = false;             ///< a phase section: holds up to whole periods of `state`
        std::size_t state = 0;
    };
    void choose_ends();
    void split(const Orbit& orbit);
    bool follow(std::size_t mode, std::span<double> state, double duration, Eigen::MatrixXd& derivatives);
    bool evaluate_piece(std::size_t k, const Eigen::VectorXd& unknowns);
    bool pass_end(std::size_t k);
    void assemble(const Eigen::VectorXd& unknowns);
    void pin(const Eigen::VectorXd& unknowns);
    void set_parameters(const Eigen::VectorXd& unknowns);
    double parameter_scale(std::size_t f, double value);
    void clear_remnants(Eigen::VectorXd& unknowns) const;

    Simulation simulation_;
    Signature signature_;
    std::optional<std::size_t> symmetry_;
    std::vector<std::size_t> free_;
    std::size_t n_;
    ModeFlow flow_;
    CyclicSystem system_;
    std::vector<EndFunction> ends_;
    std::vector<Piece> pieces_;
    std::vector<std::size_t> last_pieces_;
    std::vector<double> parameters_, periods_, inputs_, work_, values_, reference_;
    Eigen::MatrixXd period_rates_; ///< states x free
    Eigen::MatrixXd coupling_;     ///< greatest derivatives of states with respect to earlier ones
    StateScales state_scales_;
    Eigen::VectorXd scales_;
    std::vector<double> largest_parameters_; ///< of the free ones, since the beginning
    std::vector<double> ranges_;             ///< of the free ones, 0 where not known
    std::vector<double> effects_;            ///< of the free ones on the equations, in units of the states' scales
    std::vector<bool> neutral_;              ///< states that every piece leaves exactly as they are
    std::vector<std::size_t> active_;
    Eigen::VectorXd evaluated_; ///< where the equations have been evaluated last; empty: nowhere
    double residual_ = 0;
    std::string problem_;
    bool took_too_long_ = false;
};

} // namespace graze
