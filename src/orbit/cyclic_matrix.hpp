#pragma once

#include "orbit/cyclic_system.hpp"

#include <complex>

namespace graze {

/// The square matrix A of a cyclic system without its parameters, closed by x_m = factor * x_0. It is singular where
/// the factor is a multiplier of the orbit. The class computes left and right null vectors and solves bordered systems,
/// all in time proportional to the number of blocks: the transposed matrix is cyclic too, in reverse order.
///
/// Right vectors are (x_0, T_0, x_1, T_1, ...), left ones the rows of the blocks, one after another.
class CyclicMatrix {
public:
    /// @param rows, columns scaling factors of the rows and columns of the matrix
    CyclicMatrix(const CyclicSystem& system, double factor, const Eigen::VectorXd& rows,
                 const Eigen::VectorXd& columns);

    /// Computes left and right null vectors of unit length; for a nearly singular matrix, vectors whose images are
    /// nearly zero. @return false when a number is not finite
    bool null_vectors(Eigen::VectorXd& right, Eigen::VectorXd& left) const;
    /// Solves [A b; c^T 0] (right, value) = (0, 1) and [A^T c; b^T 0] (left, value) = (0, 1): the value is zero where A
    /// is singular (A. Griewank and G. W. Reddien, "Characterization and computation of generalized turning points",
    /// SIAM J. Numer. Anal. 21, 1984). @return false when the bordered matrix is singular too
    bool bordered(const Eigen::VectorXd& b, const Eigen::VectorXd& c, Eigen::VectorXd& right, Eigen::VectorXd& left,
                  double& value) const;

    /// left^T (dA / d factor) right, times the sign of the factor: zero where the factor is a multiple multiplier.
    double closing_product(const Eigen::VectorXd& left, const Eigen::VectorXd& right) const;

    /// Returns all finite multipliers. Like plane_near, for a matrix made with the factor 1.
    std::vector<std::complex<double>> multipliers() const;
    /// The invariant plane of two multipliers, a conjugate pair or both real: the 2 x 2 map with these eigenvalues and
    /// bases of the right and left planes, two columns each. A change dA of the matrix changes the map by -left^T dA
    /// right. The plane is smooth where the two multipliers become equal, also where they share one eigenvector.
    struct Plane {
        Eigen::Matrix2d map;
        Eigen::MatrixXd right, left;
    };
    /// Computes the plane of the two multipliers nearest to these numbers. @return false where other multipliers are as
    /// near, or the matrix is not finite
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
