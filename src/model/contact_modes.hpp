#pragma once

#include "model/contact_forces.hpp"
#include "model/model_completion.hpp"
#include "model/model_expand.hpp"

#include <array>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// A mode in which contacts are closed, or a written one, in which all are open.
struct ContactVariant {
    std::size_t mode = 0;
    ContactStates states{};
    ContactForces force{};                                              ///< at its surfaces, as the accelerations
    std::vector<Expression> normal_acceleration{}, slip_acceleration{}; ///< of each contact
};

/// Makes the modes of contacts with their rates, when they are asked for.
class ContactModes {
public:
    ContactModes(Model& model, const Places& places);

    SurfaceMotion& motion() { return motion_; }
    const std::vector<std::size_t>& bases() const { return bases_; }
    bool is_base(std::size_t mode) const { return mechanics_.contains(mode); }
    const ContactMechanics& mechanics(std::size_t base) const { return *mechanics_.at(base); }
    /// Returns the event at which a contact closes.
    std::size_t gap_event(std::size_t contact) const { return gap_events_[contact]; }
    /// Returns the event at which a slip ends. @param state forward or backward
    std::size_t stop_event(std::size_t contact, ContactState state) const {
        return stop_events_[contact][state == ContactState::forward ? 0 : 1];
    }
    /// Returns whether contacts can be in these states at once: directions are independent.
    bool possible(std::size_t base, const ContactStates& states);
    /// Returns whether they also can move so, while they stay closed: slips that depend on one another.
    bool moves(std::size_t base, const ContactStates& states);
    /// Returns the variant, whose mode gets its rates now. Its events and transitions are made later.
    /// @param states a combination that moves
    const ContactVariant& variant(std::size_t base, const ContactStates& states);
    /// Returns the variants that have been asked for and are not complete; they then count as complete.
    std::vector<std::pair<std::size_t, ContactStates>> take_new();
    /// Returns a velocity map in which those states that follow from `zero` (velocities that vanish afterwards) are
    /// exact. @param changes of the velocities
    StateMap velocity_map(const std::vector<Expression>& changes, const std::vector<Expression>& zero);
    std::string mode_name(std::size_t base, const ContactStates& states) const;

private:
    void add_events();
    void require_separate_contacts();
    std::string contact_names(const std::vector<std::size_t>& contacts) const;
    ContactVariant made(std::size_t base, const ContactStates& states);

    Model& model_;
    const Places& places_;
    Expander expander_;
    SurfaceMotion motion_;
    std::vector<std::size_t> bases_;
    std::map<std::size_t, std::unique_ptr<ContactMechanics>> mechanics_;
    std::vector<std::size_t> gap_events_;
    std::vector<std::array<std::size_t, 2>> stop_events_;
    std::map<std::pair<std::size_t, ContactStates>, ContactVariant> variants_;
    std::map<std::pair<std::size_t, ContactStates>, bool> possible_, moves_;
    std::vector<std::pair<std::size_t, ContactStates>> new_;
};

/// Returns the written modes in which a model's contacts exist.
std::vector<std::size_t> modes_with_contacts(const Model& model);
/// Returns the names of all modes that contacts may make of one. @throws InputError when they are too many
std::vector<std::string> names_of_contact_modes(const Model& model, const Places& places, std::size_t base);

} // namespace graze
