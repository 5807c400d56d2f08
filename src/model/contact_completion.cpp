// Contacts: the events, transitions and modes that a declaration of gaps stands for.

#include "graze/base/input_error.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/contact_choice.hpp"
#include "model/contact_impacts.hpp"
#include "model/contact_modes.hpp"
#include "model/model_completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace graze {

namespace {

using Normal = ContactKnowledge::Normal;

class ContactCompleter {
public:
    ContactCompleter(Model& model, const Places& places)
        : model_(model), places_(places), modes_(model, places), choice_(model, modes_), impacts_(model, modes_) {}

    void run() {
        for (const std::size_t base : modes_.bases())
            watched_[base] = model_.modes[base].watched;
        for (const Transition& transition : model_.transitions)
            written_.emplace(transition.mode, transition.event);
        own_ = model_.transitions.size();
        ask_for_named_modes();
        choose_start();
        for (auto open = modes_.take_new(); !open.empty(); open = modes_.take_new())
            for (const auto& [base, states] : open)
                complete(base, states);
        show_in_drawing();
        remove_unreached();
    }

private:
    /// What is known of the contacts under conditions.
    struct Case {
        Alternative given{};
        ContactsKnowledge known{};
    };

    [[noreturn]] void fail(const std::string& path, const std::string& problem, const std::string& remedy) const {
        throw InputError(places_.of(path), problem, remedy);
    }
    const std::string& mode_name(std::size_t mode) const { return model_.modes[mode].name; }
    const std::string& contact_name(std::size_t contact) const { return model_.contacts[contact].name; }

    /// Modes that the user names exist although no impact may lead to them.
    void ask_for_named_modes() {
        std::set<std::size_t> named{model_.initial_mode};
        for (const Transition& transition : model_.transitions) {
            named.insert(transition.mode);
            for (const Alternative& alternative : transition.next)
                named.insert(alternative.mode.value_or(model_.initial_mode));
            if (transition.chatter)
                named.insert(transition.chatter->mode);
        }
        for (const std::size_t base : modes_.bases())
            for (const ContactStates& states : all_states())
                if (const auto mode = model_.find_mode(modes_.mode_name(base, states)); mode && named.contains(*mode)) {
                    if (!modes_.moves(base, states))
                        refuse_mode(*mode, base, states);
                    modes_.variant(base, states);
                }
    }

    [[noreturn]] void refuse_mode(std::size_t mode, std::size_t base, const ContactStates& states) {
        std::vector<std::string> names;
        for (const ContactStates& others : all_states())
            if (modes_.moves(base, others))
                names.push_back(fmt::format("'{}'", modes_.mode_name(base, others)));
        fail(mode == model_.initial_mode ? "initial.mode" : "transitions",
             fmt::format("the mode '{}' does not exist: at the initial state its contacts {}", mode_name(mode),
                         modes_.possible(base, without_friction(states))
                             ? "do not stick or slip so: their slips depend on one another"
                             : "cannot be closed at once"),
             fmt::format("name one of {}", fmt::join(names, ", ")));
    }

    std::vector<ContactStates> all_states() const {
        std::vector<std::vector<ContactState>> options;
        for (const UnilateralContact& contact : model_.contacts)
            options.push_back(contact.friction ? std::vector{ContactState::open, ContactState::stick,
                                                             ContactState::forward, ContactState::backward}
                                               : std::vector{ContactState::open, ContactState::closed});
        return combinations(options);
    }

    /// A start in a written mode, at the surface of contacts and without normal velocity, is in the mode whose forces
    /// are consistent.
    void choose_start() {
        if (!modes_.is_base(model_.initial_mode))
            return;
        const std::size_t base = model_.initial_mode;
        std::vector<Alternative> starts;
        choice_.tell_paradox(true);
        add_starts(starts, base, {}, ContactsKnowledge(model_.contacts.size()), 0);
        choice_.tell_paradox(false);
        if (starts.size() == 1)
            return;
        for (Alternative& one : starts)
            if (one.mode)
                model_.initial_modes.push_back(std::move(one));
        model_.initial_mode = *model_.initial_modes.back().mode;
    }

