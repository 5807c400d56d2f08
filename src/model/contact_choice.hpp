#pragma once

#include "model/contact_modes.hpp"

#include <optional>
#include <string>
#include <vector>

namespace graze {

/// What is known of a contact where a mode is chosen. Its gap is zero unless it is open.
struct ContactKnowledge {
    enum class Normal {
        open,     ///< it is open, or separates
        unknown,  ///< it separates or not: the sign of its velocity decides
        touching, ///< the velocity of its gap is zero: forces decide whether it stays closed
    };
    Normal normal = Normal::open;
    /// Of a touching one: closed without friction, or the direction of its slip. None: the sign of the slip decides.
    std::optional<ContactState> slip{};
    bool at_rest = false; ///< its slip is zero: forces decide whether it sticks
};
using ContactsKnowledge = std::vector<ContactKnowledge>;

/// Says by alternatives which of the modes of contacts follows: that whose forces are consistent.
class ContactChoice {
public:
    ContactChoice(Model& model, ContactModes& modes) : model_(model), modes_(modes) {}

    /// If no mode is consistent, chooses that with most contacts closed, in which the motion ends at once and says why.
    void tell_paradox(bool tell) { tell_paradox_ = tell; }

    /// Leaves out the mode of these states, which has just come to its end. @param states none: leaves out no mode
    void leave_out(const ContactStates& states) { left_out_ = states; }

    /// Adds alternatives for what is known of the contacts. @param given conditions that hold in addition
    void add(std::vector<Alternative>& to, const Alternative& given, std::size_t base, ContactsKnowledge known);

private:
    Alternative without(Alternative given, const std::vector<Expression>& not_negative) const;
    bool add_by_sign(std::vector<Alternative>& to, const Alternative& given, std::size_t base,
                     ContactsKnowledge& known);
    bool follow_others(std::size_t base, ContactsKnowledge& known, std::size_t contact);
    void add_by_forces(std::vector<Alternative>& to, const Alternative& given, std::size_t base,
                       const ContactsKnowledge& known);
    static Expression with_roundoff(const ContactLimit& limit);
    void add_consistent(std::vector<Alternative>& to, const Alternative& given, std::size_t base,
                        const ContactsKnowledge& known, const ContactStates& states);

    Model& model_;
    ContactModes& modes_;
    bool tell_paradox_ = false;
    ContactStates left_out_{};
};

/// Adds a condition unless it always holds. @return false if it never holds
bool add_condition(std::vector<Condition>& to, const Expression& function, bool strict);

} // namespace graze
