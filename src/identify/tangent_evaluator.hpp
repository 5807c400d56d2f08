#pragma once

#include "graze/flow/tangent_steps.hpp"
#include "graze/trajectory/simulation.hpp"

#include <cstddef>
#include <memory>
#include <span>
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

} // namespace graze
