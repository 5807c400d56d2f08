#include "model/slide_events.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

void SlideEvents::watch_others(const Slide& slide) {
    const std::size_t sliding = *model_.find_mode(slide.name), rising = *model_.find_event(rising_name(slide));
    std::vector<std::size_t> watched = slide.watched.value_or(watched_by_both(slide));
    for (const std::size_t mode : {slide.right, slide.left}) // where surfaces meet, motions must not pass unnoticed
        for (const std::size_t event : model_.modes[mode].watched)
            if (meets(mode, event) && std::ranges::find(watched, event) == watched.end())
                watched.push_back(event);
    std::erase_if(watched, [&](std::size_t event) { return event == slide.surface || event == rising; });
    for (const std::size_t event : watched) {
        if (model_.find_transition(sliding, event) != nullptr)
            continue;
        if (meets(slide.left, event) || meets(slide.right, event)) {
            add_end(slide, event, sliding,
                    fmt::format("meets the surface of '{}', of another slide", event_name(event)));
            continue;
        }
        const bool only_recorded = model_.find_transition(slide.left, event) == nullptr &&
                                   model_.find_transition(slide.right, event) == nullptr &&
                                   model_.events[event].kind == EventKind::section;
        if (only_recorded)
            continue;
        auto made = shared_transition(slide, event, sliding);
        if (!made)
            throw InputError(
                places_.of("slides." + slide.name + (slide.watched ? ".watch" : ".between")),
                fmt::format("'{}' and '{}' do not go on alike after the event '{}', which the slide '{}' watches",
                            mode_name(slide.left), mode_name(slide.right), event_name(event), slide.name),
                fmt::format("add [[transitions]] with mode = \"{}\" and event = \"{}\", or name the events in watch",
                            slide.name, event_name(event)));
        model_.transitions.push_back(std::move(*made));
    }
    watch(sliding, std::move(watched));
}

void SlideEvents::watch_at_corner(const Slide& slide, const std::set<std::size_t>& known) {
    const std::size_t sliding = *model_.find_mode(slide.name);
    std::vector<std::size_t> watched = watched_by_both(slide);
    std::erase_if(watched, [&](std::size_t event) { return known.contains(event); });
    for (const std::size_t event : watched) {
        const Transition* const left = model_.find_transition(slide.left, event);
        const bool only_recorded = left == nullptr && model_.find_transition(slide.right, event) == nullptr &&
                                   model_.events[event].kind == EventKind::section;
        if (model_.find_transition(sliding, event) != nullptr || only_recorded)
            continue;
        auto made =
            left != nullptr && !left->otherwise.empty() ? std::nullopt : shared_transition(slide, event, sliding);
        if (made)
            model_.transitions.push_back(std::move(*made));
        else
            add_end(slide, event, sliding, fmt::format("along two surfaces meets the event '{}'", event_name(event)));
    }
    watch(sliding, std::move(watched));
}

/// Sets the events that a sliding mode watches: those that end it come last.
void SlideEvents::watch(std::size_t sliding, std::vector<std::size_t> watched) {
    for (const SlidingSurface& along : model_.modes[sliding].slides_on)
        watched.insert(watched.end(), along.exits.begin(), along.exits.end());
    model_.modes[sliding].watched = std::move(watched);
}

/// Returns the events that both sides watch, and barriers that one of them watches.
std::vector<std::size_t> SlideEvents::watched_by_both(const Slide& slide) const {
    const std::vector<std::size_t>&left = model_.modes[slide.left].watched, &right = model_.modes[slide.right].watched;
    const auto counts = [&](std::size_t event, const std::vector<std::size_t>& others) {
        return model_.events[event].kind == EventKind::barrier || std::ranges::find(others, event) != others.end();
    };
    std::vector<std::size_t> watched;
    for (const std::size_t event : right)
        if (counts(event, left))
            watched.push_back(event);
    for (const std::size_t event : left)
        if (counts(event, right) && std::ranges::find(watched, event) == watched.end())
            watched.push_back(event);
    return watched;
}

/// Adds a transition that ends the motion with a message.
void SlideEvents::add_end(const Slide& slide, std::size_t event, std::size_t sliding, const std::string& what) {
    Transition made{.label = slide.name + ":" + event_name(event), .mode = sliding, .event = event, .derived = true};
    made.otherwise = fmt::format("sliding {2}, and no rule says how the motion goes on: add [[transitions]] "
                                 "with mode = \"{1}\" and event = \"{0}\"",
                                 event_name(event), slide.name, what);
    made.next = {{.when = {{model_.number(-1), true}}, .when_text = "never", .mode = std::nullopt}};
    model_.transitions.push_back(std::move(made));
}

/// Returns the transition that both sides have for an event; nothing where they differ.
std::optional<Transition> SlideEvents::shared_transition(const Slide& slide, std::size_t event, std::size_t sliding) {
    const Transition* const left = model_.find_transition(slide.left, event);
    const Transition* const right = model_.find_transition(slide.right, event);
    if (left == nullptr || right == nullptr || left->jump != right->jump || left->next.size() != right->next.size())
        return std::nullopt;
    Transition made{.label = slide.name + ":" + event_name(event),
                    .mode = sliding,
                    .event = event,
                    .jump = left->jump,
                    .derived = true};
    const bool moved = leaves_surface(slide, made.jump);
    for (std::size_t i = 0; i < left->next.size(); ++i) {
        const Alternative &one = left->next[i], &other = right->next[i];
        const bool both_stay = one.mode == slide.left && other.mode == slide.right;
        if (one.when != other.when || (!both_stay && one.mode != other.mode))
            return std::nullopt;
        if (both_stay && moved)
            add_by_side(slide, one, made, sliding);
        else
            made.next.push_back({one.when, one.when_text, both_stay ? std::optional(sliding) : one.mode});
    }
    if (left->chatter && right->chatter && left->chatter->jump == right->chatter->jump &&
        left->chatter->mode == right->chatter->mode)
        made.chatter = left->chatter;
    return made;
}

/// Returns whether a jump may change the value of the surface's function.
bool SlideEvents::leaves_surface(const Slide& slide, std::size_t jump) {
    const Jump& one = model_.jumps[jump];
    if (one.map.empty())
        return false;
    const Expression function = motion_.expanded(model_.events[slide.surface].function);
    const std::vector<Expression> states = model_.state_symbols(),
                                  images = motion_.expanded(std::vector<Expression>(one.map));
    std::vector<Replacement> replacements;
    for (std::size_t i = 0; i < states.size(); ++i)
        replacements.emplace_back(states[i], images[i]);
    return !(substitute(function, replacements) == function);
}

/// After a jump that may leave the surface, its side decides.
void SlideEvents::add_by_side(const Slide& slide, const Alternative& alternative, Transition& made,
                              std::size_t sliding) const {
    const Expression& function = model_.events[slide.surface].function;
    const auto add = [&](std::optional<Condition> condition, const std::string& text, std::size_t mode) {
        Alternative one{alternative.when, alternative.when_text, mode};
        if (condition) {
            one.when.push_back(*condition);
            one.when_text += (one.when_text.empty() ? "" : " and ") + text;
        }
        made.next.push_back(std::move(one));
    };
    const std::string& name = event_name(slide.surface);
    add(Condition{function, true}, name + " > 0", slide.right);
    add(Condition{-function, true}, name + " < 0", slide.left);
    add(std::nullopt, "", sliding);
}

} // namespace graze