    void add_starts(std::vector<Alternative>& to, std::size_t base, const Alternative& given,
                    const ContactsKnowledge& known, std::size_t contact) {
        if (contact == known.size())
            return choice_.add(to, given, base, known);
        ContactStates states(known.size(), ContactState::open);
        for (std::size_t i = 0; i < known.size(); ++i)
            if (i == contact || known[i].normal != Normal::open)
                states[i] = ContactState::closed;
        const ContactMechanics& mechanics = modes_.mechanics(base);
        if (modes_.possible(base, states)) {
            Alternative closed = given;
            for (const Expression& zero : {mechanics.gap(contact), mechanics.normal(contact).velocity}) {
                closed.when.push_back({zero, false});
                closed.when.push_back({-zero, false});
            }
            ContactsKnowledge more = known;
            more[contact].normal = Normal::touching;
            add_starts(to, base, closed, more, contact + 1);
        }
        add_starts(to, base, given, known, contact + 1);
    }

    void complete(std::size_t base, const ContactStates& states) {
        const ContactVariant variant = modes_.variant(base, states);
        std::vector<std::size_t> watched = watched_.at(base);
        model_.modes[variant.mode].watched.clear();
        for (std::size_t i = 0; i < states.size(); ++i)
            if (states[i] == ContactState::open && (may_close_too(base, states, i)))
                watched.push_back(modes_.gap_event(i));
        add_paradox(variant); // comes before the ends of contact, whose forces mean nothing beyond it
        std::vector<std::size_t>& all = model_.modes[variant.mode].watched;
        all.insert(all.end(), watched.begin(), watched.end());
        add_impacts(base, variant);
        for (std::size_t i = 0; i < states.size(); ++i)
            if (states[i] != ContactState::open)
                add_ends(base, variant, i);
        expand_transitions(base, variant);
        require_few();
    }

    bool may_close_too(std::size_t base, const ContactStates& states, std::size_t contact) {
        ContactStates more = states;
        more[contact] = ContactState::closed;
        return modes_.possible(base, without_friction(std::move(more)));
    }
    /// Returns which contacts are closed, whatever their friction does.
    static ContactStates without_friction(ContactStates states) {
        for (ContactState& state : states)
            if (state != ContactState::open)
                state = ContactState::closed;
        return states;
    }

    /// A few lines of a file must not become a model that fills the memory.
    void require_few() const {
        constexpr std::size_t most = 3000;
        if (model_.transitions.size() > most)
            fail("contacts." + model_.contacts.back().name,
                 fmt::format("the contacts make more than {} transitions", most),
                 "use fewer contacts, give friction to fewer of them, or take another law");
    }

    // --- impacts

    void add_impacts(std::size_t base, const ContactVariant& variant) {
        std::vector<std::size_t> open;
        for (std::size_t i = 0; i < variant.states.size(); ++i)
            if (variant.states[i] == ContactState::open && may_close_too(base, variant.states, i))
                open.push_back(i);
        for (std::size_t set = 1; set < std::size_t{1} << open.size(); ++set) {
            std::vector<std::size_t> closing;
            ContactStates normals = without_friction(variant.states);
            for (std::size_t k = 0; k < open.size(); ++k)
                if ((set >> k & 1U) != 0) {
                    closing.push_back(open[k]);
                    normals[open[k]] = ContactState::closed;
                }
            if (closing.size() > 1 &&
                (model_.contact_settings.law == ImpactLaw::sequence || !modes_.possible(base, normals)))
                continue;
            const std::vector<ContactImpact> impacts = impacts_.at(base, variant.states, closing);
            for (const ContactImpact& impact : impacts)
                add_impact(base, variant, closing, impact, impacts.size() > 1);
        }
    }

