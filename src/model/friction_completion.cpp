// Frictions: the events and transitions of the modes that replace those with frictions.

#include "graze/base/input_error.hpp"
#include "model/friction_choice.hpp"
#include "model/friction_modes.hpp"
#include "model/model_completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace graze {

namespace {

class FrictionCompleter {
public:
    FrictionCompleter(Model& model, const Places& places, const std::vector<RubbingMode>& rubbing)
        : model_(model), places_(places), rubbing_(rubbing), modes_(model, places, rubbing), choice_(model, modes_) {}

    void run() {
        require_transitions();
        expand_transitions();
        for (const RubbingMode& rubbing : rubbing_)
            for (const FrictionVariant& variant : modes_.variants(rubbing.mode))
                add_friction_events(rubbing, variant);
        choose_start();
        show_in_drawing();
        remove_replaced();
    }

private:
    [[noreturn]] void fail(const std::string& path, const std::string& problem, const std::string& remedy) const {
        throw InputError(places_.of(path), problem, remedy);
    }
    const std::string& mode_name(std::size_t mode) const { return model_.modes[mode].name; }

    /// The motion cannot pass a barrier without a transition.
    void require_transitions() const {
        for (const RubbingMode& rubbing : rubbing_) {
            const Mode& mode = model_.modes[rubbing.mode];
            for (std::size_t i = 0; i < mode.watched.size(); ++i) {
                const Event& event = model_.events[mode.watched[i]];
                if (event.kind == EventKind::barrier &&
                    model_.find_transition(rubbing.mode, mode.watched[i]) == nullptr)
                    fail(fmt::format("modes.{}.watch.{}", mode.name, i + 1),
                         fmt::format("mode '{}' watches the barrier '{}' but has no transition for it", mode.name,
                                     event.name),
                         fmt::format(
                             "add [[transitions]] with mode = \"{}\" and event = \"{}\", or make the event a section",
                             mode.name, event.name));
            }
        }
    }

    /// Adds what an alternative that leads to a mode with frictions becomes. @param before the directions before the
    /// jump
    void add_expanded(std::vector<Alternative>& to, const Alternative& alternative, const RubbingMode& next,
                      std::size_t jump, bool same_mode, const FrictionStates& before) {
        FrictionStates states;
        std::vector<std::size_t> unknown, at_zero;
        const bool nothing_changes = jump == 0 && same_mode;
        for (const std::size_t law : next.frictions) {
            const auto known = before.find(law);
            if (known == before.end() || !modes_.keeps(jump, law))
                unknown.push_back(law);
            else if (known->second == FrictionState::stick && !nothing_changes)
                at_zero.push_back(law); // the force at rest may have changed
            else
                states[law] = known->second;
        }
        choice_.add_by_sign(to, alternative, next.mode, states, unknown, at_zero);
    }

    std::vector<Alternative> expanded(const Transition& transition, const FrictionStates& before) {
        std::vector<Alternative> result;
        for (const Alternative& alternative : transition.next) {
            const RubbingMode* next = alternative.mode ? modes_.rubbing(*alternative.mode) : nullptr;
            if (next == nullptr)
                result.push_back(alternative);
            else
                add_expanded(result, alternative, *next, transition.jump, *alternative.mode == transition.mode, before);
        }
        return result;
    }

    /// Returns where chatter leads. @param number of the transition in the file
    std::optional<Sticking> expanded_chatter(const Transition& transition, const FrictionStates& before,
                                             std::size_t number) {
        const RubbingMode* next = transition.chatter ? modes_.rubbing(transition.chatter->mode) : nullptr;
        if (next == nullptr)
            return transition.chatter;
        FrictionStates states;
        for (const std::size_t law : next->frictions) {
            if (!before.contains(law) || !modes_.keeps(transition.chatter->jump, law))
                fail(fmt::format("transitions.{}.chatter", number),
                     fmt::format("chatter leads to the mode '{}', and may change the velocity of its friction '{}'",
                                 mode_name(next->mode), modes_.laws()[law].name),
                     fmt::format("name one of the modes that the friction makes, such as \"{}\"",
                                 mode_name(modes_.variants(next->mode).front().mode)));
            states[law] = before.at(law);
        }
        return Sticking{transition.chatter->jump, modes_.variant(next->mode, states).mode};
    }

