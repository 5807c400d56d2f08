#include "identify/fit_solver.hpp"

#include "graze/base/input_error.hpp"

#include <ceres/cost_function.h>
#include <ceres/iteration_callback.h>
#include <ceres/manifold.h>
#include <ceres/normal_prior.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <cmath>
#include <limits>

namespace graze {

namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Cost of a piece: its readings and the gap to the next piece. Parameter blocks: the shared unknowns, its initial
/// states, those of the next piece; empty blocks are left out.
class PieceCost : public ceres::CostFunction {
public:
    PieceCost(FitRows& rows, const FitPiece& piece, bool joined, double joint)
        : rows_(&rows), piece_(piece), joint_(joint) {
        const FitLayout& layout = rows.layout;
        shared_ = layout.shared();
        states_ = layout.unknown_states(rows.task(), piece);
        ahead_ = joined ? static_cast<Eigen::Index>(layout.states) : 0;
        for (const Eigen::Index size : {shared_, states_, ahead_})
            if (size > 0)
                mutable_parameter_block_sizes()->push_back(static_cast<int>(size));
        set_num_residuals(static_cast<int>(states_ + shared_ + 1 + ahead_));
    }

    /// Whether the piece can be evaluated at a point; the result is kept for the first call of Evaluate.
    bool can_begin(const Eigen::VectorXd& shared, const Eigen::VectorXd& states) const {
        return update(shared, states);
    }

    bool Evaluate(const double* const* numbers, double* residuals, double** slopes) const override {
        std::size_t block = 0;
        const auto next = [&](Eigen::Index size) {
            return size > 0 ? Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(numbers[block++], size))
                            : Eigen::VectorXd();
        };
        const Eigen::VectorXd shared = next(shared_), states = next(states_), ahead = next(ahead_);
        if (!update(shared, states))
            return false;
        const Eigen::Index own = states_ + shared_ + 1;
        Eigen::Map<Eigen::VectorXd> residual(residuals, own + ahead_);
        residual.head(own) = known_.readings.col(own - 1);
        if (ahead_ > 0)
            residual.tail(ahead_) = joint_ * rows_->gap(known_, ahead);
        if (slopes == nullptr)
            return true;
        block = 0;
        const auto fill = [&](Eigen::Index from, Eigen::Index size) {
            if (size == 0)
                return;
            if (double* to = slopes[block++]; to != nullptr) {
                Eigen::Map<RowMatrix> slope(to, own + ahead_, size);
                slope.topRows(own) = known_.readings.middleCols(from, size);
                if (ahead_ > 0) {
                    Eigen::MatrixXd ends = known_.ends.middleCols(from, size);
                    if (from == states_)
                        rows_->add_period_slopes(known_, ahead, ends);
                    slope.bottomRows(ahead_) = joint_ * ends;
                }
            }
        };
        fill(states_, shared_);
        fill(0, states_);
        if (ahead_ > 0 && slopes[block] != nullptr) {
            Eigen::Map<RowMatrix> slope(slopes[block], own + ahead_, ahead_);
            slope.setZero();
            slope.bottomRows(ahead_).diagonal().setConstant(-joint_);
        }
        return true;
    }

private:
    /// Caches the last evaluation: a trial step that is accepted is evaluated again for the next iteration.
    bool update(const Eigen::VectorXd& shared, const Eigen::VectorXd& states) const {
        if (evaluated_ && shared == at_shared_ && states == at_states_)
            return known_.finite;
        evaluated_ = true;
        at_shared_ = shared;
        at_states_ = states;
        try {
            known_ = rows_->evaluate(piece_, shared, states);
        } catch (const InputError&) { // no motion can start there
            known_.finite = false;
        } catch (const FitInterruption&) { // let the solver return in the regular way
            known_.finite = false;
        }
        return known_.finite;
    }

    FitRows* rows_;
    FitPiece piece_;
    double joint_;
    Eigen::Index shared_ = 0, states_ = 0, ahead_ = 0;
    mutable bool evaluated_ = false;
    mutable Eigen::VectorXd at_shared_, at_states_;
    mutable PieceRows known_;
};

class ProgressCallback : public ceres::IterationCallback {
public:
    ProgressCallback(const StageProgress& progress, const FitPoint& point) : progress_(&progress), point_(&point) {}
    ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
        return *progress_ && !(*progress_)(summary.iteration, summary.cost, *point_) ? ceres::SOLVER_ABORT
                                                                                     : ceres::SOLVER_CONTINUE;
    }

private:
    const StageProgress* progress_;
    const FitPoint* point_;
};

