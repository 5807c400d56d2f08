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

double range_of(const BranchSettings& settings) {
    return settings.least && settings.greatest ? *settings.greatest - *settings.least : 0;
}

} // namespace

OrbitProblem::OrbitProblem(const Simulation& simulation, const Orbit& orbit, const BranchSettings& settings,
                           const OrbitMonitors* monitors)
    : shooting_(simulation, orbit, both(settings.parameter, settings.free), {range_of(settings)}) {
    if (!monitors)
        return;
    for (std::size_t m = 0; m < monitors->monitors().size(); ++m) {
        const Monitor& monitor = monitors->monitors()[m];
        if (monitor.fixed)
            held_.push_back(
                {monitor.held.value(), std::make_unique<MonitorFunction>(shooting_, monitor, monitors->segment(m))});
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
    rows_.resize(index(held_.size()), u.size());
    residuals_.resize(index(held_.size()));
    for (std::size_t h = 0; h < held_.size(); ++h) {
        MonitorFunction& function = *held_[h].function;
        if (!function.evaluate(shooting_, u))
            return false;
        const double unit = function.gradient().transpose().cwiseProduct(shooting_.scales()).norm();
        if (!std::isfinite(unit) || unit == 0)
            return false;
        rows_.row(index(h)) = function.gradient() / unit;
        residuals_[index(h)] = (function.value() - held_[h].value) / unit;
    }
    return true;
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