    /// Gives the transitions of a mode with frictions to all of its variants.
    void expand_transitions() {
        std::vector<Transition> given = std::move(model_.transitions), made;
        std::set<std::pair<std::size_t, std::size_t>> written;
        std::size_t alternatives = 0;
        for (const Transition& transition : given)
            written.emplace(transition.mode, transition.event);
        for (std::size_t number = 1; number <= given.size(); ++number) {
            const Transition& transition = given[number - 1];
            const RubbingMode* const from = modes_.rubbing(transition.mode);
            if (from == nullptr) {
                made.push_back(transition);
                made.back().next = expanded(transition, {});
                made.back().chatter = expanded_chatter(transition, {}, number);
                require_few(alternatives += made.back().next.size());
                continue;
            }
            for (const FrictionVariant& variant : modes_.variants(transition.mode)) {
                if (written.contains({variant.mode, transition.event}))
                    continue; // the user has written what happens there
                Transition one = transition;
                one.mode = variant.mode;
                one.label = mode_name(variant.mode) + ":" + label_of(transition);
                one.derived = true;
                one.next = expanded(transition, modes_.states_of(*from, variant));
                one.chatter = expanded_chatter(transition, modes_.states_of(*from, variant), number);
                require_few(alternatives += one.next.size());
                made.push_back(std::move(one));
            }
        }
        model_.transitions = std::move(made);
    }

    /// A few lines of a file must not become a model that fills the memory.
    void require_few(std::size_t alternatives) const {
        constexpr std::size_t most = 20'000;
        if (alternatives > most)
            fail("friction." + model_.frictions.front().name,
                 fmt::format("transitions between modes with frictions have more than {} alternatives", most),
                 "use fewer frictions in a mode, or fewer modes and transitions");
    }

    std::string label_of(const Transition& transition) const {
        const std::string& event = model_.events[transition.event].name;
        return transition.label == mode_name(transition.mode) + ":" + event ? event : transition.label;
    }

    void add_friction_events(const RubbingMode& rubbing, const FrictionVariant& variant) {
        for (std::size_t i = 0; i < rubbing.frictions.size(); ++i) {
            const std::size_t law = rubbing.frictions[i];
            if (variant.states[i] == FrictionState::stick)
                add_breaks(rubbing, variant, law);
            else
                add_stop(rubbing, variant, law, variant.states[i]);
        }
    }

    void add_transition(const RubbingMode& rubbing, const FrictionVariant& variant, std::size_t law, std::size_t event,
                        std::size_t jump, const std::string& what, std::vector<Alternative> next) {
        model_.modes[variant.mode].watched.push_back(event);
        const std::string of_law = rubbing.frictions.size() > 1 ? modes_.laws()[law].name + "-" : "";
        model_.transitions.push_back(
            {.label = fmt::format("{}:{}{}", mode_name(variant.mode), of_law, what),
             .mode = variant.mode,
             .event = event,
             .jump = jump,
             .next = std::move(next),
             .derived = true,
             .otherwise = fmt::format(
                 "after '{}' of the friction '{}' no combination of rest and slip is consistent: look at the masses in "
                 "the equations, which must be positive",
                 what, modes_.laws()[law].name)});
    }

    /// Adds the end of slip: rest if static friction holds, otherwise slip the other way.
    void add_stop(const RubbingMode& rubbing, const FrictionVariant& variant, std::size_t law,
                  FrictionState direction) {
        const bool forward = direction == FrictionState::forward;
        std::vector<Alternative> next;
        FrictionStates states = modes_.states_of(rubbing, variant);
        std::vector<std::size_t> at_zero = others_at_rest(rubbing, variant, law);
        at_zero.insert(std::ranges::upper_bound(at_zero, law), law);
        choice_.add_from_rest(next, {}, rubbing.mode, states, at_zero,
                              forward ? FrictionState::backward : FrictionState::forward);
        add_transition(rubbing, variant, law,
                       forward ? modes_.laws()[law].stops_forward : modes_.laws()[law].stops_backward,
                       modes_.laws()[law].stop, "stops", std::move(next));
    }

    std::vector<std::size_t> others_at_rest(const RubbingMode& rubbing, const FrictionVariant& variant,
                                            std::size_t law) const {
        std::vector<std::size_t> result;
        for (std::size_t i = 0; i < rubbing.frictions.size(); ++i)
            if (variant.states[i] == FrictionState::stick && rubbing.frictions[i] != law)
                result.push_back(rubbing.frictions[i]);
        return result;
    }

