#pragma once

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

    /// @return false when a number is not finite
    bool factor();
    /// Determinants of the system without parameters, up to a positive factor that does not vanish where the system
    /// is regular for some closure: of the periodic one, zero where a multiplier is 1, and of that with x_m = -x_0,
    /// zero where one is -1. To be called after `factor`.
    double periodic_determinant() const;
    double antiperiodic_determinant() const;
    /// Value of the periodic one below which its sign is round-off.
    double periodic_noise() const;

    /// Solves with q further equations. Unknowns are (x_0, T_0, x_1, T_1, ..., p).
    /// @param borders q x unknowns(); @param right of them
    /// @param homogeneous the blocks' right-hand sides are taken to be zero
    /// @param determinant if not null: that of the whole, up to the same factor as above
    /// @return false when the system is singular to working precision
    bool solve(const Eigen::MatrixXd& borders, const Eigen::VectorXd& right, bool homogeneous,
               Eigen::VectorXd& solution, double* determinant = nullptr) const;
    /// The vector that the blocks and the further equations' left-hand sides take nearest to zero, of any length: where
    /// they are singular, in the null space. @return false when a number is not finite
    bool null_vector(const Eigen::MatrixXd& borders, Eigen::VectorXd& vector) const;

    /// What is left of the homogeneous equations without parameters: first * x_0 + last * x_m = 0. To be called after
    /// `factor`, like those above.
    std::pair<Eigen::MatrixXd, Eigen::MatrixXd> relation() const;
    /// Starts and durations between such x_0 and x_m: (x_0, T_0, x_1, ..., T_{m-1}).
    Eigen::VectorXd between(const Eigen::VectorXd& first, const Eigen::VectorXd& last) const;

private:
    /// Equations of x_0 and p alone: matrix (x_0, p) = values.
    struct Condensed {
        Eigen::MatrixXd matrix;
        Eigen::VectorXd values;
    };
    Condensed condense(const Eigen::MatrixXd& borders, const Eigen::VectorXd& right, bool homogeneous) const;
    Eigen::VectorXd expand(const Eigen::VectorXd& first, const Eigen::VectorXd& last, bool homogeneous) const;

    /// What is left of a segment: triangle (x_k, T_k) + rest (x_0, x_{k+1}, p) = rest's last column.
    struct Eliminated {
        Eigen::MatrixXd triangle, rest;
    };
    std::size_t n_, q_, count_ = 0;
    std::vector<Block> blocks_;
    std::vector<Eliminated> eliminated_;
    Eigen::MatrixXd stack_, right_, final_; ///< final_: n x (n of x_0, n of x_m, q, 1)
    double sign_ = 1;
};

} // namespace graze
