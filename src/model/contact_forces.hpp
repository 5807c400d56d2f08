#pragma once

#include "graze/model/model.hpp"
#include "model/contact_directions.hpp"
#include "model/joint_friction.hpp"
#include "model/model_places.hpp"
#include "model/surface_motion.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// One for each contact.
using ContactStates = std::vector<ContactState>;
/// Returns all combinations of what each contact may do; that of the last one changes first.
std::vector<ContactStates> combinations(const std::vector<std::vector<ContactState>>& options);

inline bool is_slip(ContactState state) {
    return state == ContactState::forward || state == ContactState::backward;
}
/// Returns the end of the name of a mode, such as "-floor-stick"; empty for an open contact.
std::string contact_words(const std::string& contact, ContactState state);

/// Forces or impulses of contacts, one for each: normal and tangential ones.
struct ContactForces {
    std::vector<Expression> normal{}, tangential{};
    std::vector<Expression> changes{}; ///< of the velocities of the model, or their rates
    /// Determinants that must be positive for these forces to be the only ones: of each slipping contact alone, and of
    /// all together. None without slip, where they always are.
    std::vector<Expression> regular{};
    /// Ends of contact and of rest, in the order of the contacts.
    std::vector<ContactLimit> limits{};
    /// Must be positive if contacts stick together: slips that depend on one another at the initial state still do, but
    /// for round-off, and `limits` are all.
    std::vector<Expression> joint{};
    /// Must be zero if contacts stick together: their slips would have different zeros.
    std::vector<Expression> differences{};
    /// Of each of these: positive where it is not zero, but for round-off.
    std::vector<Expression> apart{};
};

/// The mechanics of contacts in one written mode: directions, inertia, forces and impulses as solutions of linear
/// equations (Pfeiffer and Glocker 1996; Leine and van de Wouw 2008).
class ContactMechanics {
public:
    /// @param mode a written one, whose rates are those without contact forces
    ContactMechanics(Model& model, const Places& places, SurfaceMotion& motion, std::size_t mode);

    std::size_t size() const { return directions_.contacts(); }
    const std::vector<Expression>& field() const { return field_; }
    const Expression& gap(std::size_t contact) const { return gaps_[contact]; }
    const ContactDirection& normal(std::size_t contact) const { return directions_[2 * contact]; }
    const ContactDirection& slip(std::size_t contact) const { return directions_[2 * contact + 1]; }
    bool rubs(std::size_t contact) const { return directions_.has(2 * contact + 1); }
    const ContactDirections& directions() const { return directions_; }
    const Expression& friction(std::size_t contact) const { return friction_[contact]; }

    /// Solves for the forces that change the normal velocities of the contacts that are not open, and the tangential
    /// ones of those that stick, by these amounts.
    ContactForces solve(const ContactStates& states, const std::vector<Expression>& normal_changes,
                        const std::vector<Expression>& tangential_changes) const;
    /// Returns the forces that keep contacts closed, and those that stick at rest. Of contacts that stick together
    /// those whose slips follow from others have no friction here, which is one of the ways to share it.
    ContactForces forces(const ContactStates& states) const;
    /// Returns whether the directions that these states hold are independent at the initial state, but for slips that
    /// follow from others and vanish with them.
    bool independent(const ContactStates& states) const { return held(states).has_value(); }
    /// Returns whether the slip of a sticking contact follows from what others hold. @param states independent ones
    bool follows(const ContactStates& states, std::size_t contact) const { return held(states)->follows(contact); }
    /// Returns whether contacts can slip in these directions, and stick, while closed gaps stay zero: slips that depend
    /// on one another have no independent signs.
    bool can_slip(const ContactStates& states) const;
    /// Returns how the slip of a contact follows from what others do whose gaps stay zero: it is zero with them, or has
    /// the direction of one of them. None if it does not. @param states of the others; of the contact: ignored
    struct FollowingSlip {
        ContactState state = ContactState::stick;
        Expression apart{}; ///< see DirectionDependence
    };
    std::optional<FollowingSlip> following_slip(std::size_t contact, ContactStates states) const;

private:
    void require_linear(const ContactDirection& direction, const std::string& path, const std::string& what) const;
    ContactDirection direction_of(const Expression& velocity, const std::string& path, const std::string& what) const;
    void require_positive_masses() const;
    /// Directions that states hold, and the slips of sticking contacts that follow from these: as a block that stands
    /// on two corners, contacts may stick in more directions than the velocities have.
    struct Held {
        std::vector<std::size_t> directions{};
        std::vector<std::pair<std::size_t, DirectionDependence>> following{}; ///< of contacts
        bool follows(std::size_t contact) const;
        /// Returns the share of a direction, or zero if it is none of those that are held.
        Expression share(const DirectionDependence& dependence, std::size_t direction, const Expression& zero) const;
    };
    std::optional<Held> held(const ContactStates& states) const;
    void add_limits(const ContactStates& states, const Held& held, ContactForces& to) const;

    Model& model_;
    const Places& places_;
    SurfaceMotion& motion_;
    std::vector<std::size_t> velocities_;
    std::vector<Expression> symbols_, mass_, field_, gaps_, friction_;
    ContactDirections directions_;
};

/// Solves M a = forces. @param mass the diagonal of the matrix M, or all rows
std::vector<Expression> accelerations_by(const std::vector<Expression>& mass, const std::vector<Expression>& forces);

} // namespace graze
