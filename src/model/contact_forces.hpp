#pragma once

#include "graze/model/model.hpp"
#include "model/model_places.hpp"
#include "model/surface_motion.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
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
/// One for each contact.
using ContactStates = std::vector<ContactState>;
/// Returns all combinations of what each contact may do; that of the last one changes first.
std::vector<ContactStates> combinations(const std::vector<std::vector<ContactState>>& options);

inline bool is_slip(ContactState state) {
    return state == ContactState::forward || state == ContactState::backward;
}
/// Returns the end of the name of a mode, such as "-floor-stick"; empty for an open contact.
std::string contact_words(const std::string& contact, ContactState state);

/// A direction in which a contact acts: normal to the surface or along it.
struct ContactDirection {
    Expression velocity{};              ///< of the bodies relative to each other
    std::vector<Expression> slopes{};   ///< derivatives of this with respect to the velocities of the model
    std::vector<Expression> response{}; ///< change of the velocities of the model by a unit impulse
    Expression acceleration{};          ///< rate of this velocity without contact forces
};

/// Forces or impulses of contacts, one for each: normal and tangential ones.
struct ContactForces {
    std::vector<Expression> normal{}, tangential{};
    std::vector<Expression> changes{}; ///< of the velocities of the model, or their rates
    /// Determinants that must be positive for these forces to be the only ones: of each slipping contact alone, and of
    /// all together. None without slip, where they always are.
    std::vector<Expression> regular{};
    /// Greatest tangential force of each sticking contact that friction holds.
    std::vector<Expression> limit{};
    /// Must be positive if contacts stick together in one direction: the difference of their directions is round-off.
    std::vector<Expression> parallel{};
    /// Must not be positive if contacts stick together: their slips would have different zeros.
    std::vector<Expression> apart{};
};

/// The mechanics of contacts in one written mode: directions, inertia, forces and impulses as solutions of linear
/// equations (Pfeiffer and Glocker 1996; Leine and van de Wouw 2008).
class ContactMechanics {
public:
    /// @param mode a written one, whose rates are those without contact forces
    ContactMechanics(Model& model, const Places& places, SurfaceMotion& motion, std::size_t mode);

    std::size_t size() const { return normal_.size(); }
    const std::vector<Expression>& field() const { return field_; }
    const Expression& gap(std::size_t contact) const { return gaps_[contact]; }
    const ContactDirection& normal(std::size_t contact) const { return normal_[contact]; }
    const ContactDirection& slip(std::size_t contact) const { return *slip_[contact]; }
    bool rubs(std::size_t contact) const { return slip_[contact].has_value(); }
    const Expression& friction(std::size_t contact) const { return friction_[contact]; }

    /// Solves for the forces that change the normal velocities of the contacts that are not open, and the tangential
    /// ones of those that stick, by these amounts.
    ContactForces solve(const ContactStates& states, const std::vector<Expression>& normal_changes,
                        const std::vector<Expression>& tangential_changes) const;
    /// Returns the forces that keep contacts closed, and those that stick at rest.
    ContactForces forces(const ContactStates& states) const;
    /// Returns how much changes of the model's velocities change that of a direction.
    Expression along(const ContactDirection& direction, const std::vector<Expression>& changes) const;
    /// Returns whether the directions that these states hold are independent at the initial state, but for contacts
    /// that stick together.
    bool independent(const ContactStates& states) const { return carriers(states).has_value(); }
    /// Returns whether directions are independent at the initial state: the normal of contact i is number 2i, its slip
    /// 2i + 1.
    bool independent(const std::vector<std::size_t>& directions) const;
    /// Contacts may stick in more directions than the velocities have, as a block that stands on two corners. The
    /// friction of all of them is then one force, if their directions are the same; its share in each is not
    /// determined.
    /// @return for each contact: the one that carries its friction, by default itself. None if directions depend on
    /// each other in another way, or if their slips differ by something that changes with the states
    std::optional<std::vector<std::size_t>> carriers(const ContactStates& states) const;
    /// Slips of one direction may have different zeros, as on two belts.
    /// @return what is positive where they have, but for round-off; the number 0 if they are the same everywhere
    Expression apart(std::size_t one, std::size_t other) const;

private:
    void require_linear(const ContactDirection& direction, const std::string& path, const std::string& what) const;
    ContactDirection direction_of(const Expression& velocity, const std::string& path, const std::string& what) const;
    Expression same_direction(const ContactDirection& one, const ContactDirection& other) const;
    void require_positive_masses() const;
    Expression without_velocities(const Expression& slip) const;
    void note_products();

    Model& model_;
    const Places& places_;
    SurfaceMotion& motion_;
    std::vector<std::size_t> velocities_;
    std::vector<Expression> symbols_, mass_, field_, gaps_, friction_;
    std::vector<ContactDirection> normal_;
    std::vector<std::optional<ContactDirection>> slip_;
    std::vector<double> products_; ///< see note_products
};

/// Solves M a = forces. @param mass the diagonal of the matrix M, or all rows
std::vector<Expression> accelerations_by(const std::vector<Expression>& mass, const std::vector<Expression>& forces);

} // namespace graze
