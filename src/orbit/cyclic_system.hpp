#pragma once

#include "base/linear_systems.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <utility>
#include <vector>

namespace graze {

/// The linear equations of multiple shooting: for each of m segments its start x_k (n numbers) and duration T_k, and q
/// parameters p that all share,
///
///     own_k (x_k, T_k) + next_k x_{k+1} + parameters_k p = right_k     (n + 1 equations; x_m = x_0),
///
/// closed by q further equations in all unknowns. Starts are eliminated one after another by orthogonal transformations
/// (S. J. Wright, "Stable parallel algorithms for two-point boundary value problems", SIAM J. Sci. Stat. Comput. 13,
/// 1992), which stays accurate however much arcs expand and costs in proportion to m.
class CyclicSystem {
public:
    struct Block {
        Eigen::MatrixXd own;        ///< (n + 1) x (n + 1); row 0 is the end condition
        Eigen::MatrixXd next;       ///< (n + 1) x n
        Eigen::MatrixXd parameters; ///< (n + 1) x q
        Eigen::VectorXd right;      ///< n + 1
    };

    CyclicSystem(std::size_t states, std::size_t parameters);

    /// Keeps the memory of blocks that exist already.
    void resize(std::size_t segments);
    std::size_t segments() const { return count_; }
    std::size_t unknowns() const { return count_ * (n_ + 1) + q_; }
    Block& block(std::size_t k) { return blocks_[k]; }
    const Block& block(std::size_t k) const { return blocks_[k]; }

    /// Factors the blocks, but for their right-hand sides. @return false when a number is not finite
    bool factor();
    /// Determinants of the system without parameters, up to a positive factor that does not vanish where the system
    /// is regular for some closure: of the periodic one, zero where a multiplier is 1, and of that with x_m = -x_0,
    /// zero where one is -1. To be called after `factor`, like all below.
    double periodic_determinant() const;
    double antiperiodic_determinant() const;
    /// Values of these below which their signs are round-off.
    double periodic_noise() const;
    double antiperiodic_noise() const;

    /// The system closed by q further equations, factored: for as many right-hand sides as one likes. Unknowns are
    /// (x_0, T_0, x_1, T_1, ..., p). A value of its own, but it is solved with the system that it was made from.
    class Closed {
    public:
        /// False when the whole is singular to working precision.
        bool is_regular() const { return regular_; }
        /// Of the whole, up to the same factor as those of the system.
        double determinant() const { return determinant_; }

    private:
        friend class CyclicSystem;
        FullLU<double> lu_;
        std::vector<Eigen::MatrixXd> shares_; ///< of each segment's equations in the further ones; empty: none
        bool regular_ = false;
        double determinant_ = 0;
    };
    /// @param borders q x unknowns()
    Closed close(const Eigen::MatrixXd& borders) const;
    /// @param blocks right-hand sides of all blocks, one after another; null: zero. @param right of the further
    /// equations
    /// @return false when the system is singular
    bool solve(const Closed& closed, const Eigen::VectorXd* blocks, const Eigen::VectorXd& right,
               Eigen::VectorXd& solution) const;
    /// The same without further equations, for systems without parameters: the solution of least first start, in all
    /// directions but those that the equations hardly determine, whose equations are left out.
    /// @param lost how many these are; given, how many they are at least
    bool solve_nearest(const Eigen::VectorXd& blocks, Eigen::VectorXd& solution, std::size_t& lost) const;
    /// How many directions of the first start the equations hardly determine, beyond one for each parameter.
    std::size_t undetermined() const;
    /// The blocks' own.
    Eigen::VectorXd right_hand_sides() const;
    /// The vector that the blocks and the further equations' left-hand sides take nearest to zero, of any length: where
    /// they are singular, in the null space. @return false when a number is not finite
    bool null_vector(const Eigen::MatrixXd& borders, Eigen::VectorXd& vector) const;

    /// What is left of the homogeneous equations without parameters: first * x_0 + last * x_m = 0. To be called after
    /// `factor`, like those above.
    std::pair<Eigen::MatrixXd, Eigen::MatrixXd> relation() const;
    /// Starts and durations between such x_0 and x_m: (x_0, T_0, x_1, ..., T_{m-1}).
    Eigen::VectorXd between(const Eigen::VectorXd& first, const Eigen::VectorXd& last) const;

private:
    double noise(double closing) const;
    Eigen::VectorXd reduced(const Eigen::VectorXd& blocks, std::vector<Eigen::VectorXd>& constants) const;
    Eigen::MatrixXd condense(const Eigen::MatrixXd& borders, std::vector<Eigen::MatrixXd>& shares) const;
    Eigen::VectorXd expand(const Eigen::VectorXd& first, const Eigen::VectorXd& last,
                           const std::vector<Eigen::VectorXd>& constants) const;

    /// What is left of a segment: triangle (x_k, T_k) + rest (x_0, x_{k+1}, p) = a constant; and by which reflections
    /// it came to that, for the constant.
    struct Eliminated {
        Eigen::MatrixXd triangle, rest;
        Eigen::MatrixXd mirrors; ///< columns; of zero length where there is nothing to reflect
    };
    std::size_t n_, q_, count_ = 0;
    std::vector<Block> blocks_;
    std::vector<Eliminated> eliminated_;
    Eigen::MatrixXd stack_, right_, final_; ///< final_: n x (n of x_0, n of x_m, q)
    double sign_ = 1;
};

} // namespace graze
