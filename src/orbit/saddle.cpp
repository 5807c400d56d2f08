#include "orbit/saddle.hpp"

#include "base/decompositions.hpp"
#include "base/linear_systems.hpp"
#include "flow/cyclic.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/solve_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

/// Real parts below this share of the largest eigenvalue count as zero: motions that slow have no end to wait for.
constexpr double neutral_share = 1e-7;

/// A basis of eigenvectors, in which a complex pair has the real and the imaginary part of one of its vectors.
struct RealBasis {
    Eigen::MatrixXd vectors;
    std::vector<std::complex<double>> values; ///< largest real part first
};

/// Appends the columns of the eigenvectors whose eigenvalue has a positive (negative) real part.
void append(const Eigensystem& all, bool growing, RealBasis& basis, Eigen::Index& filled) {
    std::vector<Eigen::Index> order;
    for (Eigen::Index k = 0; k < all.values.size(); ++k)
        if ((all.values[k].real() > 0) == growing && all.values[k].imag() >= 0)
            order.push_back(k);
    std::ranges::stable_sort(order, [&](auto a, auto b) { return all.values[a].real() > all.values[b].real(); });
    for (const Eigen::Index k : order) {
        basis.vectors.col(filled++) = all.vectors.col(k).real();
        basis.values.push_back(all.values[k]);
        if (all.values[k].imag() == 0) {
            basis.vectors.col(filled - 1).normalize();
            continue;
        }
        basis.vectors.col(filled++) = all.vectors.col(k).imag();
        basis.values.push_back(std::conj(all.values[k]));
    }
}

/// Solves growing * X - X * decaying = right.
Eigen::MatrixXd solve_sylvester(const Eigen::MatrixXd& growing, const Eigen::MatrixXd& decaying,
                                const Eigen::MatrixXd& right) {
    const Eigen::Index rows = right.rows(), columns = right.cols();
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows * columns, rows * columns);
    for (Eigen::Index j = 0; j < columns; ++j) {
        matrix.block(j * rows, j * rows, rows, rows) += growing;
        for (Eigen::Index i = 0; i < columns; ++i)
            matrix.block(j * rows, i * rows, rows, rows) -= decaying(i, j) * Eigen::MatrixXd::Identity(rows, rows);
    }
    const Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(right.data(), right.size());
    const Eigen::VectorXd found = FullLU<double>(matrix).solve(values);
    return Eigen::Map<const Eigen::MatrixXd>(found.data(), rows, columns);
}

} // namespace

Saddle::Saddle(const System& system, std::size_t mode, std::vector<ParameterId> free, Eigen::VectorXd scales)
    : equations_(system, mode, std::move(free)), scales_(std::move(scales)) {}

bool Saddle::fail(std::string why) {
    problem_ = std::move(why);
    return false;
}

bool Saddle::find(std::span<const double> near, std::span<const double> parameters) {
    state_.assign(near.begin(), near.end());
    return follow(parameters);
}

bool Saddle::follow(std::span<const double> parameters) {
    problem_.clear();
    if (equations_.size() != scales_.size())
        return fail("a saddle needs a mode in which each state acts on the motion: no clock, and no state that stays");
    if (!equations_.added_eigenvalues().empty())
        return fail("a saddle in a mode that slides along a surface is not supported");
    periods_ = equations_.system().periods()(parameters);
    const std::vector<double> before = state_;
    if (!solve_for_state(parameters) || !find_spaces(parameters)) {
        state_ = before;
        return false;
    }
    find_derivatives(parameters);
    return true;
}

/// Newton's method from the last state, to round-off.
bool Saddle::solve_for_state(std::span<const double> parameters) {
    constexpr int iterations = 30;
    constexpr double solved = 1e-9, farthest = 1; // corrections in units of the scales
    double before = 0;
    for (int i = 0; i < iterations; ++i) {
        const Eigen::MatrixXd field =
            equations_.jacobian(state_, parameters).leftCols(scales_.size()) * scales_.asDiagonal();
        const Eigen::VectorXd rates = equations_.rates(state_, parameters);
        if (!field.allFinite() || !rates.allFinite())
            break;
        const Eigen::VectorXd step = FullLU<double>(field).solve(rates);
        const double size = step.cwiseAbs().maxCoeff();
        if (!(size <= farthest))
            break;
        if (i > 0 && size <= solved && size >= 0.5 * before) // corrections that do not shrink are round-off
            return true;
        for (Eigen::Index k = 0; k < step.size(); ++k)
            state_[static_cast<std::size_t>(k)] -= scales_[k] * step[k];
        if (size == 0)
            return true;
        before = size;
    }
    return fail("no equilibrium is found where the orbit begins");
}

