#pragma once

#include "orbit/cyclic_system.hpp"

#include <Eigen/Core>

#include <complex>
#include <vector>

namespace graze {

/// The square matrix A of a cyclic system without its parameters, closed by a factor: x_m = factor * x_0. It is
/// singular where the factor is a multiplier of the orbit. Vectors that it takes to nearly nothing, and systems
/// bordered by such, from the right and from the left; the transposed matrix is cyclic too, in reverse order.
///
/// Right vectors are (x_0, T_0, x_1, T_1, ...), left ones the rows of the blocks, one after another.
class CyclicMatrix {
public:
    /// @param rows, columns by which rows and columns of the matrix are multiplied
    CyclicMatrix(const CyclicSystem& system, double factor, const Eigen::VectorXd& rows,
                 const Eigen::VectorXd& columns);

    /// Vectors of unit length that the matrix takes nearest to zero, up to their closing.
    bool null_vectors(Eigen::VectorXd& right, Eigen::VectorXd& left) const;
    /// Solves [A b; c^T 0] (right, value) = (0, 1) and [A^T c; b^T 0] (left, value) = (0, 1): the value is zero where A
    /// is singular (A. Griewank and G. W. Reddien, "Characterization and computation of generalized turning points",
    /// SIAM J. Numer. Anal. 21, 1984). @return false when that is singular too
    bool bordered(const Eigen::VectorXd& b, const Eigen::VectorXd& c, Eigen::VectorXd& right, Eigen::VectorXd& left,
                  double& value) const;

    /// left^T (dA / d factor) right, times the factor's sign: zero where a multiplier that is the factor is not simple.
    double closing_product(const Eigen::VectorXd& left, const Eigen::VectorXd& right) const;

    /// All that are finite. For a matrix that was made with the factor 1, as below.
    std::vector<std::complex<double>> multipliers() const;
    /// What two multipliers that belong together, conjugate or real, make of the plane that belongs to both: a map with
    /// these eigenvalues, and the planes from the right and from the left, two columns each. A change dA of the matrix
    /// changes the map by -left^T dA right. All is smooth where the two become equal, also where only one vector is
    /// left.
    struct Plane {
        Eigen::Matrix2d map;
        Eigen::MatrixXd right, left;
    };
    /// Of the two nearest to these numbers. @return false where others are as near, or the matrix is not finite
    bool plane_near(std::complex<double> one, std::complex<double> other, Plane& result) const;

private:
    CyclicSystem direct(const Eigen::VectorXd& column) const;
    CyclicSystem transposed(const Eigen::VectorXd& column) const;
    Eigen::VectorXd reversed(const Eigen::VectorXd& left) const;
    Eigen::VectorXd restored(const Eigen::VectorXd& reversed) const;

    Eigen::Index n_, count_;
    std::vector<Eigen::MatrixXd> own_, next_; ///< of each block
};

} // namespace graze
