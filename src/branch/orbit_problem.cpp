#include "branch/orbit_problem.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/shooting.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

std::vector<ParameterId> both(ParameterId parameter, std::vector<ParameterId> free) {
    free.insert(free.begin(), parameter);
    return free;
}

double range_of(const BranchSettings& settings) {
    return settings.least && settings.greatest ? *settings.greatest - *settings.least : 0;
}

} // namespace

OrbitProblem::OrbitProblem(std::unique_ptr<OrbitEquations> equations)
    : equations_(std::move(equations)), at_(equations_->evaluation()), weights_(equations_->unknowns(), 1.0) {
    // All starts together, and all durations, have at most the weight of those of a small model, so that steps are not
    // shorter for large models.
    constexpr double typical_starts = 8, typical_durations = 4;
    const OrbitLayout& layout = equations_->layout();
    const auto segments = static_cast<double>(layout.segments()), states = static_cast<double>(layout.states());
    const double of_starts = std::min(1.0, typical_starts / (states * segments)),
                 of_durations = std::min(1.0, typical_durations / segments);
    for (std::size_t k = 0; k < layout.pieces(); ++k) {
        const std::size_t segment = layout.segment_of(k);
        const auto count = static_cast<double>(1 + layout.last_piece(segment) - layout.first_piece(segment));
        entries_of(weights_).segment(index(layout.start_of(k)), index(layout.states())).setConstant(of_starts / count);
        weights_[layout.duration_of(k)] = of_durations;
        entries_of(weights_).segment(index(layout.inner_of(k)), index(layout.inner())).setZero();
    }
}

OrbitProblem::OrbitProblem(const Simulation& simulation, const Orbit& orbit, ParameterId parameter)
    : OrbitProblem(std::make_unique<Shooting>(simulation, orbit, std::vector{parameter})) {}

OrbitProblem::OrbitProblem(const Simulation& simulation, const Orbit& orbit, const BranchSettings& settings)
    : OrbitProblem(std::make_unique<Shooting>(simulation, orbit, both(settings.parameter, settings.free),
                                              std::vector{range_of(settings)})) {}

std::optional<OrbitDirection> OrbitProblem::tangent_at(const Orbit& orbit, double rate) {
    std::vector<double> row(unknowns(), 0.0), tangent(unknowns());
    row[parameter_place()] = 1;
    if (!evaluate(unknowns_of(orbit)) || !solve(row, rate, true, tangent, nullptr))
        return std::nullopt;
    return direction_of(tangent);
}

bool OrbitProblem::evaluate(std::span<const double> u) {
    const Eigen::VectorXd unknowns = vector_of(u);
    if (at_.is_at(unknowns) && at_.scales == equations_->scales())
        return true;
    row_.clear();
    if (equations_->evaluate(unknowns, at_) && evaluate_held())
        return true;
    at_.unknowns.resize(0);
    return false;
}

bool OrbitProblem::evaluate_held() {
    rows_.resize(index(held_.size()), index(unknowns()));
    residuals_.resize(index(held_.size()));
    for (std::size_t h = 0; h < held_.size(); ++h) {
        OrbitCondition& condition = *held_[h];
        if (!condition.evaluate(*equations_, at_))
            return false;
        const double unit = condition.gradient().transpose().cwiseProduct(at_.scales).norm();
        if (!std::isfinite(unit) || unit == 0)
            return false;
        rows_.row(index(h)) = condition.gradient() / unit;
        residuals_[index(h)] = condition.value() / unit;
    }
    return true;
}

/// Returns the factored bordered system, factoring only when the row has changed.
const OrbitEquations::Closed& OrbitProblem::closed_by(std::span<const double> row) {
    if (std::equal(row.begin(), row.end(), row_.begin(), row_.end()))
        return closed_;
    const Eigen::Index held = index(held_.size());
    Eigen::MatrixXd borders(1 + held, index(unknowns()));
    borders.row(0) = vector_of(row).transpose();
    if (held > 0)
        borders.bottomRows(held) = rows_;
    closed_ = equations_->close(at_, borders);
    row_.assign(row.begin(), row.end());
    return closed_;
}

bool OrbitProblem::solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
                         double* determinant) {
    const OrbitEquations::Closed& closed = closed_by(row);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(1 + index(held_.size())), result;
    values[0] = right;
    if (!homogeneous && !held_.empty())
        values.tail(index(held_.size())) = -residuals_;
    if (determinant)
        *determinant = closed.system.determinant();
    if (!equations_->solve(at_, closed, values, homogeneous, result))
        return false;
    entries_of(step) = result;
    return true;
}

bool OrbitProblem::chord(std::span<const double> u, std::span<const double> row, std::span<double> step) {
    return at_.unknowns.size() > 0 && correct(vector_of(u), row, step, nullptr);
}

bool OrbitProblem::correction_by(ModeFlow& flow, std::span<const double> row, std::span<double> step) {
    return correct(at_.unknowns, row, step, &flow);
}

/// Computes the correction at other unknowns with the derivatives that are known. @param flow of the equations if null
bool OrbitProblem::correct(const Eigen::VectorXd& unknowns, std::span<const double> row, std::span<double> step,
                           ModeFlow* flow) {
    Eigen::VectorXd result;
    if (!equations_->chord(at_, closed_by(row), unknowns, Eigen::VectorXd::Zero(1), result, flow))
        return false;
    entries_of(step) = result;
    return true;
}

} // namespace graze