    void add_impact(std::size_t base, const ContactVariant& variant, const std::vector<std::size_t>& closing,
                    const ContactImpact& impact, bool one_of_many) {
        std::string words, names;
        for (const std::size_t contact : closing)
            names += (names.empty() ? "" : "-") + contact_name(contact);
        for (std::size_t i = 0; i < impact.active.size(); ++i)
            words += contact_words(contact_name(i), impact.active[i]);
        for (std::size_t i = 0, more = 0; i < impact.again.size(); ++i)
            if (impact.again[i] != ContactState::open)
                words += (more++ == 0 ? "-again" : "") + contact_words(contact_name(i), impact.again[i]);
        Transition made{.label = mode_name(variant.mode) + ":" + names,
                        .mode = variant.mode,
                        .event = modes_.gap_event(closing.front()),
                        .derived = true};
        if (written_.contains({made.mode, made.event}))
            return;
        if (one_of_many)
            made.label += ":" + case_name(variant, closing, words);
        made.label = unused_label(made.label);
        for (std::size_t k = 1; k < closing.size(); ++k)
            made.also.push_back(modes_.gap_event(closing[k]));
        made.when = impact.when;
        made.when_text = impact.when.empty() ? "" : "impulses of " + (words.empty() ? "none" : words.substr(1));
        made.jump =
            add_jump("impact" + words, "velocities after an impact", modes_.velocity_map(impact.changes, impact.zero));
        add_next(made, base, {{{}, impact.after}}, names);
        add_rest(made, base, variant, closing, impact);
        model_.transitions.push_back(std::move(made));
    }

    /// Names one of the cases of an impact by the contacts that take impulses, or by what the only one does.
    std::string case_name(const ContactVariant& variant, const std::vector<std::size_t>& closing,
                          const std::string& words) const {
        const std::string only = "-" + contact_name(closing.front()) + "-";
        const bool alone = closing.size() == 1 && std::ranges::count(variant.states, ContactState::open) ==
                                                      static_cast<std::ptrdiff_t>(variant.states.size());
        return words.empty() ? "none" : words.substr(alone && words.starts_with(only) ? only.size() : 1);
    }

    /// Adds where accumulating impacts lead: the contacts are closed.
    void add_rest(Transition& made, std::size_t base, const ContactVariant& variant,
                  const std::vector<std::size_t>& closing, const ContactImpact& impact) {
        ContactStates after = variant.states;
        std::string words;
        for (std::size_t i = 0; i < after.size(); ++i)
            if (impact.active[i] != ContactState::open)
                after[i] = impact.active[i];
        for (const std::size_t contact : closing)
            if (after[contact] == ContactState::open) // another contact keeps this one open, but normal speeds vanish
                after[contact] = rest_beside_others(base, after, contact);
        // The last impulses of a contact that is almost closed say no more of its slip.
        if (!modes_.moves(base, after))
            for (const std::size_t contact : closing)
                if (after[contact] != ContactState::closed)
                    after[contact] = rest_beside_others(base, after, contact);
        if (!modes_.moves(base, after))
            return;
        for (std::size_t i = 0; i < after.size(); ++i)
            words += contact_words(contact_name(i), after[i]);
        const std::size_t jump = add_jump("rest" + words, "velocities and gaps are set to zero exactly",
                                          impacts_.rest(base, variant.states, after, closing));
        made.chatter = Sticking{jump, modes_.variant(base, after).mode};
    }

    /// Returns what a contact that comes to rest with others does: it slips as they do if its slip follows from theirs.
    ContactState rest_beside_others(std::size_t base, const ContactStates& states, std::size_t contact) {
        if (!modes_.mechanics(base).rubs(contact))
            return ContactState::closed;
        const auto follows = modes_.mechanics(base).following_slip(contact, states);
        return follows ? follows->state : ContactState::stick;
    }

