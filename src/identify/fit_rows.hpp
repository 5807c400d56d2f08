#pragma once

#include "graze/symbolic/function.hpp"
#include "identify/fit_layout.hpp"
#include "identify/piece_motion.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <exception>
#include <string>
#include <vector>

namespace graze {

/// What a piece says about the unknowns. Columns are the states at its beginning, the shared unknowns, and what is
/// left; all unknowns in their scales.
struct PieceRows {
    /// Triangular: as many rows as columns, of the same sums of squares and products as those of all its readings.
    Eigen::MatrixXd readings;
    Eigen::MatrixXd ends;      ///< the state at its end, in scales: derivatives, and, last, the state
    std::vector<double> rests; ///< readings as they should be less what they are: time by time, reading by reading
    std::size_t end_mode = 0, contacts = 0, misplaced = 0;
    bool complete = false, finite = false;
    std::string detail;
    /// Sum of the squares of what is left.
    double squares() const { return readings.col(readings.cols() - 1).squaredNorm(); }
    std::vector<double> periods, period_slopes; ///< of cyclic states; by the parameters that are found, in no scale
};

/// The caller has ended the fit in the middle of a motion.
class FitInterruption : public std::exception {
public:
    const char* what() const noexcept override { return "the fit was interrupted"; }
};

/// What something that is left costs: its square, or less if it is far off. @param rest in standard deviations
double cost_of(double rest, FitLoss loss);

/// Evaluates pieces.
class FitRows {
public:
    FitRows(const System& system, const FitTask& task, const FitSettings& settings);

    FitLayout layout;
    std::vector<double> noise; ///< of each output: what readings are divided by
    bool robust = true;        ///< whether the loss of the settings is made of what is left, or squares

    /// Whether the caller has ended the fit in the middle of a motion.
    bool is_interrupted() const { return motion_.is_interrupted(); }
    const FitTask& task() const { return *task_; }
    const System& system() const { return system_; }
    /// Rows are measured by this: what is left, relative to the ranges of the outputs.
    double unit() const;
    double range(std::size_t output) const { return ranges_[output]; }
    FitLoss loss() const { return robust ? loss_ : FitLoss::squares; }

    double gain(std::size_t output, const Eigen::VectorXd& shared) const;
    double offset(std::size_t output, const Eigen::VectorXd& shared) const;

    /// All pieces. One in which no motion begins is not finite.
    std::vector<PieceRows> evaluate(const FitPoint& point);
    const PieceRows& evaluate(const FitPiece& piece, const Eigen::VectorXd& shared, const Eigen::VectorXd& states);
    /// The gap between a state at the end of a piece and the first of the next, in scales; of cyclic states the
    /// shorter way round.
    Eigen::VectorXd gap(const PieceRows& piece, const Eigen::VectorXd& next) const;
    /// Adds to derivatives of a gap by what is shared what parameters make of the periods that `gap` has taken off.
    void add_period_slopes(const PieceRows& piece, const Eigen::VectorXd& next,
                           Eigen::Ref<Eigen::MatrixXd> shared) const;
    /// The whole state at the beginning of a piece. @param shared, states in scales
    std::vector<double> first_state(const FitPiece& piece, const Eigen::VectorXd& shared,
                                    const Eigen::VectorXd& states);
    /// The model's own initial state.
    std::vector<double> model_start(std::size_t record, const Eigen::VectorXd& shared);
    /// All independent parameters, of a record.
    std::vector<double> parameters(std::size_t record, const Eigen::VectorXd& shared) const;
    const PredictedMotion& motion(const FitPiece& piece, const Eigen::VectorXd& shared, const Eigen::VectorXd& states);

private:
    struct Side {
        std::vector<double> values, slopes; ///< of outputs; outputs x directions
    };
    void read(std::span<const double> state, std::span<const double> derivatives, Side& side);
    void find_period_slopes(std::span<const double> parameters);
    bool is_beyond(const FitRecord& record, std::size_t sample, const Eigen::VectorXd& shared) const;
    void add_time(const FitPiece& piece, std::size_t sample, const Eigen::VectorXd& shared, Eigen::Index row);
    void add_ends(const FitPiece& piece, const PredictedMotion& predicted);
    double scale_of(const FitPiece& piece, Eigen::Index column) const;
    System system_;
    const FitTask* task_;
    FitLoss loss_;
    double reach_;
    std::vector<double> period_slopes_; ///< of periods by unknown parameters, in no scale; of the last motion
    std::vector<double> ranges_, values_, periods_, inputs_, work_, gradient_;
    std::vector<Function> outputs_,
        initials_; ///< values, with gradients; of outputs, and of the model's initial states
    PieceMotion motion_;
    Side side_, beyond_;
    Eigen::MatrixXd raw_;
    PieceRows rows_;
};

} // namespace graze