bool Saddle::find_spaces(std::span<const double> parameters) {
    const Eigen::Index n = scales_.size();
    const Eigen::MatrixXd field = scales_.cwiseInverse().asDiagonal() *
                                  equations_.jacobian(state_, parameters).leftCols(n) * scales_.asDiagonal();
    const auto found = field.allFinite() ? eigensystem(field) : std::nullopt;
    if (!found)
        return fail("the eigenvalues of the equilibrium are not found");
    const double least = neutral_share * found->values.cwiseAbs().maxCoeff();
    if (std::ranges::any_of(found->values, [least](auto one) { return std::abs(one.real()) <= least; }))
        return fail("the equilibrium has an eigenvalue on the imaginary axis: it is no saddle");
    unstable_ = std::ranges::count_if(found->values, [](auto one) { return one.real() > 0; });
    if (unstable_ == 0 || unstable_ == n)
        return fail(fmt::format("the equilibrium is {}: it is no saddle", unstable_ == 0 ? "stable" : "a source"));
    RealBasis basis{Eigen::MatrixXd(n, n), {}};
    Eigen::Index filled = 0;
    append(*found, true, basis, filled);
    append(*found, false, basis, filled);
    eigenvalues_ = std::move(basis.values);
    const FullLU<double> factors(basis.vectors);
    constexpr double dependent = 1e-10;
    if (filled != n || !(factors.reciprocal_condition() > dependent))
        return fail("the eigenvectors of the equilibrium are not independent");
    Eigen::MatrixXd inverse(n, n);
    for (Eigen::Index k = 0; k < n; ++k)
        inverse.col(k) = factors.solve(Eigen::VectorXd::Unit(n, k));
    left_ = inverse * scales_.cwiseInverse().asDiagonal();
    right_ = scales_.asDiagonal() * basis.vectors;
    field_ = inverse * field * basis.vectors;
    return true;
}

/// The left vectors L_u of the unstable space satisfy L_u A = F_u L_u with the field F_u in it. With A they turn by
/// dL_u = X L_s, F_u X - X F_s = L_u dA R_s; a part of dL_u within the space would only change its basis. The same
/// holds for the stable space, with the roles exchanged.
void Saddle::find_derivatives(std::span<const double> parameters) {
    const Eigen::Index n = scales_.size(), q = index(equations_.free().size()), u = unstable_, s = n - u;
    const Eigen::MatrixXd jacobian = equations_.jacobian(state_, parameters);
    const FullLU<double> factors(jacobian.leftCols(n));
    state_by_.resize(n, q);
    turns_.assign(static_cast<std::size_t>(q), Eigen::MatrixXd::Zero(n, n));
    for (Eigen::Index f = 0; f < q; ++f) {
        state_by_.col(f) = -factors.solve(jacobian.col(n + f));
        Eigen::VectorXd along = Eigen::VectorXd::Zero(n + q);
        along.head(n) = state_by_.col(f);
        along[n + f] = 1;
        const Eigen::MatrixXd change =
            left_ * equations_.second(state_, parameters, along).leftCols(n) * right_; // of A, in coordinates
        Eigen::MatrixXd& turn = turns_[static_cast<std::size_t>(f)];
        const Eigen::MatrixXd growing = field_.topLeftCorner(u, u), decaying = field_.bottomRightCorner(s, s);
        turn.topRightCorner(u, s) = solve_sylvester(growing, decaying, change.topRightCorner(u, s));
        turn.bottomLeftCorner(s, u) = solve_sylvester(decaying, growing, change.bottomLeftCorner(s, u));
    }
}

double Saddle::slowest_growth() const {
    return eigenvalues_[static_cast<std::size_t>(unstable_ - 1)].real();
}

double Saddle::slowest_decay() const {
    return -eigenvalues_[static_cast<std::size_t>(unstable_)].real();
}

Eigen::VectorXd Saddle::from_saddle(std::span<const double> state) const {
    Eigen::VectorXd result(scales_.size());
    for (std::size_t i = 0; i < state.size(); ++i)
        result[index(i)] = without_turns(state[i] - state_[i], periods_[i]);
    return result;
}

std::vector<double> Saddle::state_at(const Eigen::VectorXd& coordinates) const {
    return numbers_of(vector_of(state_) + right_ * coordinates);
}

Eigen::VectorXd Saddle::moved(const Eigen::VectorXd& coordinates, double time) const {
    Eigen::VectorXd result(coordinates.size());
    for (Eigen::Index k = 0; k < result.size(); ++k) {
        const std::complex<double> value = eigenvalues_[static_cast<std::size_t>(k)];
        const double growth = std::exp(value.real() * time);
        if (value.imag() == 0) {
            result[k] = growth * coordinates[k];
            continue;
        }
        // A state c_1 Re v + c_2 Im v is the real part of (c_1 - i c_2) v.
        const std::complex<double> turned =
            growth * std::polar(1.0, value.imag() * time) * std::complex(coordinates[k], -coordinates[k + 1]);
        result[k] = turned.real();
        result[++k] = -turned.imag();
    }
    return result;
}

double Saddle::time_to(double distance, const Eigen::VectorXd& coordinates) const {
    // In these coordinates distances grow or decay all the time, at rates between those of the eigenvalues.
    constexpr int iterations = 100;
    constexpr double close = 1e-12;
    double time = 0;
    for (int i = 0; i < iterations; ++i) {
        const Eigen::VectorXd at = moved(coordinates, time);
        const double size = at.norm();
        double rate = 0; // of the logarithm of the distance
        for (Eigen::Index k = 0; k < at.size(); ++k)
            rate += eigenvalues_[static_cast<std::size_t>(k)].real() * at[k] * at[k] / (size * size);
        const double step = std::log(distance / size) / rate;
        if (!std::isfinite(step))
            return 0;
        time += step;
        if (std::abs(step) <= close * std::abs(time))
            break;
    }
    return time;
}

Eigen::MatrixXd Saddle::coordinates_by_parameters(std::span<const double> state) const {
    const Eigen::VectorXd coordinates = left_ * from_saddle(state);
    Eigen::MatrixXd result = -left_ * state_by_;
    for (std::size_t f = 0; f < turns_.size(); ++f)
        result.col(index(f)) += turns_[f] * coordinates;
    return result;
}

} // namespace graze
