#pragma once

#include <Eigen/Core>

#include <complex>
#include <vector>

namespace graze {

/// Eigenvalues of a product of square matrices, last one times ... times first one, largest first, without multiplying
/// them out: orthogonal iteration through the factors (the unshifted form of the periodic QR algorithm: A. Bojanczyk,
/// G. Golub, P. Van Dooren, "The periodic Schur decomposition", Proc. SPIE 1770, 1992) separates eigenvalues of
/// different magnitude, each of which is then as accurate as the factors allow, however many powers of ten lie between
/// them. @return none where the eigenvalues of a block cannot be found
std::vector<std::complex<double>> product_eigenvalues(const std::vector<Eigen::MatrixXd>& factors);

} // namespace graze
