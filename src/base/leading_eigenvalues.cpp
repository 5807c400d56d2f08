#include "base/leading_eigenvalues.hpp"

#include "base/decompositions.hpp"
#include "base/random_number.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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

/// A power of a matrix, whose exponent is a power of two.
class Power : public LinearMap {
public:
    explicit Power(Eigen::MatrixXd matrix) : matrix_(std::move(matrix)) {}
    explicit Power(const LinearMap& map) : map_(&map) {}
    Eigen::Index size() const override { return map_ ? map_->size() : matrix_.rows(); }
    Eigen::VectorXd times(const Eigen::VectorXd& vector) const override {
        if (!map_)
            return matrix_ * vector;
        return repeated(vector, [this](const Eigen::VectorXd& one) { return map_->times(one); });
    }
    Eigen::VectorXd transposed_times(const Eigen::VectorXd& vector) const override {
        if (!map_)
            return matrix_.transpose() * vector;
        return repeated(vector, [this](const Eigen::VectorXd& one) { return map_->transposed_times(one); });
    }
    /// Squares the power until it has been squared that many times. @return false when a number is not finite
    bool square_to(int squarings) {
        constexpr int most_applied = 2; // squarings up to which the map is applied several times instead
        if (map_ && squarings <= most_applied) {
            squared_ = squarings;
            return true;
        }
        if (map_) {
            matrix_.resize(size(), size());
            for (Eigen::Index i = 0; i < matrix_.cols(); ++i)
                matrix_.col(i) = times(Eigen::VectorXd::Unit(matrix_.rows(), i));
            map_ = nullptr;
        }
        for (; squared_ < squarings; ++squared_)
            matrix_ = Eigen::MatrixXd(matrix_ * matrix_);
        return matrix_.allFinite();
    }

private:
    Eigen::VectorXd repeated(Eigen::VectorXd vector, const auto& apply) const {
        for (int i = 0; i < 1 << squared_; ++i)
            vector = apply(vector);
        return vector;
    }
    const LinearMap* map_ = nullptr; ///< null where the power itself is at hand
    Eigen::MatrixXd matrix_;
    int squared_ = 0;
};

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
std::optional<Eigen::MatrixXd> leading_space(const LinearMap& power, double least) {
    constexpr double converged = 1e-13;
    constexpr Eigen::Index examined_after = 16; // vectors
    const Eigen::Index n = power.size();
    Eigen::MatrixXd vectors(n, most_vectors + 1), projected = Eigen::MatrixXd::Zero(most_vectors + 1, most_vectors);
    vectors.col(0) = random_direction(n);
    for (Eigen::Index m = 1; m <= most_vectors; ++m) {
        Eigen::VectorXd next = power.times(vectors.col(m - 1));
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
double norm_of_power(const LinearMap& map, const Eigen::MatrixXd& space, int power) {
    // With these steps the norm is more than twice the one found with a chance of 1.65 sqrt(n) exp(-sqrt(3/4) 31).
    constexpr int steps = 16;
    constexpr double most = 2;
    const Eigen::Index n = map.size();
    Eigen::MatrixXd vectors(n, steps);
    Eigen::VectorXd next = random_direction(n);
    take_out(space, next);
    next.normalize();
    Eigen::MatrixXd projected = Eigen::MatrixXd::Zero(steps, steps);
    Eigen::Index size = 0;
    while (size < steps) {
        vectors.col(size) = next;
        for (int i = 0; i < power; ++i) {
            next = map.times(next);
            take_out(space, next);
        }
        for (int i = 0; i < power; ++i) {
            next = map.transposed_times(next);
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
std::optional<std::vector<std::complex<double>>> values_in(const LinearMap& map, const Eigen::MatrixXd& space) {
    constexpr double invariant = 1e-11; // relative to the matrix's effect on it
    std::vector<std::complex<double>> result;
    if (space.cols() == 0)
        return result;
    Eigen::MatrixXd image(space.rows(), space.cols());
    for (Eigen::Index i = 0; i < space.cols(); ++i)
        image.col(i) = map.times(space.col(i));
    const Eigen::MatrixXd inside = space.transpose() * image;
    const auto values = eigenvalues(inside);
    if (!values || !((image - space * inside).norm() <= invariant * image.norm()))
        return std::nullopt;
    result.assign(values->begin(), values->end());
    std::ranges::stable_sort(result, [](auto a, auto b) { return std::abs(a) > std::abs(b); });
    return result;
}

/// @param power of the map, the first to begin with
std::optional<LeadingEigenvalues> separated(const LinearMap& map, Power power) {
    constexpr int repetitions = 16; // of the power that is at hand, of which the norm is taken
    constexpr double closest = 0.999;
    if (map.size() <= 2 * most_vectors)
        return std::nullopt;
    for (const Separation& here : separations) {
        if (!power.square_to(here.squarings))
            return std::nullopt;
        const double exponent = std::pow(2.0, here.squarings);
        const auto space = leading_space(power, std::pow(here.least, exponent));
        if (!space)
            continue;
        auto values = values_in(map, *space);
        if (!values)
            return std::nullopt;
        const double within = std::pow(norm_of_power(power, *space, repetitions), 1 / (exponent * repetitions));
        if (within < std::min(closest, values->empty() ? 1 : std::abs(values->back())))
            return LeadingEigenvalues{std::move(*values), within};
    }
    return std::nullopt;
}

} // namespace

std::optional<LeadingEigenvalues> leading_eigenvalues(const Eigen::MatrixXd& matrix) {
    return separated(Power(matrix), Power(matrix));
}

std::optional<LeadingEigenvalues> leading_eigenvalues(const LinearMap& map) {
    return separated(map, Power(map));
}

} // namespace graze
