// Models of tests from their parts: what the models of many tests have in common is written here.

#pragma once

#include "trajectory/simulate.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace graze::testing {

/// Returns the model with other initial states.
inline Model started(Model model, const Settings& states) {
    for (const auto& [state, value] : states)
        model.set_initial(state, value);
    return model;
}

/// A transition of a model file. @param next mode that follows, or guarded alternatives as in a model file
inline std::string transition(const std::string& mode, const std::string& event, const std::string& next,
                              const std::string& jump = "", const std::string& label = "") {
    const auto line = [](const char* key, const std::string& value) {
        return value.empty() ? "" : fmt::format("{} = {}\n", key, value[0] == '[' ? value : '"' + value + '"');
    };
    return "[[transitions]]\n" + line("mode", mode) + line("event", event) + line("next", next) + line("jump", jump) +
           line("label", label);
}

/// Slides between the modes mm, mp, pm, pp, named by the signs of the functions of the events `front` and `side`; the
/// motion starts in pp. @param of_front, of_side further lines of the slides along each
inline std::string slides_between_quadrants(const std::string& of_front = "", const std::string& of_side = "") {
    const auto slide = [](const char* name, const char* surface, const char* left, const char* right) {
        return fmt::format("[slides.{}]\nsurface = '{}'\nbetween = ['{}', '{}']\n", name, surface, left, right);
    };
    return slide("upper", "front", "mp", "pp") + of_front + slide("lower", "front", "mm", "pm") + of_front +
           slide("right", "side", "pm", "pp") + of_side + slide("left", "side", "mm", "mp") + of_side +
           "[initial]\nmode = 'pp'\n";
}

/// A section where a function passes zero.
inline std::string section(const std::string& name, const std::string& function,
                           const std::string& direction = "rising") {
    return fmt::format("[sections.{}]\nfunction = '{}'\ndirection = '{}'\n", name, function, direction);
}

/// A section at a phase of the clock `theta`.
inline std::string at_phase(double phase, const std::string& name = "start") {
    return fmt::format("[sections.{}]\nstate = 'theta'\nvalue = {:.17g}\n", name, phase);
}

/// An event with a jump, after which the mode goes on.
struct Stop {
    std::string event, function;
    std::string jump = {};  ///< lines of the jump's table; empty: nothing jumps
    std::string label = {}; ///< of the transition; empty: none
    std::string next = "free", kind = "barrier";
};

/// A model with one mode, `free`. Parts are lines of the tables of a model file: a driven oscillator is
///     OneMode{.states = "x = 0\nv = 0", .rates = "x = 'v', v = 'cos(theta) - x'", .clock = "1.7"}
struct OneMode {
    std::string parameters = {}, states = {}, definitions = {};
    std::string rates = {}; ///< separated by commas
    std::string clock = {}; ///< rate of a state `theta`; empty: there is none
    std::string period = "2*pi";
    std::vector<Stop> stops = {};
    std::string more = {}; ///< further tables; without sections: phase 0 of the clock is the section `start`

    std::string text() const;
    Model model() const { return model_from(text()); }
};

/// A mode that an event ends.
struct Zone {
    std::string mode, rates;
    std::string event, function; ///< the event's name is also the label of its transition
    std::string jump = {};       ///< lines of the jump's table; empty: nothing jumps
};

/// A model with two modes that follow each other. Parts are those of a model with one mode.
struct TwoModes {
    std::string parameters = {}, states = {}, definitions = {}, clock = {}, period = "2*pi";
    Zone first = {}, second = {};
    std::string kind = "section"; ///< of both events
    std::string more = {};

    Model model() const;
};

/// The tables of parameters, states and definitions.
inline std::string head_of(const std::string& parameters, const std::string& states, const std::string& definitions,
                           const std::string& clock, const std::string& period) {
    return fmt::format("[parameters]\n{}\n[states]\n{}\n{}\n[definitions]\n{}\n", parameters, states,
                       clock.empty() ? "" : fmt::format("theta = {{ initial = 0, period = '{}' }}", period),
                       definitions);
}

/// The table of a mode. @param clock rate of the clock; empty: there is none @param watched names with quotation marks
inline std::string mode_of(const std::string& name, const std::string& rates, const std::string& clock,
                           const std::string& watched) {
    return fmt::format("[modes.{}]\nrates = {{ {}{} }}\nwatch = [{}]\n", name, rates,
                       clock.empty() ? "" : fmt::format(", theta = '{}'", clock), watched);
}

/// The tables of an event with its jump, which has the same name, and its transition.
inline std::string event_of(const std::string& mode, const std::string& event, const std::string& function,
                            const std::string& kind, const std::string& next, const std::string& jump,
                            const std::string& label) {
    return fmt::format("[events.{}]\nfunction = '{}'\nkind = '{}'\n", event, function, kind) +
           (jump.empty() ? "" : fmt::format("[jumps.{}]\n{}\n", event, jump)) +
           transition(mode, event, next, jump.empty() ? "" : event, label);
}

/// The section at phase 0 of a clock, unless there are others.
inline std::string sections_of(const std::string& clock, const std::string& more) {
    return clock.empty() || more.find("[sections.") != std::string::npos ? "" : at_phase(0);
}

inline std::string OneMode::text() const {
    std::string watched, events;
    for (const Stop& one : stops) {
        watched += fmt::format("'{}', ", one.event);
        events += event_of("free", one.event, one.function, one.kind, one.next, one.jump, one.label);
    }
    return head_of(parameters, states, definitions, clock, period) + mode_of("free", rates, clock, watched) + events +
           sections_of(clock, more) + more;
}

inline Model TwoModes::model() const {
    std::string text =
        head_of(parameters, states, definitions, clock, period) + fmt::format("[initial]\nmode = '{}'\n", first.mode);
    for (const auto& [one, other] : {std::pair(&first, &second), std::pair(&second, &first)}) {
        text += mode_of(one->mode, one->rates, clock, '"' + one->event + '"') +
                event_of(one->mode, one->event, one->function, kind, other->mode, one->jump, one->event);
    }
    return model_from(text + sections_of(clock, more) + more);
}

/// A model that jumps at the end of every unit of time, with a section halfway. Parts as for models with one mode.
inline Model ticking(const std::string& states, const std::string& rates, const std::string& jump) {
    return OneMode{.states = states + "\nc = 0",
                   .rates = rates + ", c = 1",
                   .stops = {{"tick", "1 - c", jump + "\nc = 0"}},
                   .more = section("half", "c - 0.5")}
        .model();
}

/// Integrate and fire: u' = current - u up to 1, then reset to 0; the period is log(current / (current - 1)).
inline Model integrate_and_fire(double current, const std::string& kind, const std::string& more = "") {
    return OneMode{.states = "u = 0",
                   .rates = fmt::format("u = '{:.17g} - u'", current),
                   .stops = {{"fire", "1 - u", "u = 0", "fire", "free", kind}},
                   .more = more}
        .model();
}

} // namespace graze::testing
