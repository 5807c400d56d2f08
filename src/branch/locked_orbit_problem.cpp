#include "branch/locked_orbit_problem.hpp"

#include "base/linear_systems.hpp"
#include "base/special_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

LockedOrbitProblem::LockedOrbitProblem(TorusSetting setting, std::size_t returns)
    : setting_(std::move(setting)), returns_(returns), scales_(unknowns(), setting_.parameter_scale),
      durations_(returns, setting_.back->first().durations) {
    for (std::size_t i = 0; i < parameter_place(); ++i)
        scales_[i] = setting_.scales[index(setting_.active[i % setting_.active.size()])];
}

std::vector<double> LockedOrbitProblem::on_circle(const Torus& circle, double turns, long numerator,
                                                  double parameter) const {
    std::vector<double> u;
    const double advance = static_cast<double>(numerator) / static_cast<double>(returns_);
    for (std::size_t j = 0; j < returns_; ++j) {
        const std::vector<double> state = circle.state_at(turns + static_cast<double>(j) * advance);
        for (const std::size_t i : setting_.active)
            u.push_back(state[i]);
    }
    u.push_back(parameter);
    return u;
}

std::vector<double> LockedOrbitProblem::around_circle(const Torus& circle, double turns, long numerator) const {
    std::vector<double> direction;
    const double advance = static_cast<double>(numerator) / static_cast<double>(returns_);
    for (std::size_t j = 0; j < returns_; ++j) {
        const Eigen::VectorXd rates =
            circle_function_rates(circle.harmonics(), turns + static_cast<double>(j) * advance);
        for (const std::size_t i : setting_.active) {
            double rate = 0;
            for (std::size_t term = 1; term < circle.terms.size(); ++term)
                rate += rates[index(term)] * circle.terms[term][i];
            direction.push_back(rate);
        }
    }
    direction.push_back(0);
    return direction;
}

std::vector<double> LockedOrbitProblem::later(std::span<const double> u, std::size_t returns) const {
    std::vector<double> result(u.begin(), u.end());
    const auto first = static_cast<std::ptrdiff_t>(returns % returns_ * setting_.active.size());
    std::rotate(result.begin(), result.begin() + first, result.end() - 1);
    return result;
}

double LockedOrbitProblem::separation(std::span<const double> u) const {
    const std::size_t actives = setting_.active.size();
    double least = infinity;
    for (std::size_t j = 1; j < returns_; ++j) {
        double square = 0;
        for (std::size_t a = 0; a < actives; ++a)
            square += std::pow((u[j * actives + a] - u[a]) / scales_[a], 2);
        least = std::min(least, std::sqrt(square));
    }
    return least;
}

std::vector<double> LockedOrbitProblem::state_of(std::span<const double> u, std::size_t place) const {
    std::vector<double> state = setting_.back->first().starts[0];
    for (std::size_t a = 0; a < setting_.active.size(); ++a)
        state[setting_.active[a]] = u[place * setting_.active.size() + a];
    return state;
}

bool LockedOrbitProblem::evaluate(std::span<const double> u) {
    if (std::ranges::equal(u, at_))
        return true;
    at_.clear();
    std::vector<SignatureReturn::Image> images;
    for (std::size_t j = 0; j < returns_; ++j) {
        auto image = setting_.back->follow(state_of(u, j), u[parameter_place()], durations_[j]);
        if (!image)
            return false;
        images.push_back(std::move(*image));
    }
    images_ = std::move(images);
    at_.assign(u.begin(), u.end());
    const auto actives = index(setting_.active.size()), last = index(parameter_place());
    const Eigen::VectorXd scales = setting_.scales(setting_.active);
    matrix_ = Eigen::MatrixXd::Zero(last, last + 1);
    residuals_.resize(last);
    for (std::size_t j = 0; j < returns_; ++j) {
        const SignatureReturn::Image& image = images_[j];
        durations_[j] = image.motion.durations;
        const std::size_t next = (j + 1) % returns_;
        const Eigen::Index row = index(j) * actives;
        const Eigen::VectorXd after = vector_of(image.after)(setting_.active),
                              wanted = vector_of(state_of(u, next))(setting_.active);
        residuals_.segment(row, actives) = (after - wanted).cwiseQuotient(scales);
        matrix_.block(row, row, actives, actives) = scales.cwiseInverse().asDiagonal() *
                                                    image.derivatives(setting_.active, setting_.active) *
                                                    scales.asDiagonal();
        matrix_.block(row, index(next) * actives, actives, actives).diagonal().array() -= 1;
        const Eigen::VectorXd by_parameter = image.derivatives.col(image.derivatives.cols() - 1)(setting_.active);
        matrix_.col(last).segment(row, actives) = scales_.back() * by_parameter.cwiseQuotient(scales);
    }
    return true;
}

