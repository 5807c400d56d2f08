#pragma once

#include "graze/trajectory/trajectory.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Runs many trajectories of one simulation side by side in SIMD lanes. Trajectories in the same mode share a jet;
/// each takes its own steps and meets its own contacts, so that every one is the same bit for bit as when it is run
/// alone (with the same instruction set).
///
/// One ensemble belongs to one thread; several may share a Simulation.
class Ensemble {
public:
    /// @param simulation must outlive the ensemble
    explicit Ensemble(const Simulation& simulation, InstructionSet set = best_instruction_set());

    /// Runs all to their ends. Those already finished are left alone.
    /// @throws std::invalid_argument for a trajectory of another simulation
    void run(std::span<Trajectory> trajectories);

    int lanes() const { return static_cast<int>(lanes_); }

private:
    std::size_t fullest_mode(std::span<const Trajectory> trajectories);
    void take_seats(std::span<const Trajectory> trajectories, std::size_t mode);
    void load_states(std::span<const Trajectory> trajectories);

    const Simulation* simulation_;
    std::size_t lanes_;
    JetSet jets_, single_;
    Outlook outlook_;
    std::vector<std::size_t> waiting_;             ///< unfinished trajectories
    std::vector<std::size_t> seats_;               ///< trajectory in each lane
    std::vector<std::vector<std::size_t>> seated_; ///< for each mode, whose parameters its jet's lanes have
    std::vector<std::size_t> crowd_;               ///< waiting trajectories in each mode
    std::vector<double> states_, parameters_;
};

} // namespace graze
