#pragma once

#include <cstddef>
#include <vector>

namespace graze {

/// Contacts without friction whose gaps, and the speeds at which these change, are so small that accelerations and the
/// response to impulses do not change any more until they rest.
struct NearbyContacts {
    std::size_t size() const { return gap.size(); }
    std::vector<double> gap, rate;
    std::vector<double> acceleration; ///< of gaps, without contact forces
    std::vector<double> restitution;
    std::vector<double> response; ///< change of each rate by a unit impulse in each contact, row by row
};

/// How contacts that hit one another come to rest.
struct JointRest {
    /// decided: all are closed after `duration`. leaves: a contact opens for good, or forces pull. undecided: more
    /// impacts than allowed
    enum class Fate { rest, leaves, undecided };
    Fate fate = Fate::undecided;
    double duration = 0; ///< until all are closed
    std::size_t impacts = 0;
    /// At rest: the sum of the impulses of each contact, and of these times the time that was left after each.
    std::vector<double> impulses{}, moments{};
    std::vector<bool> rests{}; ///< which contacts rest: all, or only those that collapse at one instant
};

/// Follows the contacts by their impacts, which are made one after another in the order of the contacts, each by
/// Newton's law. Since gaps and rates are the unknowns themselves, they keep their relative accuracy however small they
/// become: with constant accelerations the motion is the same at all scales (rates times a factor, gaps times its
/// square), so that it is at rest when both have fallen by a factor at which no time is left.
/// @param at_once what the impacts of one instant bring to rest is the result, while others separate
JointRest joint_rest(const NearbyContacts& contacts, std::size_t most_impacts, bool at_once = false);

} // namespace graze
