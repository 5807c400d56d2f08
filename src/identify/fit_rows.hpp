#pragma once

#include "base/concatenated.hpp"
#include "graze/symbolic/function.hpp"
#include "identify/fit_layout.hpp"
#include "identify/piece_motion.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <exception>
#include <string>
#include <vector>

namespace graze {

/// The rows that a piece adds to the least-squares problem. Columns are its initial states, the shared unknowns, and
/// the residuals; all unknowns in their scales.
struct PieceRows {
    /// Triangular factor of the rows of all its readings, with as many rows as columns.
    Eigen::MatrixXd readings;
    Eigen::MatrixXd ends; ///< final state in scales: derivatives by all columns; the last column is the state itself
    std::vector<double> residuals; ///< model values less readings, [time][reading]
    std::size_t end_mode = 0, contacts = 0, misplaced = 0;
    bool complete = false, finite = false;
    std::string detail;
    /// Sum of the squared residuals.
    double squares() const { return readings.col(readings.cols() - 1).squaredNorm(); }
    /// Periods of cyclic states, and their derivatives by the unknown parameters (unscaled).
    std::vector<double> periods, period_slopes;
};

/// Thrown when the caller ends the fit in the middle of a motion.
class FitInterruption : public std::exception {
public:
    const char* what() const noexcept override { return "the fit was interrupted"; }
};

/// Cost of a residual: its square for least squares, less for outliers under a robust loss. @param residual in
/// standard deviations
double cost_of(double residual, FitLoss loss);

/// Evaluates pieces: follows their motions and computes residuals and derivatives.
class FitRows {
public:
    FitRows(const System& system, const FitTask& task, const FitSettings& settings);

    FitLayout layout;
    std::vector<double> noise; ///< of each output: the residuals are divided by it
    bool robust = true;        ///< true: the loss of the settings is applied; false: least squares

    /// Whether the caller has ended the fit in the middle of a motion.
    bool is_interrupted() const { return motion_.is_interrupted(); }
    const FitTask& task() const { return *task_; }
    const System& system() const { return system_; }
    /// Unit of the rows: the smallest noise relative to the range of its output.
    double unit() const;
    double range(std::size_t output) const { return ranges_[output]; }
    FitLoss loss() const { return robust ? loss_ : FitLoss::squares; }

    double gain(std::size_t output, const Eigen::VectorXd& shared) const;
    double offset(std::size_t output, const Eigen::VectorXd& shared) const;

    /// Evaluates all pieces. A piece in which no motion can start is returned as not finite.
    std::vector<PieceRows> evaluate(const FitPoint& point);
    const PieceRows& evaluate(const FitPiece& piece, const Eigen::VectorXd& shared, const Eigen::VectorXd& states);
    /// Gap between the final state of a piece and the initial state of the next, in scales; cyclic states take the
    /// shorter way round.
    Eigen::VectorXd gap(const PieceRows& piece, const Eigen::VectorXd& next) const;
    /// Adds to the derivatives of a gap by the shared unknowns the contribution of periods (of cyclic states) that
    /// depend on parameters.
    void add_period_slopes(const PieceRows& piece, const Eigen::VectorXd& next,
                           Eigen::Ref<Eigen::MatrixXd> shared) const;
    /// The complete initial state of a piece. @param shared, states in scales
    std::vector<double> first_state(const FitPiece& piece, const Eigen::VectorXd& shared,
                                    const Eigen::VectorXd& states);
    /// The model's own initial state, at the parameters of a record.
    std::vector<double> model_start(std::size_t record, const Eigen::VectorXd& shared);
    /// Values of all independent parameters for a record.
    std::vector<double> parameters(std::size_t record, const Eigen::VectorXd& shared) const;
    /// Inputs of the model's functions: a state, and the parameters of a record.
    std::vector<double> inputs(std::size_t record, const std::vector<double>& state,
                               const Eigen::VectorXd& shared) const {
        return concatenated(state, parameters(record, shared));
    }
    const PredictedMotion& motion(const FitPiece& piece, const Eigen::VectorXd& shared, const Eigen::VectorXd& states);

private:
    struct Side {
        std::vector<double> values, slopes; ///< values of outputs; derivatives, outputs x directions
    };
    void read(std::span<const double> state, std::span<const double> derivatives, Side& side);
    void find_period_slopes(std::span<const double> parameters);
    bool is_beyond(const FitRecord& record, std::size_t sample, const Eigen::VectorXd& shared) const;
    double fitted_or(double given, std::size_t output, const std::vector<std::size_t>& unknown, std::size_t first,
                     const Eigen::VectorXd& shared) const;
    template <class Row, class Made>
    void fill(Row row, const FitPiece& piece, const double* slope, const Made& made) const;
    void add_time(const FitPiece& piece, std::size_t sample, const Eigen::VectorXd& shared, Eigen::Index row);
    void add_ends(const FitPiece& piece, const PredictedMotion& predicted);
    double scale_of(const FitPiece& piece, Eigen::Index column) const;
    System system_;
    const FitTask* task_;
    FitLoss loss_;
    double reach_;
    /// Derivatives of periods by the unknown parameters (unscaled), for the last motion.
    std::vector<double> period_slopes_;
    std::vector<double> ranges_, values_, periods_, inputs_, work_, gradient_;
    /// The outputs, and the model's initial states, with gradients.
    std::vector<Function> outputs_, initials_;
    PieceMotion motion_;
    Side side_, beyond_;
    Eigen::MatrixXd raw_;
    PieceRows rows_;
};

} // namespace graze