/// Returns the derivatives with a row of unscaled unknowns below them.
Eigen::MatrixXd LockedOrbitProblem::bordered(std::span<const double> row) const {
    Eigen::MatrixXd matrix(matrix_.cols(), matrix_.cols());
    matrix << matrix_, vector_of(row).cwiseProduct(vector_of(scales_)).transpose();
    return matrix;
}

bool LockedOrbitProblem::solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
                               double* determinant) {
    if (at_.empty())
        return false;
    Eigen::VectorXd values = Eigen::VectorXd::Zero(matrix_.cols());
    if (!homogeneous)
        values.head(residuals_.size()) = -residuals_;
    values[values.size() - 1] = right;
    const Eigen::VectorXd result = PartialLU(bordered(row)).solve(values);
    if (determinant)
        *determinant = 1; // branch points are not looked for
    if (!result.allFinite())
        return false;
    entries_of(step) = result.cwiseProduct(vector_of(scales_));
    return true;
}

Orbit LockedOrbitProblem::orbit() const {
    Orbit orbit = images_.front().motion;
    for (std::size_t j = 1; j < returns_; ++j) {
        const Orbit& next = images_[j].motion;
        orbit.signature.insert(orbit.signature.end(), next.signature.begin(), next.signature.end());
        orbit.starts.insert(orbit.starts.end(), next.starts.begin(), next.starts.end());
        orbit.durations.insert(orbit.durations.end(), next.durations.begin(), next.durations.end());
    }
    return orbit;
}

double LockedOrbitProblem::parameter_error(std::span<const double> tangent) const {
    Eigen::VectorXd unit = Eigen::VectorXd::Zero(matrix_.cols());
    unit[unit.size() - 1] = 1;
    const Eigen::VectorXd answers = PartialLU(bordered(row_of(tangent))).solve_transposed(unit);
    return scales_.back() * answers.head(residuals_.size()).cwiseAbs().sum();
}

/// Beside an orbit, at a parameter that is off by delta, there is a motion that closes up to a displacement along the
/// curve: the last equation then misses by that displacement instead of 0.
LockedOrbitProblem::Drift LockedOrbitProblem::drift(std::span<const double> tangent) const {
    const Eigen::Index last = residuals_.size(), actives = index(setting_.active.size());
    Eigen::MatrixXd matrix = bordered(row_of(tangent));
    const Eigen::VectorXd by_parameter = matrix.col(last).head(last) / scales_.back();
    matrix.col(last).setZero();
    matrix.col(last).segment(last - actives, actives) =
        -vector_of(tangent).head(actives).cwiseQuotient(setting_.scales(setting_.active));
    Eigen::VectorXd values = Eigen::VectorXd::Zero(matrix.cols());
    values.head(last) = -by_parameter;
    Eigen::VectorXd answer = PartialLU(matrix).solve(values);
    Drift drift{answer[last], {}};
    answer[last] = 1 / scales_.back();
    // The motion moves on from return to return: along the circle it is elsewhere on it.
    const Eigen::VectorXd along = vector_of(tangent).cwiseQuotient(vector_of(scales_));
    for (Eigen::Index first = 0; first < last; first += actives) {
        const auto direction = along.segment(first, actives);
        answer.segment(first, actives) -=
            direction.dot(answer.segment(first, actives)) / direction.squaredNorm() * direction;
    }
    drift.across = numbers_of(answer.cwiseProduct(vector_of(scales_)));
    return drift;
}

} // namespace graze
