#pragma once

#include "graze/tape/jet.hpp"
#include "sweep/section_map.hpp"
#include "tape/column_series.hpp"

#include <memory>

namespace graze {

/// The first variational equations W' = A W of a simulation's modes, in all directions that matter. Immutable; threads
/// may share it.
class VariationalModes {
public:
    /// The vector field and, as outputs, the entries of its Jacobian A; rows and columns are the directions.
    struct Mode {
        Tape tape;
        std::vector<MatrixEntry> entries;
    };

    /// @param map the section that defines returns
    explicit VariationalModes(const SectionMap& map);

    /// Returns whether StepMaps compute derivatives faster than trajectories that propagate them, because there are few
    /// directions.
    bool suit() const { return suit_; }
    const Simulation& simulation() const { return simulation_; }
    /// Empty unless suit().
    const std::vector<Mode>& modes() const { return modes_; }
    /// Returns the states, rising, except the clocks that define returns, which no state disturbs.
    const std::vector<std::size_t>& directions() const { return directions_; }

private:
    Simulation simulation_;
    std::vector<std::size_t> directions_;
    std::vector<Mode> modes_;
    bool suit_ = false;
};

/// Derivatives over completed steps. They are independent of one another, so that many steps of one motion fill SIMD
/// lanes, one step per lane.
///
/// Where derivatives change faster than the motion, steps are taken in parts. The error of a direction is relative to
/// its size, with states in given units; at the end of each part, derivatives must obey the variational equations.
class StepMaps {
public:
    explicit StepMaps(const VariationalModes& modes);

    /// @param scale unit of each state
    void begin(std::span<const double> parameters, std::span<const double> scale);
    /// Adds a step of this length from a state in a mode. @return its number, from 0 after `clear`
    std::size_t add(std::size_t mode, std::span<const double> state, double length);
    /// Computes the maps of all added steps.
    void compute();
    void clear();
    std::size_t steps() const { return maps_.size() / map_size_; }
    /// Returns the derivatives of the final state of a step by its initial state: directions x directions, column by
    /// column.
    std::span<const double> map(std::size_t step) const { return {&maps_[step * map_size_], map_size_}; }
    /// Returns whether the map of the step is valid: its derivatives could be followed to the end. After a step with an
    /// invalid map, later maps must not be used.
    bool is_known(std::size_t step) const { return known_[step]; }

private:
    /// The remaining part of a step.
    struct Part {
        std::size_t step = 0, state = 0; ///< number of the step; index of its initial state
        double length = 0;
        double attempt = 0; ///< length tried next
        double first_misfit = 0;
        int halvings = 0;
        std::size_t before = 0; ///< number of completed parts of the step
        bool accepted = false;  ///< accept any difference: it is round-off
    };
    /// Series of the states and of W, in lanes, at the beginning and at the end of steps.
    struct Flow {
        Flow(const VariationalModes::Mode& mode, std::size_t directions, int order);
        std::unique_ptr<Jet> jet, end_jet;
        ColumnSeries columns, end_columns;
    };
    Flow& flow(std::size_t mode);
    void find_reaches(const ColumnSeries& columns, std::span<Part> parts);
    void compute(std::size_t mode, std::span<Part> parts);
    void continue_after(std::size_t mode, const Part& part, std::size_t lane);
    bool accept(Part& part, double misfit) const;
    void apply(const Part& part, std::size_t lane);

    const VariationalModes* modes_;
    std::size_t states_, directions_, map_size_;
    int order_;
    double tolerance_;
    std::size_t lanes_;
    std::vector<std::unique_ptr<Flow>> flows_; ///< for each mode, made when first needed
    std::vector<double> scale_, numbers_;      ///< initial states of the steps
    std::vector<double> maps_, product_;
    std::vector<bool> known_;               ///< validity of the maps
    bool given_up_ = false;                 ///< a step took too many parts
    std::vector<std::vector<Part>> queues_; ///< for each mode
    std::vector<Part> batch_;               ///< the parts in the lanes now
    // For the parts in the lanes:
    std::vector<double> parameters_, times_, states_here_, states_there_;
    std::vector<double> units_, sums_, slopes_, worst_; ///< W at the beginning and end, and the errors
};

} // namespace graze
