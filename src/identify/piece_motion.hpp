#pragma once

#include "graze/flow/tangent_steps.hpp"
#include "graze/trajectory/jet_set.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Evaluates a smooth motion and its derivatives in any number of directions at any times within one step, and slightly
/// before and after it. Matrices are row by row, [state * directions + direction].
class TangentEvaluator {
public:
    TangentEvaluator(const Simulation& simulation, std::size_t directions);

    std::size_t directions() const { return directions_; }
    /// @param seeds derivatives of the parameters, parameters x directions
    void set_parameters(std::span<const double> parameters, std::span<const double> seeds);
    /// Starts a step; times of `at` are counted from here.
    void begin(std::size_t mode, std::span<const double> state, std::span<const double> matrix);
    /// Evaluates state and derivatives at a time after (or before, if negative) the start of the step.
    /// @param s calls with times of one sign must be in order of their magnitude
    /// @return whether the flow could be followed that far
    bool at(double s, std::span<double> state, std::span<double> matrix);

private:
    /// The directions that one jet carries at once; all times of a step are evaluated from the same jet.
    struct Group {
        Group(const Simulation& simulation, std::size_t from, std::size_t directions);
        std::size_t first, count;
        ModeJets jets;
        TangentSteps steps;
        std::vector<double> state, matrix, next; ///< state and derivatives at `from`; derivatives at the requested time
        double from = 0;                         ///< time from the start of the step
        bool begun = false;                      ///< a jet at `from` has been computed
    };
    bool follow(Group& group, double s);

    std::size_t states_, directions_, mode_ = 0;
    std::vector<std::unique_ptr<Group>> groups_;
};

/// Input of PieceMotion: a piece of a motion from an initial state to a final time.
struct MotionPiece {
    std::span<const double> state;
    std::span<const double> seeds; ///< derivatives of that state, states x directions
    std::size_t mode = 0;
    double begin = 0, end = 0;
    std::span<const double> times; ///< increasing, within begin ... end
    /// For times this close to a contact the motion on its other side is computed too, as if the contact came later or
    /// earlier.
    double reach = 0;
};

/// States at the times of a piece, with their derivatives.
struct PredictedMotion {
    struct Sample {
        std::vector<double> state, derivatives; ///< state; its derivatives, states x directions
        bool other = false;                     ///< a contact is near: other_state is the state on its other side
        double distance = 0;                    ///< time to that contact
        std::vector<double> other_state, other_derivatives;
    };
    std::vector<Sample> samples;
    std::vector<double> end_state, end_derivatives;
    std::size_t end_mode = 0, contacts = 0;
    bool complete = false; ///< the end was reached; otherwise later samples repeat the last state and its derivatives
    bool differentiable = true; ///< false after a grazing contact
    /// The last jump has left fewer states free, as where friction brings a mass to rest.
    bool constrained = false;
    std::string detail; ///< why the motion is not complete
};

/// Computes pieces of motions with their derivatives by initial states and by some parameters: along arcs by the first
/// variational equations, through contacts by saltation matrices, through accumulations of contacts as Trajectory does.
///
/// The initial state may slightly violate a barrier, as happens while it is fitted: then the motion is extrapolated,
/// forwards or backwards, to the admissible side, and starts there. The result so depends smoothly on the initial
/// state.
class PieceMotion {
public:
    /// @param moved independent parameters by which derivatives are computed, as the last directions; the first
    /// directions are the states
    PieceMotion(const Simulation& simulation, std::vector<std::size_t> moved);

    /// `interrupted` is called at every step; returning true ends the motion, and no other starts.
    void end_when(std::function<bool()> interrupted) { interrupted_ = std::move(interrupted); }
    /// Whether a motion was ended that way.
    bool is_interrupted() const { return is_interrupted_; }

    std::size_t directions() const { return simulation_.system().states() + moved_.size(); }
    void set_parameters(std::span<const double> parameters);
    /// @throws InputError for input with which no trajectory can start
    const PredictedMotion& follow(const MotionPiece& piece);

private:
    class Watcher;
    void take(std::size_t sample, std::span<const double> state, std::span<const double> matrix);
    const std::vector<double>& inputs_of(std::span<const double> state);
    std::size_t violated(std::size_t mode, std::span<const double> state);
    bool find_side(const MotionPiece& piece, std::size_t event);

    Simulation simulation_;
    std::function<bool()> interrupted_;
    bool is_interrupted_ = false;
    std::vector<std::size_t> moved_;
    std::vector<double> parameters_, parameter_seeds_, seeds_;
    JetSet jets_;
    TangentEvaluator evaluator_;
    PredictedMotion motion_;
    std::vector<double> inputs_, values_, work_;
    double side_ = 0;                              ///< time from the start of the piece to the admissible side
    std::vector<double> side_state_, side_matrix_; ///< state and derivatives at that time
};

} // namespace graze