    /// Returns the jump with this map, made if there is none.
    std::size_t add_jump(const std::string& name, const std::string& text, const StateMap& map) {
        for (std::size_t number = 1;; ++number) {
            const std::string numbered = number == 1 ? name : fmt::format("{}-{}", name, number);
            const auto known = model_.find_jump(numbered);
            if (known && !(model_.jumps[*known].derived && model_.jumps[*known].map == map))
                continue;
            return known ? *known
                         : derived_jump(model_, places_, "contacts." + model_.contacts.front().name,
                                        {.name = numbered, .text = text, .map = map});
        }
    }

    std::string unused_label(const std::string& label) {
        std::string result = label;
        for (std::size_t number = 2; !labels_.insert(result).second; ++number)
            result = fmt::format("{}-{}", label, number);
        return result;
    }

    bool has_friction() const {
        return std::ranges::any_of(model_.contacts,
                                   [](const UnilateralContact& one) { return one.friction.has_value(); });
    }

    std::string no_solution(const std::string& what) const {
        return fmt::format("after '{}' no combination of closed contacts, rest and slip is consistent{}", what,
                           has_friction() ? ": Painlevé's paradox of rigid bodies with friction; end the motion before "
                                            "by an event, or take a smaller coefficient of friction"
                                          : ": the mass matrix is not positive definite there; correct `mass`");
    }

    // --- ends of contact, rest and slip

    /// Returns what is known of the contacts of a variant whose motion goes on.
    static ContactsKnowledge knowledge_of(const ContactStates& states) {
        ContactsKnowledge known(states.size());
        for (std::size_t i = 0; i < states.size(); ++i)
            if (states[i] == ContactState::stick)
                known[i] = {Normal::touching, std::nullopt, true};
            else if (states[i] != ContactState::open)
                known[i] = {Normal::touching, states[i], false};
        return known;
    }

    void add_ends(std::size_t base, const ContactVariant& variant, std::size_t contact) {
        std::vector<std::size_t> openings;
        for (const ContactLimit& limit : variant.force.limits) {
            const auto [first, beyond] = limit.beyond.front();
            if (first != contact || (beyond != ContactState::open && limit.beyond.size() == 1 &&
                                     modes_.mechanics(base).friction(contact).is_number(0)))
                continue;
            const std::size_t event = add_limit(base, variant, limit);
            if (beyond == ContactState::open)
                openings.push_back(event);
        }
        if (!openings.empty())
            model_.modes[variant.mode].slides_on.push_back(
                {modes_.gap_event(contact), {openings.front(), openings.back()}});
        const ContactState state = variant.states[contact];
        if (!is_slip(state))
            return;
        ContactsKnowledge known = knowledge_of(variant.states);
        known[contact] = {Normal::touching, std::nullopt, true};
        std::vector<Case> cases;
        add_stops(cases, {{}, known}, base, variant, contact, 0);
        add_transition(base, variant, modes_.stop_event(contact, state), contact_name(contact) + "-stops",
                       jump_to_rest(base, contact), cases);
    }

    /// Adds the event at which forces reach a limit. @return the event
    std::size_t add_limit(std::size_t base, const ContactVariant& variant, const ContactLimit& limit) {
        ContactsKnowledge known = knowledge_of(variant.states);
        ContactStates beyond = variant.states;
        std::size_t jump = 0;
        for (const auto& [contact, state] : limit.beyond) {
            known[contact] = {};
            beyond[contact] = state;
            if (!is_slip(state))
                continue;
            known[contact] = {Normal::touching, state, false};
            if (jump == 0)
                jump = jump_to_rest(base, contact);
        }
        std::string what = contact_name(limit.beyond.front().first), text;
        const bool opens = limit.beyond.front().second == ContactState::open;
        if (limit.beyond.size() > 1)
            what = joint_name(base, variant, limit, beyond);
        else
            what += opens ? "-opens" : contact_words("", limit.beyond.front().second).substr(1);
        text = opens ? fmt::format("the force in '{}' falls to zero", contact_name(limit.beyond.front().first))
                     : fmt::format("friction in '{}' gives way", contact_name(limit.beyond.front().first));
        const std::size_t event = derived_event(
            model_, places_, "contacts." + model_.contacts.front().name,
            {.name = fmt::format("{}-{}", mode_name(variant.mode), what), .text = text, .function = limit.function});
        const bool moves = modes_.moves(base, beyond);
        if (!moves) // others give way than those whose forces are at their limits
            known = knowledge_of(variant.states);
        choice_.leave_out(moves ? ContactStates{} : variant.states);
        add_transition(base, variant, event, what, jump, {{{}, known}});
        choice_.leave_out({});
        return event;
    }

