#pragma once

#include "graze/flow/tangent_steps.hpp"
#include "graze/trajectory/simulation.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace graze {

/// Derivatives of a motion at any places along one of its steps, and a little before and behind it, in any number of
/// directions. Matrices are row by row, [state * directions + direction].
class TangentFan {
public:
    TangentFan(const Simulation& simulation, std::size_t directions);

    std::size_t directions() const { return directions_; }
    /// @param seeds of the parameters in the directions, parameters x directions
    void set_parameters(std::span<const double> parameters, std::span<const double> seeds);
    /// The places that follow are counted from here.
    void begin(std::size_t mode, std::span<const double> state, std::span<const double> matrix);
    /// @param s those of one sign in order of their size
    /// @return whether the flow could be followed so far
    bool at(double s, std::span<double> state, std::span<double> matrix);

private:
    /// As many directions as a jet takes at once; all places of a step then come from one jet.
    struct Group {
        Group(const Simulation& simulation, std::size_t from, std::size_t directions);
        std::size_t first, count;
        ModeJets jets;
        TangentSteps steps;
        std::vector<double> state, matrix, next; ///< where it is, and where it was asked for
        double from = 0;                         ///< how far that is from the beginning
        bool begun = false;                      ///< there is a jet of that place
    };
    bool follow(Group& group, double s);

    std::size_t states_, directions_, mode_ = 0;
    std::vector<std::unique_ptr<Group>> groups_;
};

} // namespace graze
