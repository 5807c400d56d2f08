#pragma once

#include "graze/trajectory/trajectory.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

namespace graze {

/// Runs many trajectories of one simulation side by side in SIMD lanes. Trajectories in the same mode share a jet;
/// each takes its own steps and meets its own contacts, so that every one is the same bit for bit as when it is run
/// alone (with the same instruction set).
///
/// One ensemble belongs to one thread; several may share a Simulation.
class Ensemble {
public:
    explicit Ensemble(const Simulation& simulation, InstructionSet set = best_instruction_set());

    /// Runs all to their ends. Those already finished are left alone.
    /// @throws InputError for a trajectory of another simulation
    void run(std::span<Trajectory> trajectories);

    /// What is to run in a slot after its trajectory has finished: the same one started anew, another one, or null for
    /// nothing more.
    using Again = std::function<Trajectory*(std::size_t slot)>;
    /// Runs what is in the slots, and in each what comes after it. Slots may be empty (null); those that begin with a
    /// finished trajectory ask for the next one at once.
    /// @throws InputError for a trajectory of another simulation
    void run(std::span<Trajectory* const> slots, const Again& again);

    /// Leaves trajectories unfinished as soon as this is true, which is asked every some hundred steps; null for never.
    void stop_when(std::function<bool()> wanted) { is_stopped_ = std::move(wanted); }

    int lanes() const { return static_cast<int>(lanes_); }

private:
    bool must_stop();
    void admit(const Trajectory& trajectory);
    bool refill(std::size_t slot, const Again& again);
    bool step_lanes(std::size_t mode);
    std::size_t fullest_mode();
    void take_seats(std::size_t mode);
    void load_states();

    Simulation simulation_;
    std::size_t lanes_;
    JetSet jets_, single_;
    Outlook outlook_;
    std::vector<Trajectory*> slots_;
    std::unordered_set<const Trajectory*> present_; ///< what is in the slots
    std::vector<std::size_t> waiting_;              ///< slots of unfinished trajectories
    std::vector<std::size_t> seats_;                ///< slot in each lane
    std::vector<std::vector<std::size_t>> seated_;  ///< for each mode, whose parameters its jet's lanes have
    std::vector<std::size_t> crowd_;                ///< waiting trajectories in each mode
    std::vector<double> states_, parameters_;
    std::function<bool()> is_stopped_;
    std::size_t steps_ = 0;
};

} // namespace graze
