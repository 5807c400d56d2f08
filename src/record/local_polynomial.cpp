#include "record/local_polynomial.hpp"

#include "base/decompositions.hpp"

#include <Eigen/Core>

namespace graze {

LocalPolynomial::LocalPolynomial(std::span<const double> places, std::size_t degree) : places_(places.size()) {
    const auto rows = static_cast<Eigen::Index>(places.size()), columns = static_cast<Eigen::Index>(degree) + 1;
    Eigen::MatrixXd powers(rows, columns);
    for (Eigen::Index i = 0; i < rows; ++i) {
        double power = 1;
        for (Eigen::Index k = 0; k < columns; ++k, power *= places[static_cast<std::size_t>(i)])
            powers(i, k) = power;
    }
    const auto [basis, triangle] = orthogonal_factors(powers);
    const Eigen::MatrixXd inverse =
        triangle.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(columns, columns));
    basis_.assign(basis.data(), basis.data() + basis.size());
    inverse_.assign(inverse.data(), inverse.data() + inverse.size());
    for (Eigen::Index k = 0; k < columns; ++k) {
        at_zero_.push_back(inverse(0, k));
        slope_.push_back(columns > 1 ? inverse(1, k) : 0);
    }
}

std::vector<double> LocalPolynomial::powers(const double* samples) const {
    const std::size_t count = degree() + 1;
    std::vector<double> result(count, 0.0);
    for (std::size_t k = 0; k < count; ++k) {
        const double factor = coefficient(k, samples);
        for (std::size_t power = 0; power <= k; ++power)
            result[power] += factor * inverse_[k * count + power];
    }
    return result;
}

} // namespace graze
