#include "branch/orbit_problem.hpp"
#include "orbit/eigen_index.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

std::vector<std::size_t> both(std::size_t parameter, std::vector<std::size_t> free) {
    free.insert(free.begin(), parameter);
    return free;
}

} // namespace

OrbitProblem::OrbitProblem(const Simulation& simulation, const Orbit& orbit, std::size_t parameter,
                           const std::vector<std::size_t>& free, OrbitMonitors* monitors)
    : shooting_(simulation, orbit, both(parameter, free)), monitors_(monitors) {
    if (!monitors)
        return;
    for (std::size_t m = 0; m < monitors->monitors().size(); ++m) {
        const Monitor& monitor = monitors->monitors()[m];
        if (!monitor.fixed)
            continue;
        Held held{m, monitor.held.value(), std::nullopt};
        if (monitor.kind == Monitor::Kind::value)
            held.at_end = shooting_.with_gradient(monitor.expression);
        held_.push_back(std::move(held));
    }
}

std::vector<double> OrbitProblem::row_of(std::span<const double> direction) const {
    std::vector<double> row(direction.begin(), direction.end());
    for (std::size_t i = 0; i < row.size(); ++i)
        row[i] /= scales()[i] * scales()[i];
    return row;
}

bool OrbitProblem::evaluate(std::span<const double> u) {
    const Eigen::VectorXd unknowns = vector_of(u);
    return shooting_.evaluate(unknowns) && evaluate_held(unknowns);
}

bool OrbitProblem::evaluate_held(const Eigen::VectorXd& u) {
    if (held_.empty())
        return true;
    const std::vector<double> values = (*monitors_)(shooting_.orbit_of(u));
    rows_.resize(index(held_.size()), u.size());
    residuals_.resize(index(held_.size()));
    for (std::size_t h = 0; h < held_.size(); ++h) {
        const Held& held = held_[h];
        const Monitor& monitor = monitors_->monitors()[held.monitor];
        const auto segment = monitors_->segment(held.monitor);
        Eigen::RowVectorXd row;
        if (monitor.kind == Monitor::Kind::duration) {
            row = Eigen::RowVectorXd::Zero(u.size());
            for (std::size_t s = 0; s < shooting_.signature().size(); ++s)
                if (!segment || *segment == s)
                    for (std::size_t k = shooting_.first_piece(s); k <= shooting_.last_piece(s); ++k)
                        row[index(shooting_.duration_of(k))] = !segment && shooting_.symmetry() ? 2 : 1;
        } else if (held.at_end) {
            const std::size_t piece = shooting_.last_piece(*segment);
            std::vector<double> inputs = shooting_.piece(piece).end;
            inputs.insert(inputs.end(), shooting_.parameters().begin(), shooting_.parameters().end());
            const std::vector<double> all = (*held.at_end)(inputs);
            row = shooting_.row_at_end(piece, Eigen::Map<const Eigen::VectorXd>(&all[1], index(all.size() - 1)));
        } else {
            row = row_by_differences(held.monitor, u);
        }
        const double unit = row.transpose().cwiseProduct(shooting_.scales()).norm();
        if (!std::isfinite(values[held.monitor]) || !std::isfinite(unit) || unit == 0)
            return false;
        rows_.row(index(h)) = row / unit;
        residuals_[index(h)] = (values[held.monitor] - held.value) / unit;
    }
    return true;
}

/// Only starts and durations of whole segments count: on the orbit those of further pieces follow from them.
Eigen::RowVectorXd OrbitProblem::row_by_differences(std::size_t monitor, const Eigen::VectorXd& u) {
    constexpr double share = 1e-5; // of the scale: truncation and round-off are alike for central differences
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(u.size());
    std::vector<std::size_t> places;
    for (std::size_t s = 0; s < shooting_.signature().size(); ++s) {
        const std::size_t first = shooting_.first_piece(s);
        for (const std::size_t i : shooting_.active())
            places.push_back(shooting_.start_of(first) + i);
        places.push_back(shooting_.duration_of(shooting_.last_piece(s)));
    }
    for (std::size_t f = 0; f < shooting_.free().size(); ++f)
        places.push_back(shooting_.place_of_parameter(f));
    for (const std::size_t place : places) {
        const double step = share * shooting_.scales()[index(place)];
        Eigen::VectorXd there = u;
        there[index(place)] = u[index(place)] + step;
        const double above = (*monitors_)(shooting_.orbit_of(there))[monitor];
        there[index(place)] = u[index(place)] - step;
        const double below = (*monitors_)(shooting_.orbit_of(there))[monitor];
        row[index(place)] = (above - below) / (2 * step);
    }
    return row;
}

bool OrbitProblem::solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
                         double* determinant) {
    const Eigen::Index held = index(held_.size());
    Eigen::MatrixXd borders(1 + held, index(unknowns()));
    Eigen::VectorXd values(1 + held);
    borders.row(0) = vector_of(row).transpose();
    values[0] = right;
    if (held > 0) {
        borders.bottomRows(held) = rows_;
        values.tail(held) = homogeneous ? Eigen::VectorXd(Eigen::VectorXd::Zero(held)) : Eigen::VectorXd(-residuals_);
    }
    Eigen::VectorXd result;
    if (!shooting_.solve(borders, values, homogeneous, result, determinant))
        return false;
    Eigen::Map<Eigen::VectorXd>(step.data(), result.size()) = result;
    return true;
}

} // namespace graze
