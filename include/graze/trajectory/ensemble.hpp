#pragma once

#include "graze/trajectory/trajectory.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

namespace graze {

/// Runs many trajectories of one simulation side by side in SIMD lanes. Trajectories in the same mode share a jet; each
/// takes its own steps and has its own contacts, so that each result equals, bit for bit, that of a separate run (with
/// the same instruction set).
///
/// An ensemble belongs to one thread; several may share a Simulation.
class Ensemble {
public:
    explicit Ensemble(const Simulation& simulation, InstructionSet set = best_instruction_set());

    /// Runs all trajectories to their ends. Finished ones are skipped.
    /// @throws InputError for a trajectory of another simulation
    void run(std::span<Trajectory> trajectories);

    /// Returns the trajectory to run in a slot after its trajectory has finished: the same one started anew, another
    /// one, or null if there is none.
    using NextTrajectory = std::function<Trajectory*(std::size_t slot)>;
    /// Runs the trajectories in the slots, and in each slot its successors. Slots may be empty (null); for a slot that
    /// begins with a finished trajectory the successor is requested at once.
    /// @throws InputError for a trajectory of another simulation
    void run(std::span<Trajectory* const> slots, const NextTrajectory& next_of);

    /// Leaves trajectories unfinished as soon as this returns true; called every few hundred steps. Null: never.
    void stop_when(std::function<bool()> wanted) { is_stopped_ = std::move(wanted); }

    int lanes() const { return static_cast<int>(lanes_); }

private:
    bool must_stop();
    void admit(const Trajectory& trajectory);
    bool refill(std::size_t slot, const NextTrajectory& next_of);
    bool step_lanes(std::size_t mode);
    std::size_t most_frequent_mode();
    void assign_lanes(std::size_t mode);
    void load_states();

    Simulation simulation_;
    std::size_t lanes_;
    JetSet jets_, single_;
    StepPreview preview_;
    std::vector<Trajectory*> slots_;
    std::unordered_set<const Trajectory*> present_;       ///< the trajectories in the slots
    std::vector<std::size_t> waiting_;                    ///< slots of unfinished trajectories
    std::vector<std::size_t> slot_in_lane_;               ///< slot in each lane of the current mode
    std::vector<std::vector<std::size_t>> slots_of_mode_; ///< [mode][lane]: slot whose parameters the jet's lane has
    std::vector<std::size_t> waiting_in_mode_;            ///< number of unfinished trajectories in each mode
    std::vector<double> states_, parameters_;
    std::function<bool()> is_stopped_;
    std::size_t steps_ = 0;
};

} // namespace graze
