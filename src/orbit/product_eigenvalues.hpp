#pragma once

#include <Eigen/Core>

#include <complex>
#include <vector>

namespace graze {

/// Returns the eigenvalues of a product of square matrices, last factor times ... times first, largest first, without
/// forming the product: orthogonal iteration through the factors (the unshifted form of the periodic QR algorithm: A.
/// Bojanczyk, G. Golub, P. Van Dooren, "The periodic Schur decomposition", Proc. SPIE 1770, 1992) separates eigenvalues
/// of different magnitude. Each is as accurate as the factors allow, however many powers of ten lie between them. Empty
/// where the eigenvalues of a block cannot be computed.
std::vector<std::complex<double>> product_eigenvalues(const std::vector<Eigen::MatrixXd>& factors);

} // namespace graze
