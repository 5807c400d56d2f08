#pragma once

#include "graze/tape/jet.hpp"
#include "graze/trajectory/simulation.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <span>
#include <vector>

namespace graze {

/// Derivatives of one trajectory in several directions (of initial state and parameters), carried along arcs by
/// tangent lanes and through contacts by the saltation formulas (Aizerman and Gantmakher 1958; di Bernardo et
/// al. 2008, section 2.5), with the field *before* the jump in the projection.
///
/// Matrices are row by row, [row * directions + direction]. They hold derivatives at fixed time.
class Tangents {
public:
    /// @param seeds direction after direction, each (states + parameters) numbers
    Tangents(const Simulation& simulation, std::span<const double> parameters, std::span<const double> seeds,
             std::size_t directions);

    std::size_t directions() const { return directions_; }
    std::span<const double> matrix() const { return matrix_; }
    bool valid() const { return valid_; }
    void invalidate() { valid_ = false; }

    /// Derivatives along the arc that starts at `state`, a time s later.
    /// @param matrix states x directions, may be empty; @param row of the output `series` of the mode's tape
    ///        (its watched events, then observed expressions), directions; may be empty
    void evaluate(std::size_t mode, std::span<const double> state, double s, std::span<double> matrix,
                  std::size_t series, std::span<double> row);
    /// Derivatives of coefficient k of an output at the start of the arc.
    void coefficient(std::size_t mode, std::span<const double> state, std::size_t series, int k, std::span<double> row);

    /// Moves along the arc. @param series, row as of `evaluate`
    void advance(std::size_t mode, std::span<const double> state, double s, std::size_t series = 0,
                 std::span<double> row = {});
    /// Passes a jump that comes `shift` (derivatives, directions) later than time says: at a contact, minus the
    /// derivatives of the event function over its rate.
    /// @param field_before, field_after rates of the states; @param jacobian values of the jump's entries
    void pass_jump(std::span<const double> shift, std::span<const double> field_before,
                   const System::CompiledJump& jump, std::span<const double> jacobian,
                   std::span<const double> field_after);
    /// Adds `column` times `row` to the matrix.
    void add_product(std::span<const double> column, std::span<const double> row);

private:
    /// Values and the directions from `first` on, for a jet.
    void fill(std::span<double> lanes, std::span<const double> values, std::span<const double> tangents,
              std::size_t first) const;
    /// The jet with the directions from `first` on.
    const Jet& compute(std::size_t mode, std::span<const double> state, std::span<const double> matrix,
                       std::size_t first);
    /// Moves derivatives as far as they may be moved at once, up to s, into `after_`, and the state into `moved_`.
    /// @return how far
    double step(std::size_t mode, std::span<const double> state, std::span<const double> matrix, double s,
                std::size_t series, std::span<double> row);

    std::size_t states_, parameter_count_, directions_;
    double tolerance_;
    JetSet jets_;
    std::size_t lanes_; ///< directions a pass
    std::vector<double> parameters_, parameter_seeds_, matrix_, next_, seeds_, sums_, slopes_, times_, parameter_lanes_;
    std::vector<double> middle_, after_, between_, moved_; ///< within arcs that are followed in parts
    bool valid_ = true;
};

} // namespace graze
