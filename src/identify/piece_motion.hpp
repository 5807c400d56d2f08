#pragma once

#include "graze/trajectory/jet_set.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "identify/tangent_fan.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// A piece of a motion, from a state at one time to another time.
struct MotionPiece {
    std::span<const double> state;
    std::span<const double> seeds; ///< derivatives of that state, states x directions
    std::size_t mode = 0;
    double begin = 0, end = 0;
    std::span<const double> times; ///< rising, within begin ... end
    /// Times this close to a contact, on either side, are also told what the motion on the other side of it would be
    /// had the contact come later, or earlier.
    double reach = 0;
};

/// States at the times of a piece, and their derivatives.
struct PredictedMotion {
    struct Sample {
        std::vector<double> state, derivatives; ///< states; states x directions
        bool other = false;                     ///< there is a contact near it: the state beyond
        double distance = 0;                    ///< of that contact
        std::vector<double> other_state, other_derivatives;
    };
    std::vector<Sample> samples;
    std::vector<double> end_state, end_derivatives;
    std::size_t end_mode = 0, contacts = 0;
    bool complete = false;      ///< it came to its end; samples behind where it ended have the last state and its seeds
    bool differentiable = true; ///< no contact without speed
    /// The last jump has left fewer states free than there are, as where friction brings a mass to rest.
    bool bound = false;
    std::string detail; ///< why it is not complete
};

/// Follows pieces of motions with their derivatives by states at their beginnings and by some parameters: along arcs by
/// the first variational equations, through contacts by saltation, through accumulations of contacts as Trajectory
/// does.
///
/// A state at the beginning may be a little beyond a surface, as an unknown can while it is sought: then the motion is
/// followed, back or on, to where it is on the right side, and begins there. So it depends smoothly on that state.
class PieceMotion {
public:
    /// @param moved independent parameters by which derivatives are asked for, as the last directions; the ones before
    /// are those of the states
    PieceMotion(const Simulation& simulation, std::vector<std::size_t> moved);

    /// Asked at every step: true ends a motion, and no other begins.
    void end_when(std::function<bool()> interrupted) { interrupted_ = std::move(interrupted); }
    /// Whether one was ended so.
    bool is_interrupted() const { return is_interrupted_; }

    std::size_t directions() const { return simulation_.system().states() + moved_.size(); }
    void set_parameters(std::span<const double> parameters);
    /// @throws InputError for what no trajectory can begin with
    const PredictedMotion& follow(const MotionPiece& piece);

private:
    class Watcher;
    void take(std::size_t sample, std::span<const double> state, std::span<const double> matrix);
    std::size_t violated(std::size_t mode, std::span<const double> state);
    bool find_side(const MotionPiece& piece, std::size_t event);

    Simulation simulation_;
    std::function<bool()> interrupted_;
    bool is_interrupted_ = false;
    std::vector<std::size_t> moved_;
    std::vector<double> parameters_, parameter_seeds_, seeds_;
    JetSet jets_;
    TangentFan fan_;
    PredictedMotion motion_;
    std::vector<double> inputs_, values_, work_;
    double side_ = 0; ///< how far from its beginning a piece is on the right side of all surfaces
    std::vector<double> side_state_, side_matrix_; ///< there
};

} // namespace graze
