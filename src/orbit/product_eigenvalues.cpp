#include "orbit/product_eigenvalues.hpp"

#include "base/decompositions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// Enough to separate eigenvalues whose moduli differ by a factor of six.
constexpr int sweeps = 16;
constexpr double coupling_tolerance = 1e-13;
/// Diagonal elements below this share of the factor's norm count as zero: the factor is singular, as the jump that sets
/// a velocity to zero.
constexpr double round_off = 4e-16;

} // namespace

std::vector<std::complex<double>> product_eigenvalues(const std::vector<Eigen::MatrixXd>& factors) {
    std::vector<std::complex<double>> result;
    if (factors.empty() || factors.front().rows() == 0)
        return result;
    const Eigen::Index n = factors.front().rows();
    Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(n, n), before = basis;
    std::vector<Eigen::MatrixXd> triangles(factors.size());
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        before = basis;
        for (std::size_t k = 0; k < factors.size(); ++k) {
            OrthogonalFactors image = orthogonal_factors(factors[k] * basis);
            triangles[k] = std::move(image.triangle);
            basis = std::move(image.orthogonal);
        }
    }
    // In the basis before the last sweep the product is turn * (product of triangles).
    const Eigen::MatrixXd turn = before.transpose() * basis;
    for (Eigen::Index begin = 0; begin < n;) {
        Eigen::Index end = begin + 1;
        while (end < n && turn.block(end, begin, n - end, end - begin).norm() > coupling_tolerance)
            ++end;
        const Eigen::Index size = end - begin;
        Eigen::MatrixXd block = Eigen::MatrixXd::Identity(size, size);
        double exponent = 0;
        bool vanishes = false;
        for (const Eigen::MatrixXd& triangle : triangles) {
            vanishes = vanishes || (size == 1 && std::abs(triangle(begin, begin)) <=
                                                     round_off * static_cast<double>(n) * triangle.norm());
            block = triangle.block(begin, begin, size, size) * block;
            const double norm = block.norm();
            if (norm > 0 && std::isfinite(norm)) {
                block /= norm;
                exponent += std::log(norm);
            }
        }
        block = turn.block(begin, begin, size, size) * block;
        const double factor = vanishes ? 0 : std::exp(exponent);
        if (!block.allFinite() || !std::isfinite(factor)) {
            result.insert(result.end(), static_cast<std::size_t>(size), std::numeric_limits<double>::infinity());
        } else {
            const auto values = eigenvalues(block);
            if (!values)
                return {};
            for (Eigen::Index i = 0; i < size; ++i)
                result.push_back((*values)[i] * factor);
        }
        begin = end;
    }
    std::ranges::stable_sort(result, [](auto a, auto b) { return std::abs(a) > std::abs(b); });
    return result;
}

} // namespace graze
