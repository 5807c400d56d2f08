#include "branch/equilibrium_normal_form.hpp"

#include "base/decompositions.hpp"
#include "base/linear_systems.hpp"
#include "base/special_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

using Complex = std::complex<double>;

/// The second derivative of the field along two complex directions.
Eigen::VectorXcd bilinear(const EquilibriumEvaluation& at, const Eigen::VectorXcd& one, const Eigen::VectorXcd& other) {
    const Eigen::Index n = at.size();
    const Eigen::MatrixXd real = at.second(one.real()).leftCols(n), imaginary = at.second(one.imag()).leftCols(n);
    return real * other + Complex(0, 1) * (imaginary * other);
}

/// The null vector of a complex matrix, right or left: the last singular vector.
Eigen::VectorXcd eigenvector(const Eigen::MatrixXd& field, Complex eigenvalue) {
    const Eigen::Index n = field.rows();
    return null_vector(Eigen::MatrixXcd(field.cast<Complex>() - eigenvalue * Eigen::MatrixXcd::Identity(n, n)));
}

} // namespace

std::optional<HopfForm> hopf_form(const EquilibriumEvaluation& at, const EquilibriumThirdDerivatives& third,
                                  double product) {
    const Eigen::Index n = at.size();
    const auto pair = eigenvalue_pair(at.field, product);
    if (!pair || !(pair->product > 0.25 * pair->sum * pair->sum))
        return std::nullopt;
    HopfForm form;
    form.frequency = std::sqrt(pair->product);
    const Complex i(0, 1), eigenvalue(0.5 * pair->sum, std::sqrt(pair->product - 0.25 * pair->sum * pair->sum));
    form.vector = eigenvector(at.field, eigenvalue);
    // The adjoint vector: left^H field = eigenvalue left^H, left^H vector = 1.
    Eigen::VectorXcd left = eigenvector(at.field.transpose(), std::conj(eigenvalue));
    const Complex overlap = left.dot(form.vector); // conjugates the first factor
    if (!(std::abs(overlap) > 0))
        return std::nullopt;
    left /= std::conj(overlap);
    const Eigen::VectorXcd& q = form.vector;
    const FullLU<double> real(at.field);
    if (!real.is_invertible())
        return std::nullopt;
    form.mean = real.solve(-bilinear(at, q, q.conjugate()).real());
    const ComplexLU turning(
        Eigen::MatrixXcd(2.0 * i * form.frequency * Eigen::MatrixXcd::Identity(n, n) - at.field.cast<Complex>()));
    form.second = turning.solve(bilinear(at, q, q));
    const Eigen::VectorXd sizes = at.scales.head(n);
    const auto cubic = [&](const Eigen::VectorXd& one) {
        return Eigen::MatrixXd(sizes.cwiseInverse().asDiagonal() *
                               third(at.state, at.parameters, one.cwiseProduct(sizes), one.cwiseProduct(sizes)) *
                               sizes.asDiagonal());
    };
    const Eigen::VectorXcd parts[] = {(cubic(q.real()) + cubic(q.imag())) * q,
                                      2.0 * bilinear(at, q, form.mean.cast<Complex>()),
                                      bilinear(at, q.conjugate(), form.second)};
    double largest = 0;
    for (const Eigen::VectorXcd& part : parts) {
        form.coefficient += 0.5 * left.dot(part);
        largest = std::max(largest, left.cwiseAbs().dot(part.cwiseAbs()));
    }
    const double per_unit = 1 / (form.frequency * q.cwiseProduct(sizes.cast<Complex>()).squaredNorm());
    form.lyapunov = form.coefficient.real() * per_unit;
    form.uncertainty = 1e-9 * largest * per_unit;
    form.state_rate = real.solve(-at.jacobian.col(n));
    // The eigenvalue along the branch: by the parameter, and by the states that move with it.
    Eigen::VectorXd along = Eigen::VectorXd::Zero(at.scales.size());
    along.head(n) = form.state_rate;
    along[n] = 1;
    const Eigen::VectorXcd change = at.second(q.real()) * along + i * Eigen::VectorXcd(at.second(q.imag()) * along);
    form.eigenvalue_rate = left.dot(change);
    return form;
}

std::string in_words(const HopfForm& form, std::size_t other_unstable) {
    if (!(std::abs(form.lyapunov) > form.uncertainty))
        return "first Lyapunov coefficient 0 up to round-off: its sign is not known";
    const bool below = form.lyapunov < 0;
    return fmt::format("first Lyapunov coefficient {:.10g}: {} cycles begin ({})", form.lyapunov,
                       below && other_unstable == 0 ? "stable" : "unstable", below ? "supercritical" : "subcritical");
}

} // namespace graze
