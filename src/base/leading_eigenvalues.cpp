#include "base/leading_eigenvalues.hpp"

#include "base/decompositions.hpp"
#include "base/random_number.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Dimension of the Krylov space in which the wanted eigenvalues must be found.
constexpr Eigen::Index most_vectors = 80;

/// A vector of which only this share is left beside others lies in their space, up to round-off.
constexpr double no_share = 1e-12;

/// Where the wanted eigenvalues begin, and the power of the matrix that separates them from the others: where many lie
/// closer to the unit circle, a higher power is needed.
struct Separation {
    int squarings;
    double least;
};
constexpr Separation separations[] = {{2, 0.95}, {4, 0.985}, {6, 0.996}};

/// Returns a vector whose direction is equally likely to be any.
Eigen::VectorXd random_direction(Eigen::Index size) {
    const auto component = [](Eigen::Index i) { return drawn_normal(0, static_cast<std::size_t>(i), 0); };
    return Eigen::VectorXd::NullaryExpr(size, component).normalized();
}

/// Removes from a vector its components along orthonormal columns; twice, because of round-off.
/// @return these components
template <class Columns>
Eigen::VectorXd take_out(const Columns& columns, Eigen::VectorXd& vector) {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(columns.cols());
    for (int repetition = 0; repetition < 2; ++repetition) {
        const Eigen::VectorXd along = columns.transpose() * vector;
        vector -= columns * along;
        result += along;
    }
    return result;
}

/// Returns a basis of the invariant subspace of the eigenvalues of a power whose magnitudes are at least `least`.
/// @return none where they are not found
std::optional<Eigen::MatrixXd> leading_space(const Eigen::MatrixXd& power, double least) {
    constexpr double converged = 1e-13;
    constexpr Eigen::Index examined_after = 16; // vectors
    const Eigen::Index n = power.rows();
    Eigen::MatrixXd vectors(n, most_vectors + 1), projected = Eigen::MatrixXd::Zero(most_vectors + 1, most_vectors);
    vectors.col(0) = random_direction(n);
    for (Eigen::Index m = 1; m <= most_vectors; ++m) {
        Eigen::VectorXd next = power * vectors.col(m - 1);
        const double whole = next.norm();
        projected.col(m - 1).head(m) = take_out(vectors.leftCols(m), next);
        const double left = next.norm() > no_share * whole ? next.norm() : 0;
        projected(m, m - 1) = left;
        if (!std::isfinite(whole))
            return std::nullopt;
        if (left > 0)
            vectors.col(m) = next / left;
        if (left > 0 && m % examined_after != 0)
            continue;
        const auto system = eigensystem(projected.topLeftCorner(m, m));
        if (!system)
            return std::nullopt;
        std::vector<Eigen::Index> wanted;
        bool found = true;
        for (Eigen::Index i = 0; i < m; ++i)
            if (std::abs(system->values[i]) >= least) {
                wanted.push_back(i);
                found = found && left * std::abs(system->vectors(m - 1, i)) < converged * std::abs(system->values[i]);
            }
        if (!found && left > 0)
            continue;
        if (!found)
            return std::nullopt;
        // Both of a conjugate pair have the same two real columns; one of them is enough.
        std::vector<Eigen::VectorXd> columns;
        for (const Eigen::Index i : wanted) {
            if (system->values[i].imag() < 0)
                continue;
            columns.emplace_back(vectors.leftCols(m) * system->vectors.col(i).real());
            if (system->values[i].imag() > 0)
                columns.emplace_back(vectors.leftCols(m) * system->vectors.col(i).imag());
        }
        Eigen::MatrixXd result(n, static_cast<Eigen::Index>(columns.size()));
        for (Eigen::Index i = 0; i < result.cols(); ++i)
            result.col(i) = columns[static_cast<std::size_t>(i)];
        return result.cols() > 0 ? orthogonal_factors(result).orthogonal : result;
    }
    return std::nullopt;
}

/// Returns a bound of the norm of a map's power, by Lanczos' method for the product of its transpose and itself.
/// @param space orthonormal columns, whose components are removed before and after each application
double norm_of_power(const Eigen::MatrixXd& map, const Eigen::MatrixXd& space, int power) {
    // With these steps the norm is more than twice the one found with a chance of 1.65 sqrt(n) exp(-sqrt(3/4) 31).
    constexpr int steps = 16;
    constexpr double most = 2;
    const Eigen::Index n = map.rows();
    Eigen::MatrixXd vectors(n, steps);
    Eigen::VectorXd next = random_direction(n);
    take_out(space, next);
    next.normalize();
    Eigen::MatrixXd projected = Eigen::MatrixXd::Zero(steps, steps);
    Eigen::Index size = 0;
    while (size < steps) {
        vectors.col(size) = next;
        for (int i = 0; i < power; ++i) {
            next = map * next;
            take_out(space, next);
        }
        for (int i = 0; i < power; ++i) {
            next = map.transpose() * next;
            take_out(space, next);
        }
        ++size;
        const double whole = next.norm();
        projected.col(size - 1).head(size) = take_out(vectors.leftCols(size), next);
        const double left = next.norm();
        if (!(left > no_share * whole) || size == steps)
            break;
        next /= left;
    }
    const Eigen::MatrixXd symmetric = projected.topLeftCorner(size, size).selfadjointView<Eigen::Upper>();
    const auto values = symmetric.allFinite() ? symmetric_eigenvalues(symmetric) : std::nullopt;
    return values ? most * std::sqrt(std::max(0.0, values->maxCoeff())) : std::numeric_limits<double>::infinity();
}

/// Returns the eigenvalues that belong to an invariant subspace; none when it is not invariant.
std::optional<std::vector<std::complex<double>>> values_in(const Eigen::MatrixXd& matrix, Eigen::MatrixXd& space) {
    constexpr double invariant = 1e-11; // relative to the matrix's effect on it
    std::vector<std::complex<double>> result;
    if (space.cols() == 0)
        return result;
    const Eigen::MatrixXd image = matrix * space, inside = space.transpose() * image;
    const auto values = eigenvalues(inside);
    if (!values || !((image - space * inside).norm() <= invariant * image.norm()))
        return std::nullopt;
    result.assign(values->begin(), values->end());
    std::ranges::stable_sort(result, [](auto a, auto b) { return std::abs(a) > std::abs(b); });
    return result;
}

} // namespace

std::optional<LeadingEigenvalues> leading_eigenvalues(const Eigen::MatrixXd& matrix) {
    constexpr int repetitions = 16; // of the power that is at hand, of which the norm is taken
    constexpr double closest = 0.999;
    if (matrix.rows() <= 2 * most_vectors)
        return std::nullopt;
    Eigen::MatrixXd power = matrix;
    int squared = 0;
    for (const Separation& here : separations) {
        for (; squared < here.squarings; ++squared)
            power = Eigen::MatrixXd(power * power);
        if (!power.allFinite())
            return std::nullopt;
        const double exponent = std::pow(2.0, squared);
        auto space = leading_space(power, std::pow(here.least, exponent));
        if (!space)
            continue;
        auto values = values_in(matrix, *space);
        if (!values)
            return std::nullopt;
        const double within = std::pow(norm_of_power(power, *space, repetitions), 1 / (exponent * repetitions));
        if (within < std::min(closest, values->empty() ? 1 : std::abs(values->back())))
            return LeadingEigenvalues{std::move(*values), within};
    }
    return std::nullopt;
}

} // namespace graze