    /// Names the end of a rest that contacts hold together: by the first one if all of them begin to slip.
    std::string joint_name(std::size_t base, const ContactVariant& variant, const ContactLimit& limit,
                           const ContactStates& beyond) {
        std::string name, first;
        for (const auto& [contact, state] : limit.beyond) {
            name += (name.empty() ? "" : "-") + contact_name(contact) +
                    (state == ContactState::open ? "-opens" : contact_words("", state).substr(1));
            if (first.empty())
                first = name;
        }
        const bool all = std::ranges::all_of(variant.force.limits, [&](const ContactLimit& other) {
            return other.beyond.size() == 1 ||
                   std::ranges::all_of(other.beyond, [&](const auto& one) { return is_slip(beyond[one.first]); });
        });
        const bool known = model_.find_event(fmt::format("{}-{}", mode_name(variant.mode), first)).has_value();
        return all && !known && modes_.moves(base, beyond) ? first : name;
    }

    /// Others whose slips follow from this one come to rest at once, unless their slips have different zeros.
    /// @param other the first of those that are not known yet
    void add_stops(std::vector<Case>& to, const Case& given, std::size_t base, const ContactVariant& variant,
                   std::size_t contact, std::size_t other) {
        const ContactMechanics& mechanics = modes_.mechanics(base);
        ContactStates stopped = variant.states;
        stopped[contact] = ContactState::stick;
        std::optional<ContactMechanics::FollowingSlip> follows;
        for (; other < variant.states.size(); ++other) {
            follows.reset();
            if (other != contact && is_slip(variant.states[other]))
                follows = mechanics.following_slip(other, stopped);
            if (follows && follows->state == ContactState::stick)
                break;
        }
        if (other == variant.states.size())
            return to.push_back(given);
        Case stops = given;
        if (!follows->apart.is_number(0)) {
            Case slips = given;
            if (add_condition(slips.given.when, follows->apart, true))
                add_stops(to, slips, base, variant, contact, other + 1);
            if (!add_condition(stops.given.when, -follows->apart, false))
                return;
        }
        stops.known[other] = {Normal::touching, std::nullopt, true};
        add_stops(to, stops, base, variant, contact, other + 1);
    }

    /// Returns the jump that removes the round-off of a slip that is zero.
    std::size_t jump_to_rest(std::size_t base, std::size_t contact) {
        const std::vector<Expression> still(model_.contact_settings.velocities.size(), model_.number(0));
        const std::vector<Expression> zero{modes_.mechanics(base).slip(contact).velocity};
        return add_jump("stop-" + contact_name(contact), "the slip is set to zero exactly",
                        modes_.velocity_map(still, zero));
    }

    /// Says what follows a transition, and why the motion ends where nothing does.
    void add_next(Transition& made, std::size_t base, const std::vector<Case>& cases, const std::string& what) {
        for (const Case& one : cases)
            choice_.add(made.next, one.given, base, one.known);
        if (made.next.empty())
            made.next.push_back(never());
        made.otherwise = no_solution(what);
        made.paradox = has_friction();
    }

