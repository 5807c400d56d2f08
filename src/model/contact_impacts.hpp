#pragma once

#include "model/contact_choice.hpp"
#include "model/vanishing.hpp"

#include <string>
#include <vector>

namespace graze {

/// One solution of the law of impact: which contacts take impulses, and when it is this one.
struct ContactImpact {
    ContactStates active{};            ///< `open`: takes no impulse
    ContactStates again{};             ///< of Poisson's law: takes more in expansion than e times its compression
    std::vector<Expression> changes{}; ///< of the velocities
    std::vector<Expression> zero{};    ///< velocities that vanish after it
    std::vector<Condition> when{};     ///< before the impact
    ContactsKnowledge after{};
};

/// Solves the law of impact for all combinations of contacts that take impulses (Pfeiffer and Glocker 1996; Moreau
/// 1988; Leine and van de Wouw 2008, chapter 5).
class ContactImpacts {
public:
    ContactImpacts(Model& model, ContactModes& modes) : model_(model), modes_(modes), inputs_(model) {}

    /// Returns the possible impacts of contacts that close at once while others are closed.
    /// @param closed states before; @param closing contacts that are open before
    std::vector<ContactImpact> at(std::size_t base, const ContactStates& closed,
                                  const std::vector<std::size_t>& closing) const;
    /// Returns the change of velocities by which contacts come to rest in these states: with impulses that are plastic.
    StateMap rest(std::size_t base, const ContactStates& closed, const ContactStates& after,
                  const std::vector<std::size_t>& closing) const;

private:
    struct Meeting;
    std::vector<Expression> zeros(std::size_t base, const ContactStates& closed,
                                  const std::vector<std::size_t>& closing) const;
    bool solve_at_once(const Meeting& meeting, ContactImpact& impact) const;
    bool solve_poisson(const Meeting& meeting, const ContactStates& compressed, ContactImpact& impact) const;
    void note_after(const Meeting& meeting, ContactImpact& impact) const;
    bool put_onto_gaps(StateMap& map, const Meeting& meeting) const;
    Expression restitution(std::size_t contact) const;

    Model& model_;
    ContactModes& modes_;
    RandomInputs inputs_;
};

} // namespace graze