void set_bounds(ceres::Problem& problem, const FitRows& rows, double* shared) {
    for (std::size_t j = 0; j < rows.task().parameters.size(); ++j) {
        const UnknownParameter& unknown = rows.task().parameters[j];
        const double scale = rows.layout.shared_scale[static_cast<Eigen::Index>(j)];
        if (std::isfinite(unknown.least))
            problem.SetParameterLowerBound(shared, static_cast<int>(j), unknown.least / scale);
        if (std::isfinite(unknown.greatest))
            problem.SetParameterUpperBound(shared, static_cast<int>(j), unknown.greatest / scale);
    }
}

} // namespace

StageReport minimise(FitRows& rows, FitPoint& point, const FitStage& stage, const StageProgress& progress) {
    ceres::Problem problem;
    const std::vector<FitPiece>& pieces = rows.layout.pieces;
    const auto is_active = [&](std::size_t k) { return stage.active.empty() || stage.active[k]; };
    const auto hold = [&](Eigen::VectorXd& block) {
        if (stage.prior > 0 && block.size() > 0) // a soft prior: penalises moving unknowns from their present values
            problem.AddResidualBlock(
                new ceres::NormalPrior(stage.prior * ceres::Matrix::Identity(block.size(), block.size()), block),
                nullptr, block.data());
    };
    Eigen::Index unknowns = point.shared.size();
    bool possible = true;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        if (!is_active(k))
            continue;
        std::vector<double*> blocks;
        if (point.shared.size() > 0)
            blocks.push_back(point.shared.data());
        if (point.states[k].size() > 0)
            blocks.push_back(point.states[k].data());
        const bool joined = pieces[k].has_next && is_active(k + 1);
        if (joined)
            blocks.push_back(point.states[k + 1].data());
        if (!blocks.empty()) {
            auto* cost = new PieceCost(rows, pieces[k], joined, stage.joint);
            problem.AddResidualBlock(cost, nullptr, blocks);
            possible = possible && cost->can_begin(point.shared, point.states[k]);
        }
        hold(point.states[k]);
        unknowns += point.states[k].size();
    }
    if (!stage.states_only)
        hold(point.shared);
    StageReport report;
    if (!possible) { // Ceres would fail and log it
        report.failed = true;
        report.cost = std::numeric_limits<double>::infinity();
        report.interrupted = rows.is_interrupted();
        return report;
    }
    if (point.shared.size() > 0 && problem.HasParameterBlock(point.shared.data())) {
        const bool all_held = stage.held.size() == static_cast<std::size_t>(point.shared.size());
        if (!stage.held.empty() && !all_held)
            problem.SetManifold(point.shared.data(),
                                new ceres::SubsetManifold(static_cast<int>(point.shared.size()), stage.held));
        if (stage.states_only || all_held)
            problem.SetParameterBlockConstant(point.shared.data());
        else
            set_bounds(problem, rows, point.shared.data());
    }
    if (problem.NumResidualBlocks() == 0 || unknowns == (stage.states_only ? point.shared.size() : 0)) {
        report.converged = true;
        return report;
    }
    constexpr Eigen::Index most_dense = 500;
    ProgressCallback callback(progress, point);
    ceres::Solver::Options options;
    options.linear_solver_type = unknowns <= most_dense ? ceres::DENSE_QR : ceres::SPARSE_NORMAL_CHOLESKY;
    options.max_num_iterations = stage.most_iterations;
    options.function_tolerance = stage.tolerance;
    if (stage.tolerance < 1e-12)
        // near the solution: a large trust region lets badly determined directions move, too
        options.initial_trust_region_radius = 1e10;
    // With a large weight of gaps, a step along the curved set of joined motions first increases the cost (the Maratos
    // effect); non-monotonic steps accept it.
    constexpr double stiff = 10;
    options.use_nonmonotonic_steps = stage.joint > stiff;
    options.max_consecutive_nonmonotonic_steps = 10;
    options.gradient_tolerance = 1e-300;
    options.parameter_tolerance = 1e-15;
    options.logging_type = ceres::SILENT;
    options.minimizer_progress_to_stdout = false;
    options.update_state_every_iteration = true;
    options.num_threads = 1;
    options.callbacks.push_back(&callback);
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    report.converged = summary.termination_type == ceres::CONVERGENCE;
    report.interrupted = summary.termination_type == ceres::USER_FAILURE || rows.is_interrupted();
    report.failed = summary.termination_type == ceres::FAILURE;
    report.cost = report.failed ? std::numeric_limits<double>::infinity() : summary.final_cost;
    report.gained = report.failed ? 0 : summary.initial_cost - summary.final_cost;
    report.iterations = static_cast<int>(summary.iterations.size());
    return report;
}

} // namespace graze