    void add_transition(std::size_t base, const ContactVariant& variant, std::size_t event, const std::string& what,
                        std::size_t jump, const std::vector<Case>& cases) {
        model_.modes[variant.mode].watched.push_back(event);
        Transition made{.label = unused_label(fmt::format("{}:{}", mode_name(variant.mode), what)),
                        .mode = variant.mode,
                        .event = event,
                        .jump = jump,
                        .derived = true};
        if (written_.contains({made.mode, made.event}))
            return;
        add_next(made, base, cases, what);
        model_.transitions.push_back(std::move(made));
    }

    /// Where a determinant of the contact forces falls through zero the forces grow without bound, and beyond they are
    /// not the only ones or none exist.
    void add_paradox(const ContactVariant& variant) {
        add_limits(variant, variant.force.regular, "painleve", true,
                   "Painlevé's paradox of rigid bodies with friction: beyond this point the contact forces are not "
                   "determined; end the motion before by an event, or take a smaller coefficient of friction");
        add_limits(variant, variant.force.joint, "undetermined", false,
                   "contacts stick together whose slips do not depend on one another in the way they do at the initial "
                   "state: start in a general position, or give one of them no friction");
    }

    /// Adds events at which a motion ends because its forces cease to be determined.
    void add_limits(const ContactVariant& variant, const std::vector<Expression>& needed, const std::string& name,
                    bool paradox, const std::string& why) {
        for (std::size_t k = 0; k < needed.size(); ++k) {
            if (needed[k].is_number() && needed[k].node().value > 0)
                continue;
            const std::string what = needed.size() > 1 ? fmt::format("{}-{}", name, k + 1) : name;
            const std::size_t event = derived_event(model_, places_, "contacts." + model_.contacts.front().name,
                                                    {.name = fmt::format("{}-{}", mode_name(variant.mode), what),
                                                     .text = "contact forces with friction cease to be determined",
                                                     .function = needed[k]});
            model_.modes[variant.mode].watched.push_back(event);
            model_.transitions.push_back({.label = unused_label(fmt::format("{}:{}", mode_name(variant.mode), what)),
                                          .mode = variant.mode,
                                          .event = event,
                                          .next = {never()},
                                          .derived = true,
                                          .otherwise = why,
                                          .paradox = paradox});
        }
    }

    /// Returns an alternative that is never taken: the motion ends.
    Alternative never() const {
        return {.when = {{model_.number(-1), true}}, .when_text = "never", .mode = std::nullopt};
    }

    // --- transitions of the user

    /// Returns whether a jump leaves what decides on a contact as it is.
    bool keeps(std::size_t jump, std::size_t base, std::size_t contact) {
        const StateMap& map = model_.jumps[jump].map;
        if (map.empty())
            return true;
        const std::vector<Expression> states = model_.state_symbols(),
                                      images = modes_.motion().expanded(std::vector<Expression>(map));
        std::vector<Replacement> replacements;
        for (std::size_t i = 0; i < states.size(); ++i)
            replacements.emplace_back(states[i], images[i]);
        const ContactMechanics& mechanics = modes_.mechanics(base);
        const auto stays = [&](const Expression& one) { return substitute(one, replacements) == one; };
        return stays(mechanics.gap(contact)) && stays(mechanics.normal(contact).velocity) &&
               (!mechanics.rubs(contact) || stays(mechanics.slip(contact).velocity));
    }

