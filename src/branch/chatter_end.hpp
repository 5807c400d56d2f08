#pragma once

#include "branch/branch_state.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// The ends of a branch of orbits with a complete chatter sequence that no step can pass, since there is no orbit
/// beyond: where the rest after it vanishes together with the force that presses the motion on the surface (the onset
/// of chatter), and where the sequence itself vanishes, since the motion no longer leaves the surface.
class ChatterEnd {
public:
    /// Remembers an admissible point.
    void note(const BranchPoint& point);
    /// True when the rest after a chatter sequence is so short that further orbits would be less accurate than their
    /// distance from the onset.
    static bool is_at_onset(const Orbit& orbit);
    /// Returns the end to which the last points lead; empty if they lead to none.
    std::optional<SpecialPoint> find(BranchState& state) const;

private:
    struct Seen {
        double parameter = 0;
        std::vector<double> durations;
    };
    std::optional<SpecialPoint> onset(BranchState& state, std::size_t segment) const;
    std::optional<SpecialPoint> vanishing(BranchState& state, std::size_t segment) const;
    const Seen* longer(std::size_t segment, double factor) const;
    bool is_ahead(double parameter, const Seen& before) const;

    std::vector<Seen> seen_; ///< with one signature
    BranchPoint last_;
};

} // namespace graze