    /// Adds the ends of rest, at which the force reaches what static friction can hold.
    void add_breaks(const RubbingMode& rubbing, const FrictionVariant& variant, std::size_t law) {
        const FrictionLaw& one = modes_.laws()[law];
        const Expression force = variant.force.at(law);
        SlidingSurface along{.surface = one.stops_forward};
        const bool stays = modes_.stays(variant, law);
        for (const FrictionState direction : {FrictionState::backward, FrictionState::forward}) {
            const bool forward = direction == FrictionState::forward;
            const std::string_view word = friction_words[std::size_t(direction)];
            const std::string of_law = rubbing.frictions.size() > 1 ? one.name + "-" : "";
            const std::size_t event =
                derived_event(model_, places_, one.path,
                              {.name = fmt::format("{}-{}{}", mode_name(variant.mode), of_law, word),
                               .text = fmt::format("static friction gives way {}", word),
                               .function = forward ? one.limit - force : one.limit + force});
            along.exits[forward ? 1 : 0] = event;
            FrictionStates states = modes_.states_of(rubbing, variant);
            states[law] = direction;
            std::vector<Alternative> next;
            choice_.add_from_rest(next, {}, rubbing.mode, states, others_at_rest(rubbing, variant, law));
            add_transition(rubbing, variant, law, event, stays ? 0 : one.stop, std::string(word), std::move(next));
        }
        model_.modes[variant.mode].slides_on.push_back(along);
    }

    /// A start in a mode with frictions is in the variant of the initial velocities.
    void choose_start() {
        const RubbingMode* const first = modes_.rubbing(model_.initial_mode);
        if (first == nullptr)
            return;
        choice_.add_by_sign(model_.initial_modes, {}, first->mode, {}, first->frictions, {});
        model_.initial_mode = *model_.initial_modes.back().mode;
    }

    void show_in_drawing() const {
        if (!model_.drawing)
            return;
        for (DrawnShape& shape : model_.drawing->shapes) {
            std::vector<std::size_t> shown;
            for (const std::size_t mode : shape.modes)
                if (modes_.rubbing(mode) == nullptr)
                    shown.push_back(mode);
                else
                    for (const FrictionVariant& variant : modes_.variants(mode))
                        shown.push_back(variant.mode);
            shape.modes = std::move(shown);
        }
    }

    /// Removes the modes that have been replaced.
    void remove_replaced() {
        for (const Slide& slide : model_.slides)
            for (const std::size_t mode : {slide.left, slide.right})
                if (modes_.rubbing(mode) != nullptr)
                    fail("slides." + slide.name + ".between",
                         fmt::format("the slide '{}' is between modes with friction", slide.name),
                         "write the friction as a slide, or the sliding mode by hand");
        std::vector<std::size_t> places(model_.modes.size());
        std::vector<Mode> kept;
        for (std::size_t mode = 0; mode < places.size(); ++mode) {
            places[mode] = kept.size();
            if (modes_.rubbing(mode) == nullptr)
                kept.push_back(model_.modes[mode]);
        }
        for (Symmetry& symmetry : model_.symmetries) {
            std::vector<std::size_t> images;
            for (std::size_t mode = 0; mode < symmetry.modes.size(); ++mode) {
                if ((modes_.rubbing(mode) != nullptr || modes_.rubbing(symmetry.modes[mode]) != nullptr) &&
                    symmetry.modes[mode] != mode)
                    fail("symmetries." + symmetry.name + ".modes",
                         fmt::format("the symmetry '{}' exchanges modes with friction", symmetry.name),
                         "name the modes that the friction makes");
                if (modes_.rubbing(mode) == nullptr)
                    images.push_back(symmetry.modes[mode]);
            }
            symmetry.modes = std::move(images);
        }
        visit_mode_indices(model_, [&](std::size_t& mode) { mode = places[mode]; });
        model_.initial_mode = places[model_.initial_mode];
        model_.modes = std::move(kept);
    }

    Model& model_;
    const Places& places_;
    const std::vector<RubbingMode>& rubbing_;
    FrictionModes modes_;
    FrictionChoice choice_;
};

} // namespace

void complete_frictions(Model& model, const Places& places, const std::vector<RubbingMode>& rubbing) {
    if (!model.frictions.empty())
        FrictionCompleter(model, places, rubbing).run();
}

} // namespace graze
