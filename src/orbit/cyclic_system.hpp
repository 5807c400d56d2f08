#pragma once

#include "base/linear_systems.hpp"
#include "orbit/eigen_index.hpp"

#include <utility>
#include <vector>

namespace graze {

/// The linear equations of multiple shooting: the unknowns are for each of m segments its start x_k (n numbers) and
/// duration T_k, and q shared parameters p,
///
///     own_k (x_k, T_k) + next_k x_{k+1} + parameters_k p = right_k     (n + 1 equations; x_m = x_0),
///
/// closed by q border equations in all unknowns. Starts are eliminated one after another by orthogonal transformations
/// (S. J. Wright, "Stable parallel algorithms for two-point boundary value problems", SIAM J. Sci. Stat. Comput. 13,
/// 1992), which is stable however much arcs expand; the cost is proportional to m. With many states the first start is
/// not eliminated: it stays an unknown of the condensed equations in any case, and the cost of a single segment falls
/// from the cube of n to the square.
class CyclicSystem {
public:
    struct Block {
        Eigen::MatrixXd own;        ///< (n + 1) x (n + 1); row 0 is the end condition
        Eigen::MatrixXd next;       ///< (n + 1) x n
        Eigen::MatrixXd parameters; ///< (n + 1) x q
        Eigen::VectorXd right;      ///< n + 1
    };

    CyclicSystem(std::size_t states, std::size_t parameters);

    /// Sets the number of segments; keeps the memory of existing blocks.
    void resize(std::size_t segments);
    std::size_t segments() const { return count_; }
    std::size_t unknowns() const { return count_ * (n_ + 1) + q_; }
    Block& block(std::size_t k) { return blocks_[k]; }
    const Block& block(std::size_t k) const { return blocks_[k]; }

    /// Factors the blocks without their right-hand sides. @return false when a number is not finite
    bool factor();
    /// A determinant of the system without parameters, up to a positive factor.
    struct Determinant {
        double value = 0;
        double noise = 0; ///< magnitude below which the sign is round-off: its order, estimated
    };
    /// Of the periodic closure x_m = x_0, zero where a multiplier is 1. Requires `factor`, like all functions below.
    Determinant periodic_determinant() const { return determinant_closed_by(1); }
    /// Of the antiperiodic closure x_m = -x_0, zero where a multiplier is -1.
    Determinant antiperiodic_determinant() const { return determinant_closed_by(-1); }

    /// The factored system with its q border equations, which serves any number of right-hand sides. Unknowns are (x_0,
    /// T_0, x_1, T_1, ..., p). It can be copied, but must be used with the system that made it.
    class Closed {
    public:
        /// False when the bordered system is singular to working precision.
        bool is_regular() const { return regular_; }
        /// Determinant of the bordered system, up to the same factor as those of the system.
        double determinant() const { return determinant_; }

    private:
        friend class CyclicSystem;
        CheckedLU lu_;
        /// Per segment: coefficients by which its equations enter the borders; empty: zero.
        std::vector<Eigen::MatrixXd> shares_;
        bool regular_ = false;
        double determinant_ = 0;
    };
    /// @param borders q x unknowns()
    Closed close(const Eigen::MatrixXd& borders) const;
    /// @param blocks right-hand sides of all blocks, one after another; null: zero. @param right those of the border
    /// equations
    /// @return false when the system is singular
    bool solve(const Closed& closed, const Eigen::VectorXd* blocks, const Eigen::VectorXd& right,
               Eigen::VectorXd& solution) const;
    /// For systems without parameters and borders: the solution with the smallest x_0. Directions of x_0 that the
    /// equations hardly determine (small singular values) stay zero.
    /// @param deficiency number of undetermined directions; on entry a lower bound for it
    bool solve_nearest(const Eigen::VectorXd& blocks, Eigen::VectorXd& solution, std::size_t& deficiency) const;
    /// Returns the number of directions of x_0 that the equations hardly determine, beyond one for each parameter.
    std::size_t undetermined() const;
    /// Returns the right-hand sides of all blocks, one after another.
    Eigen::VectorXd right_hand_sides() const;
    /// Computes a vector in the null space of blocks and borders, of any length; where they are not singular, the right
    /// singular vector of the smallest singular value. @return false when a number is not finite
    bool null_vector(const Eigen::MatrixXd& borders, Eigen::VectorXd& vector) const;

    /// Returns the matrices (first, last) of the condensed homogeneous equations without parameters: first * x_0 + last
    /// * x_m = 0.
    std::pair<Eigen::MatrixXd, Eigen::MatrixXd> relation() const;
    /// Returns starts and durations between x_0 and x_m that satisfy this relation: (x_0, T_0, x_1, ..., T_{m-1}).
    Eigen::VectorXd between(const Eigen::VectorXd& first, const Eigen::VectorXd& last) const;

private:
    bool keeps_first_start() const;
    bool eliminate_first_duration();
    Determinant determinant_closed_by(double closing) const;
    Eigen::VectorXd reduced(const Eigen::VectorXd& blocks, std::vector<Eigen::VectorXd>& constants) const;
    Eigen::MatrixXd condense(const Eigen::MatrixXd& borders, std::vector<Eigen::MatrixXd>& shares) const;
    Eigen::VectorXd expand(const Eigen::VectorXd& first, const Eigen::VectorXd& last,
                           const std::vector<Eigen::VectorXd>& constants) const;

    /// Eliminated equations of a segment: triangle (x_k, T_k) + rest (x_0, x_{k+1}, p) = constant; the reflections that
    /// produced them are kept for the constants of other right-hand sides. Where the first start is kept, only T_0 of
    /// the first segment is eliminated.
    struct Eliminated {
        Eigen::MatrixXd triangle, rest;
        Eigen::MatrixXd mirrors; ///< reflection vectors in columns; zero where no reflection was needed
    };
    std::size_t n_, q_, count_ = 0;
    std::vector<Block> blocks_;
    std::vector<Eliminated> eliminated_;
    Eigen::MatrixXd stack_, right_, final_; ///< final_: n x (n of x_0, n of x_m, q)
    double sign_ = 1;
};

} // namespace graze
