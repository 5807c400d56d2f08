#include "identify/fit_solver.hpp"

#include "base/decompositions.hpp"
#include "graze/base/input_error.hpp"
#include "identify/fit_findings.hpp"
#include "identify/fit_information.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace graze {

namespace {

/// A motion of all records whose pieces join exactly, with its residuals.
struct JoinedMotion {
    FitPoint point;
    std::vector<std::size_t> modes;
    std::vector<PieceRows> known;
    double cost = std::numeric_limits<double>::infinity(); ///< infinite if the motion is incomplete
};

class JoinedDescent {
public:
    JoinedDescent(FitRows& rows, const FitPoint& point, double joint) : rows_(&rows), joint_(joint) {
        best_ = follow(point);
    }
    const JoinedMotion& best() const { return best_; }

    double freedom() const { return freedom_; }

    DescentReport run(bool probe, const std::function<bool(double)>& tell) {
        constexpr int most_iterations = 100, most_probes = 10;
        DescentReport report;
        for (int probes = 0; probes < (probe ? most_probes : 1) && !report.least; ++probes) {
            for (int i = 0; i < most_iterations; ++i) {
                prepare();
                if (remaining_step_ <= stationary || !descend())
                    break;
                ++report.iterations;
                if (!tell(best_.cost)) {
                    report.interrupted = true;
                    return report;
                }
            }
            prepare();
            report.least = remaining_step_ <= stationary || (probe && !probe_directions());
        }
        return report;
    }

private:
    static constexpr double stationary = 1e-3; ///< of standard errors

    JoinedMotion follow(FitPoint point) {
        const std::vector<FitPiece>& pieces = rows_->layout.pieces;
        JoinedMotion motion;
        double squares = 0;
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            FitPiece piece = pieces[k];
            if (!piece.is_first) {
                const PieceRows& before = motion.known.back();
                point.states[k] = before.ends.col(before.ends.cols() - 1);
                piece.mode = before.end_mode;
            }
            try {
                motion.known.push_back(rows_->evaluate(piece, point.shared, point.states[k]));
            } catch (const InputError&) { // no motion can start there
                return motion;
            }
            const PieceRows& rows = motion.known.back();
            if (!rows.finite || !rows.complete)
                return motion;
            motion.modes.push_back(piece.mode);
            squares += rows.squares();
        }
        motion.point = std::move(point);
        motion.cost = squares / 2;
        return motion;
    }

    /// Linearises the problem at the best motion, with columns scaled to length 1.
    void prepare() {
        const FitInformation information = information_of(*rows_, best_.point, best_.known, joint_);
        const Eigen::Index count = information.rows.cols() - 1;
        Eigen::MatrixXd scaled = information.rows.topLeftCorner(information.rows.rows(), count);
        for (const int j : parameters_at_bounds(*rows_, best_.point))
            scaled.col(count - rows_->layout.shared() + j).setZero();
        lengths_ = scaled.colwise().norm();
        for (Eigen::Index c = 0; c < count; ++c)
            scaled.col(c) /= lengths_[c] > 0 ? lengths_[c] : 1;
        const SingularValues factors = singular_values(scaled, SingularVectors::thin);
        values_ = factors.values;
        directions_ = factors.right;
        left_ = factors.left.transpose() * information.rows.col(count);
        for (Eigen::Index k = 0; k < count; ++k)
            left_[k] = is_determined(k) ? left_[k] : 0;
        freedom_ = std::max(1.0, readings() - static_cast<double>(count));
        size_ = std::sqrt(2 * best_.cost / freedom_);
        remaining_step_ = size_ > 0 ? left_.norm() / size_ : 0;
    }
    bool is_determined(Eigen::Index k) const {
        constexpr double negligible = 1e-9; // as in FitDecomposition
        return values_[k] > negligible * values_[0];
    }
    double readings() const {
        double count = 0;
        for (const PieceRows& piece : best_.known)
            count += static_cast<double>(piece.residuals.size());
        return count;
    }

    /// Takes a Levenberg-Marquardt step. @return false if no step decreases the cost
    bool descend() {
        constexpr double most = 1e4, rise = 10, fall = 100;
        for (;;) {
            Eigen::VectorXd step = Eigen::VectorXd::Zero(values_.size());
            for (Eigen::Index k = 0; k < values_.size(); ++k)
                if (is_determined(k))
                    step -= directions_.col(k) *
                            (left_[k] * values_[k] /
                             (values_[k] * values_[k] + damping_ * damping_ * values_[0] * values_[0]));
            if (take(step)) {
                damping_ = damping_ > least_damping ? damping_ / fall : 0;
                return true;
            }
            damping_ = std::max(least_damping, damping_ * rise);
            if (damping_ > most) {
                damping_ = 0;
                return false;
            }
        }
    }

    /// Tries steps along each singular direction by parts of its standard error. @return whether one decreases the cost
    bool probe_directions() {
        for (Eigen::Index k = 0; k < values_.size(); ++k)
            for (const double part : {1.0, -1.0, 0.5, -0.5, 0.25, -0.25})
                if (is_determined(k) && take(directions_.col(k) * (part * size_ / values_[k])))
                    return true;
        return false;
    }

    /// Takes a step if it decreases the cost. @param step in columns of length 1. @return whether it did
    bool take(const Eigen::VectorXd& step) {
        const std::vector<FitPiece>& pieces = rows_->layout.pieces;
        FitPoint point = best_.point;
        Eigen::Index column = 0;
        const auto moved = [&](double& number) {
            number += lengths_[column] > 0 ? step[column] / lengths_[column] : 0;
            ++column;
        };
        for (std::size_t k = 0; k < pieces.size(); ++k)
            if (pieces[k].is_first)
                for (double& number : point.states[k])
                    moved(number);
        for (double& number : point.shared)
            moved(number);
        for (std::size_t j = 0; j < rows_->task().parameters.size(); ++j) {
            const UnknownParameter& unknown = rows_->task().parameters[j];
            const auto place = static_cast<Eigen::Index>(j);
            const double scale = rows_->layout.shared_scale[place];
            point.shared[place] = std::clamp(point.shared[place], unknown.least / scale, unknown.greatest / scale);
        }
        constexpr double less = 1e-10;
        JoinedMotion trial = follow(std::move(point));
        if (!(trial.cost < (1 - less) * best_.cost))
            return false;
        best_ = std::move(trial);
        return true;
    }

    static constexpr double least_damping = 1e-7;

    FitRows* rows_;
    double joint_;
    JoinedMotion best_;
    Eigen::VectorXd lengths_, values_, left_;
    Eigen::MatrixXd directions_;
    double size_ = 0, remaining_step_ = 0, damping_ = 0, freedom_ = 1;
};

} // namespace

DescentReport descend_joined(FitRows& rows, FitPoint& point, double joint, bool probe,
                             const std::function<bool(double)>& tell) {
    double squares = 0;
    for (const PieceRows& piece : rows.evaluate(point)) {
        if (!piece.finite)
            return {};
        squares += piece.squares();
    }
    JoinedDescent descent(rows, point, joint);
    if (!std::isfinite(descent.best().cost))
        return {};
    const DescentReport report = descent.run(probe, tell);
    constexpr double as_good = 1; // a motion one standard error away costs this much more
    if (!(descent.best().cost <= (1 + as_good / descent.freedom()) * squares / 2))
        return {.interrupted = report.interrupted, .least = false, .iterations = report.iterations};
    point = descent.best().point;
    for (std::size_t k = 0; k < rows.layout.pieces.size(); ++k)
        rows.layout.pieces[k].mode = descent.best().modes[k];
    return report;
}

} // namespace graze
