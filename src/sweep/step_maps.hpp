#pragma once

#include "graze/tape/jet.hpp"
#include "graze/trajectory/simulation.hpp"
#include "sweep/section_map.hpp"
#include "tape/column_series.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace graze {

/// The first variational equations W' = A W of a simulation's modes, along all directions that anything depends on.
/// Immutable; threads may share it.
class VariationalModes {
public:
    /// The vector field and, as outputs, the entries of its Jacobian A, whose rows and columns are the directions.
    struct Mode {
        Tape tape;
        std::vector<MatrixEntry> entries;
    };

    /// @param map of the section by which motions are followed
    explicit VariationalModes(const SectionMap& map);

    /// Whether derivatives of motions are had for less from StepMaps than from trajectories that carry them, for there
    /// are few directions.
    bool suit() const { return suit_; }
    const Simulation& simulation() const { return simulation_; }
    /// Only where they suit.
    const std::vector<Mode>& modes() const { return modes_; }
    /// States, rising: all but the clocks by which returns are told, which nothing disturbs.
    const std::vector<std::size_t>& directions() const { return directions_; }

private:
    Simulation simulation_;
    std::vector<std::size_t> directions_;
    std::vector<Mode> modes_;
    bool suit_ = false;
};

/// Derivatives over steps that have been made already. They do not depend on one another, so that those of many steps
/// of one motion fill SIMD lanes: one for each step.
///
/// Steps are followed in parts where derivatives change faster than the motion. The error of a direction is measured
/// against its size, states in units of given scales; at the end of each part, derivatives have to be what the
/// variational equations say.
class StepMaps {
public:
    explicit StepMaps(const VariationalModes& modes);

    /// @param scale of each state
    void begin(std::span<const double> parameters, std::span<const double> scale);
    /// Notes a step of this length from a state in a mode. @return its number, from 0 after `clear`
    std::size_t add(std::size_t mode, std::span<const double> state, double length);
    /// Computes the maps of all that have been noted.
    void compute();
    void clear();
    std::size_t steps() const { return maps_.size() / map_size_; }
    /// Derivatives of the states at a step's end by those at its start: directions x directions, column by column.
    std::span<const double> map(std::size_t step) const { return {&maps_[step * map_size_], map_size_}; }
    /// Whether the step's derivatives could be followed to its end: only then is its map one. Behind a step where they
    /// could not, nothing is asked of others.
    bool is_known(std::size_t step) const { return known_[step]; }

private:
    /// What is left to do of a step.
    struct Part {
        std::size_t step = 0, state = 0; ///< its number; where its first state is
        double length = 0;
        double attempt = 0; ///< length to be followed now
        double first_misfit = 0;
        int halvings = 0;
        std::size_t before = 0; ///< parts of the step that have been followed
        bool accepted = false;  ///< whatever comes out: what differs is round-off
    };
    /// Series of the states and of W, in lanes: where steps begin, and where they end.
    struct Flow {
        Flow(const VariationalModes::Mode& mode, std::size_t directions, int order);
        std::unique_ptr<Jet> jet, end_jet;
        ColumnSeries columns, end_columns;
    };
    Flow& flow(std::size_t mode);
    void load(std::span<const Part> parts);
    void find_reaches(const ColumnSeries& columns, std::span<Part> parts);
    void compute(std::size_t mode, std::span<Part> parts);
    void go_on_behind(std::size_t mode, const Part& part, std::size_t lane);
    bool believe(Part& part, double misfit) const;
    void apply(const Part& part, std::size_t lane);

    const VariationalModes* modes_;
    std::size_t states_, directions_, map_size_;
    int order_;
    double tolerance_;
    std::size_t lanes_;
    std::vector<std::unique_ptr<Flow>> flows_; ///< of modes, made when first needed
    std::vector<double> scale_, numbers_;      ///< of steps' first states
    std::vector<double> maps_, product_;
    std::vector<bool> known_;               ///< of the maps
    bool given_up_ = false;                 ///< since a step took too many parts
    std::vector<std::vector<Part>> queues_; ///< of each mode
    std::vector<Part> batch_;               ///< what is in lanes now
    // In lanes: of the parts that are followed now ...
    std::vector<double> parameters_, times_, states_here_, states_there_;
    std::vector<double> units_, sums_, slopes_, worst_; ///< ... W where they begin and end, and what is wrong with it
};

} // namespace graze