    /// Gives a mode with closed contacts the transitions of the written one. Contacts stay closed if the jump does not
    /// act on them; otherwise they are open, and close at once if they approach.
    void expand_transitions(std::size_t base, const ContactVariant& variant) {
        if (variant.mode == base)
            return;
        for (std::size_t number = 0; number < own_; ++number) {
            const Transition given = model_.transitions[number];
            if (given.mode != base || written_.contains({variant.mode, given.event}))
                continue;
            Transition made = given;
            const std::string& event = model_.events[given.event].name;
            made.mode = variant.mode;
            made.label = unused_label(fmt::format("{}:{}", mode_name(variant.mode),
                                                  given.label == mode_name(base) + ":" + event ? event : given.label));
            made.derived = true;
            made.next.clear();
            for (const Alternative& alternative : given.next) {
                if (!alternative.mode || !modes_.is_base(*alternative.mode)) {
                    made.next.push_back(alternative);
                    continue;
                }
                ContactsKnowledge known = knowledge_of(variant.states);
                for (std::size_t i = 0; i < known.size(); ++i)
                    if (!keeps(given.jump, base, i))
                        known[i] = {};
                if (given.jump == 0 && *alternative.mode == base)
                    made.next.push_back({alternative.when, alternative.when_text, variant.mode});
                else
                    choice_.add(made.next, {alternative.when, alternative.when_text, {}}, *alternative.mode, known);
            }
            made.otherwise = no_solution(event);
            made.paradox = has_friction();
            model_.transitions.push_back(std::move(made));
        }
    }

    // --- the rest of the model

    void show_in_drawing() const {
        if (!model_.drawing)
            return;
        for (DrawnShape& shape : model_.drawing->shapes) {
            std::vector<std::size_t> shown = shape.modes;
            for (const std::size_t mode : shape.modes)
                if (modes_.is_base(mode))
                    for (std::size_t other = 0; other < model_.modes.size(); ++other)
                        if (model_.modes[other].derived &&
                            model_.modes[other].name.starts_with(mode_name(mode) + "-") &&
                            std::ranges::find(shown, other) == shown.end())
                            shown.push_back(other);
            shape.modes = std::move(shown);
        }
    }

    /// Removes the modes that nothing leads to: contacts that cannot be closed at once.
    void remove_unreached() {
        std::vector<std::size_t> places(model_.modes.size());
        std::vector<Mode> kept;
        for (std::size_t mode = 0; mode < places.size(); ++mode) {
            places[mode] = kept.size();
            if (!model_.modes[mode].rates.empty())
                kept.push_back(model_.modes[mode]);
        }
        for (Symmetry& symmetry : model_.symmetries) {
            std::vector<std::size_t> images;
            for (std::size_t mode = 0; mode < symmetry.modes.size(); ++mode) {
                if (model_.modes[mode].rates.empty() != model_.modes[symmetry.modes[mode]].rates.empty())
                    fail(
                        "symmetries." + symmetry.name + ".modes",
                        fmt::format("the symmetry '{}' takes the mode '{}' to '{}', and contacts make only one of them",
                                    symmetry.name, model_.modes[mode].name, mode_name(symmetry.modes[mode])),
                        "correct the images of modes, or the gaps so that the symmetry holds for them");
                if (!model_.modes[mode].rates.empty())
                    images.push_back(symmetry.modes[mode]);
            }
            symmetry.modes = std::move(images);
        }
        if (model_.drawing)
            for (DrawnShape& shape : model_.drawing->shapes)
                std::erase_if(shape.modes, [&](std::size_t mode) { return model_.modes[mode].rates.empty(); });
        visit_mode_indices(model_, [&](std::size_t& mode) { mode = places[mode]; });
        model_.initial_mode = places[model_.initial_mode];
        model_.modes = std::move(kept);
    }

    Model& model_;
    const Places& places_;
    ContactModes modes_;
    ContactChoice choice_;
    ContactImpacts impacts_;
    std::map<std::size_t, std::vector<std::size_t>> watched_; ///< of each written mode, by the user
    std::set<std::pair<std::size_t, std::size_t>> written_;   ///< mode and event of the user's transitions
    std::set<std::string> labels_;
    std::size_t own_ = 0; ///< number of the user's transitions
};

} // namespace

void complete_contacts(Model& model, const Places& places) {
    if (!model.contacts.empty())
        ContactCompleter(model, places).run();
}

} // namespace graze
