#pragma once

#include "graze/model/model.hpp"
#include "model/start_values.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace graze {

/// What a contact does in a mode, or during an impact.
enum class ContactState {
    open,     ///< no force
    closed,   ///< without friction
    stick,    ///< the bodies do not move along each other
    forward,  ///< they do, with a positive velocity
    backward, ///< they do, with a negative one
};

/// An end of contact or of rest: contacts whose forces are at their limits.
struct ContactLimit {
    Expression function{}; ///< not negative while contacts hold
    /// What these contacts do beyond: open, or slip forward or backward.
    std::vector<std::pair<std::size_t, ContactState>> beyond{};
    /// Of forces that contacts share: the sum of the squares of its terms, for an estimate of round-off; otherwise 0.
    Expression squares{};
};

/// A force that depends on how friction is shared by contacts that stick together.
struct SharedForce {
    Expression fixed{};
    std::vector<Expression> by{}; ///< change by a unit of each force that may be chosen
};

/// Forces of a closed contact. One that does not stick has no tangential force here.
struct SharedContact {
    std::size_t contact = 0;
    bool sticks = false;
    Expression friction{};
    SharedForce normal{}, tangential{};
};

/// When contacts can share forces so that all of them hold.
struct JointLimits {
    std::vector<ContactLimit> limits{}; ///< there is a way to do so while none of these is negative
    /// Must be positive for `limits` to be all: coefficients and their determinants have the signs of the initial
    /// state.
    std::vector<Expression> regular{};
};

/// Contacts that stick together share their friction in many ways. They hold if forces can be chosen within all cones
/// of friction, which are linear inequalities. These have a solution unless a positive combination of some of them in
/// which the chosen forces cancel says otherwise (Farkas); each of the smallest such sets gives one limit.
/// @param contacts those that one of the chosen forces changes
JointLimits joint_limits(const StartValues& start, const std::vector<SharedContact>& contacts);

} // namespace graze
