#include "model/model_validate.hpp"

#include "graze/base/file_name.hpp"
#include "graze/base/input_errors.hpp"
#include "graze/base/name_list.hpp"
#include "graze/symbolic/parser.hpp"
#include "graze/symbolic/piece_table.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/model_drawing.hpp"
#include "model/model_expand.hpp"
#include "model/model_expressions.hpp"
#include "symbolic/lexer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_set>

namespace graze {

namespace {

void check_length(const std::string& name, const char* kind, const Place& place) {
    if (name.size() > longest_name)
        throw InputError(place, fmt::format("the name '{}' of a {} has {} letters", name, kind, name.size()),
                         fmt::format("shorten it to {}", longest_name));
}

/// Names of modes, events, ... may also contain hyphens: they never occur in expressions.
bool is_valid_label(std::string_view name) {
    return !name.empty() &&
           std::all_of(name.begin(), name.end(), [](char c) { return is_name_character(c) || c == '-'; });
}

/// Maps each name used in expressions to the kind of its item: parameter, state or definition.
class SymbolNames {
public:
    explicit SymbolNames(const Places& places) : places_(places) {}

    void add(const std::string& name, const char* kind, const std::string& path) {
        if (is_reserved_name(name))
            throw InputError(places_.of(path), fmt::format("'{}' is a reserved name and cannot name a {}", name, kind),
                             "choose another name");
        if (!is_valid_name(name))
            throw InputError(places_.of(path), fmt::format("'{}' cannot be the name of a {}", name, kind),
                             "names consist of letters, digits and underscores and do not start with a digit");
        check_length(name, kind, places_.of(path));
        const auto [other, is_new] = kinds_.emplace(name, kind);
        if (!is_new)
            throw InputError(
                places_.of(path),
                fmt::format("the name '{}' is used twice, for a {} and for a {}", name, other->second, kind),
                "rename one of them");
    }

private:
    const Places& places_;
    std::map<std::string, const char*> kinds_;
};

template <typename Item>
void check_labels(const std::vector<Item>& items, const char* kind, const std::string& group, const Places& places) {
    std::set<std::string> seen;
    for (const Item& item : items) {
        const std::string path = group + "." + item.name;
        if (!is_valid_label(item.name))
            throw InputError(places.of(path), fmt::format("'{}' cannot be the name of a {}", item.name, kind),
                             "names consist of letters, digits, underscores and hyphens");
        check_length(item.name, kind, places.of(path));
        if (!seen.insert(item.name).second)
            throw InputError(places.of(path), fmt::format("there are two {}s '{}'", kind, item.name),
                             "rename one of them");
    }
}

/// Checks a model step by step; each check throws at the first mistake.
class Validator {
public:
    Validator(const Model& model, const Places& places) : model_(model), places_(places) {}

    void run_declarations() const {
        validate_names(model_, places_);
        check_other_names();
        check_sizes();
        check_indices();
        require_own_expressions();
        check_circles();
    }

    void run() const {
        if (!model_.declared && !(model_.slides.empty() && model_.frictions.empty() && model_.contacts.empty()))
            fail("slides", "the model has slides, frictions or contacts whose modes have not been made",
                 "call Model::complete when all parts are there");
        if (model_.states.empty())
            fail("states", "the model has no states", "give at least one state, with its initial value, in [states]");
        if (model_.modes.empty())
            fail("modes", "the model has no modes", "give the rates of the states in a mode, [modes.<name>]");
        validate_names(model_, places_);
        check_other_names();
        check_sizes();
        check_indices();
        check_expressions();
        check_circles();
        Mistakes mistakes; // transitions and sections are checked independently
        std::set<std::pair<std::size_t, std::size_t>> with_transition, always;
        for (std::size_t i = 0; i < model_.transitions.size(); ++i)
            mistakes.attempt([&] { check_transition(i, with_transition, always); });
        for (const Mode& mode : model_.modes) {
            std::set<std::size_t> watched;
            for (std::size_t i = 0; i < mode.watched.size(); ++i)
                mistakes.attempt([&] { check_watched(mode, i, watched, with_transition); });
        }
        for (const Section& section : model_.sections)
            mistakes.attempt([&] { check_section(section); });
        mistakes.attempt([&] { check_values(); });
        mistakes.throw_noted();
        if (model_.drawing) // its limits are values at these parameters
            validate_drawing(model_, places_);
    }

private:
    [[noreturn]] void fail(std::string_view path, const std::string& problem, const std::string& remedy) const {
        throw InputError(places_.of(path), problem, remedy);
    }

    void check_other_names() const {
        check_labels(model_.modes, "mode", "modes", places_);
        check_labels(model_.events, "event", "events", places_);
        check_labels(model_.jumps, "jump", "jumps", places_);
        check_labels(model_.sections, "section", "sections", places_);
        check_labels(model_.symmetries, "symmetry", "symmetries", places_);
        if (model_.find_mode("end"))
            fail("modes.end", "a mode cannot be named 'end', which stands for the end of a trajectory",
                 "choose another name");
        if (model_.jumps.empty() || model_.jumps.front().name != "identity")
            fail("jumps", "the first jump is not the identity", "leave jump 0 of the model as it is");
        check_value_names(model_.quantities, "quantity", "quantities");
        check_value_names(model_.conserved, "conserved quantity", "conserved", "period");
    }

    /// @param reserved one more name that may not be used
    template <class Item>
    void check_value_names(const std::vector<Item>& items, const char* kind, const std::string& group,
                           std::string_view reserved = {}) const {
        std::set<std::string> seen;
        for (const Item& item : items) {
            const std::string path = group + "." + item.name;
            if (!is_valid_name(item.name) || item.name == reserved)
                fail(path, fmt::format("'{}' cannot be the name of a {}", item.name, kind),
                     "names consist of letters, digits and underscores, do not start with a digit and are not "
                     "reserved" +
                         (reserved.empty() ? std::string() : fmt::format(", as '{}' is", reserved)));
            check_length(item.name, kind, places_.of(path));
            if (!seen.insert(item.name).second || model_.find_state(item.name) || model_.find_parameter(item.name))
                fail(path, fmt::format("the name '{}' of a {} is used twice", item.name, kind), "rename one of them");
        }
    }

    void check_count(const std::string& path, std::size_t count, std::size_t expected, const char* of) const {
        if (count != expected)
            fail(path, fmt::format("{} has {} entries for {} {}", path, count, expected, of),
                 fmt::format("give one for each of the {}", of));
    }

    void check_sizes() const {
        const std::size_t states = model_.states.size();
        for (const Mode& mode : model_.modes)
            if (!mode.derived || !mode.rates.empty()) // a mode to be made has none
                check_count("modes." + mode.name + ".rates", mode.rates.size(), states, "states");
        for (std::size_t i = 0; i < model_.jumps.size(); ++i)
            if (i > 0 || !model_.jumps[i].map.empty())
                check_count("jumps." + model_.jumps[i].name, model_.jumps[i].map.size(), states, "states");
        if (const auto& identity = model_.jumps.front().map; !identity.empty() && identity != model_.state_symbols())
            fail("jumps.identity", "the jump 'identity' changes states", "give your jump another name");
        for (const Symmetry& symmetry : model_.symmetries) {
            check_count("symmetries." + symmetry.name + ".map", symmetry.map.size(), states, "states");
            check_count("symmetries." + symmetry.name + ".modes", symmetry.modes.size(), model_.modes.size(), "modes");
        }
    }

    void check_index(const std::string& path, std::size_t index, std::size_t count, const char* kind) const {
        if (index >= count)
            fail(path, fmt::format("{} refers to {} {}, but there are {} (counted from 0)", path, kind, index, count),
                 fmt::format("use an index below {}", count));
    }

    void check_indices() const {
        check_index("initial.mode", model_.initial_mode, model_.modes.size(), "mode");
        for (const Mode& mode : model_.modes)
            for (const std::size_t event : mode.watched)
                check_index("modes." + mode.name + ".watch", event, model_.events.size(), "event");
        for (std::size_t i = 0; i < model_.transitions.size(); ++i) {
            const Transition& transition = model_.transitions[i];
            const std::string path = fmt::format("transitions.{}", i + 1);
            check_index(path + ".mode", transition.mode, model_.modes.size(), "mode");
            check_index(path + ".event", transition.event, model_.events.size(), "event");
            check_index(path + ".jump", transition.jump, model_.jumps.size(), "jump");
            for (const std::size_t event : transition.also)
                check_index(path + ".also", event, model_.events.size(), "event");
            for (const Alternative& alternative : transition.next)
                check_index(path + ".next", alternative.mode.value_or(0), model_.modes.size(), "mode");
            if (transition.chatter) {
                check_index(path + ".chatter.jump", transition.chatter->jump, model_.jumps.size(), "jump");
                check_index(path + ".chatter.mode", transition.chatter->mode, model_.modes.size(), "mode");
            }
        }
        for (const Slide& slide : model_.slides) {
            const std::string path = "slides." + slide.name;
            check_index(path + ".surface", slide.surface, model_.events.size(), "event");
            check_index(path + ".between", slide.left, model_.modes.size(), "mode");
            check_index(path + ".between", slide.right, model_.modes.size(), "mode");
            for (const std::size_t event : slide.watched.value_or(std::vector<std::size_t>{}))
                check_index(path + ".watch", event, model_.events.size(), "event");
        }
        for (const std::size_t state : model_.contact_settings.velocities)
            check_index("contacts.velocities", state, model_.states.size(), "state");
        for (const std::size_t mode : model_.contact_settings.modes.value_or(std::vector<std::size_t>{}))
            check_index("contacts.modes", mode, model_.modes.size(), "mode");
        for (const Section& section : model_.sections)
            check_index("sections." + section.name + ".state", section.state.value_or(0), model_.states.size(),
                        "state");
        for (const Symmetry& symmetry : model_.symmetries)
            for (const std::size_t mode : symmetry.modes) {
                check_index("symmetries." + symmetry.name + ".modes", mode, model_.modes.size(), "mode");
                if (std::count(symmetry.modes.begin(), symmetry.modes.end(), mode) > 1)
                    fail("symmetries." + symmetry.name + ".modes",
                         fmt::format("the symmetry takes two modes to '{}'", model_.modes[mode].name),
                         "give each mode an image of its own");
            }
    }

    void require_own_expressions() const {
        const std::vector<Expression> parametric = expressions_of(model_, ExpressionRole::in_parameters),
                                      general = expressions_of(model_, ExpressionRole::general);
        const auto is_own = [&](const Expression& one) { return !one.empty() && one.graph() == model_.graph; };
        if (!std::all_of(parametric.begin(), parametric.end(), is_own) ||
            !std::all_of(general.begin(), general.end(), is_own))
            fail_expression();
    }

    void check_expressions() const {
        require_own_expressions();
        const std::vector<Expression> parametric = expressions_of(model_, ExpressionRole::in_parameters),
                                      general = expressions_of(model_, ExpressionRole::general);
        std::unordered_set<NodeIndex> parameters;
        for (const Parameter& parameter : model_.parameters)
            parameters.insert(model_.symbol(parameter.name).index());
        std::unordered_set<NodeIndex> symbols = parameters;
        for (const Expression& state : model_.state_symbols())
            symbols.insert(state.index());
        for (const Definition& definition : model_.definitions)
            symbols.insert(model_.symbol(definition.name).index());
        // Expressions share parts, so all are searched at once; the one to blame is only searched for if there is a
        // mistake.
        const auto is_wrong = [](const std::vector<Expression>& expressions,
                                 const std::unordered_set<NodeIndex>& allowed) {
            const std::vector<Expression> found = symbols_of(expressions);
            return std::any_of(found.begin(), found.end(),
                               [&](const Expression& symbol) { return allowed.count(symbol.index()) == 0; });
        };
        if (!is_wrong(parametric, parameters) && !is_wrong(general, symbols))
            return;
        for (const ModelExpression& item : model_expressions(model_))
            for (const Expression& symbol : symbols_of({&item.expression, 1}))
                if ((item.in_parameters ? parameters : symbols).count(symbol.index()) == 0)
                    fail_symbol(item, symbol.name());
    }

    /// Reports which expression is missing or belongs to another graph.
    void fail_expression() const {
        for (const ModelExpression& item : model_expressions(model_)) {
            if (item.expression.empty())
                fail(item.path, fmt::format("{} is missing", item.path), "give an expression");
            if (item.expression.graph() != model_.graph)
                fail(item.path, fmt::format("{} belongs to another graph", item.path),
                     "build all expressions of a model from its own symbols");
        }
    }

    [[noreturn]] void fail_symbol(const ModelExpression& item, const std::string& name) const {
        const Place place = places_.of_name(item.path, name);
        const bool is_state = model_.find_state(name).has_value();
        const bool is_definition = find_named(model_.definitions, name).has_value();
        if (is_state || is_definition)
            throw InputError(
                place, fmt::format("{} uses the {} '{}'", item.path, is_state ? "state" : "definition", name),
                is_state ? "write it in terms of parameters" : "make that a dependent parameter, or write it out");
        const bool is_control = std::any_of(model_.slides.begin(), model_.slides.end(),
                                            [&](const Slide& one) { return one.control == name; });
        if (is_control || find_named(model_.frictions, name))
            throw InputError(
                place, fmt::format("{} uses the {} '{}'", item.path, is_control ? "control" : "friction", name),
                is_control ? "write it in rates of the two modes of its slide only" : "write it in rates only");
        throw InputError(place, fmt::format("{} uses the unknown name '{}'", item.path, name),
                         "give it as a state, parameter or definition");
    }

    void check_circles() const {
        const std::vector<std::string> circle = find_circle(model_);
        if (circle.empty())
            return;
        const bool of_parameters = model_.find_parameter(circle.front()).has_value();
        const std::string path = (of_parameters ? "parameters." : "definitions.") + circle.front() + ".value";
        throw InputError(places_.of_name(path, circle[1]),
                         fmt::format("{} refer to one another in a circle: {}",
                                     of_parameters ? "dependent parameters" : "definitions", circle_text(circle)),
                         "define one of them without the others");
    }

    /// @param with_transition pairs (mode, event) of the earlier transitions
    /// @param always those of which one has no conditions
    void check_transition(std::size_t index, std::set<std::pair<std::size_t, std::size_t>>& with_transition,
                          std::set<std::pair<std::size_t, std::size_t>>& always) const {
        const Transition& transition = model_.transitions[index];
        const std::string path = fmt::format("transitions.{}", index + 1);
        const std::pair of_pair(transition.mode, transition.event);
        with_transition.insert(of_pair);
        if (transition.also.empty() && always.contains(of_pair))
            fail(path,
                 fmt::format("there is a second transition for event '{}' in mode '{}'",
                             model_.events[transition.event].name, model_.modes[transition.mode].name),
                 "write one transition with alternatives: next = [{ when = \"...\", mode = \"...\" }, ...]");
        if (transition.also.empty() && transition.when.empty())
            always.insert(of_pair);
        if (transition.next.empty())
            fail(path + ".next", fmt::format("{} does not say what comes next", path),
                 "give next = \"<mode>\", or \"end\"");
    }

    /// @param watched events that precede this one in the mode's list
    void check_watched(const Mode& mode, std::size_t place, std::set<std::size_t>& watched,
                       const std::set<std::pair<std::size_t, std::size_t>>& with_transition) const {
        const std::size_t index = mode.watched[place];
        const Event& event = model_.events[index];
        const std::string item = fmt::format("modes.{}.watch.{}", mode.name, place + 1);
        if (!watched.insert(index).second)
            fail(item, fmt::format("mode '{}' watches event '{}' twice", mode.name, event.name),
                 "remove one of the two");
        const auto of_mode = static_cast<std::size_t>(&mode - model_.modes.data());
        if (event.kind == EventKind::barrier && !with_transition.contains({of_mode, index}))
            fail(item,
                 fmt::format("mode '{}' watches the barrier '{}' but has no transition for it", mode.name, event.name),
                 fmt::format("add [[transitions]] with mode = \"{}\" and event = \"{}\", or make the event a "
                             "section",
                             mode.name, event.name));
    }

    void check_section(const Section& section) const {
        const std::string path = "sections." + section.name;
        if (section.state && !section.function.empty())
            fail(path, fmt::format("{} has both a function and a state", path), "keep one of the two");
        if (section.state && !model_.states[*section.state].period)
            fail(path + ".state",
                 fmt::format("{} is at a value of the state '{}', which is not cyclic", path,
                             model_.states[*section.state].name),
                 "give the state a period, or use function = \"...\"");
    }

    /// Checks the values at the present parameters.
    void check_values() const {
        for (const State& state : model_.states)
            if (state.period && state.drifting)
                fail("states." + state.name + ".drifting",
                     fmt::format("the state '{}' is both cyclic and drifting", state.name),
                     "leave out `drifting` if it comes back after its period, or else the period");
        for (const Parameter& parameter : model_.parameters) {
            const std::string path = "parameters." + parameter.name;
            if (parameter.value.has_value() == parameter.expression.has_value())
                fail(path, fmt::format("parameter '{}' must have either a value or an expression", parameter.name),
                     "give one of the two");
            if (parameter.value && !std::isfinite(*parameter.value))
                fail(path + ".value",
                     fmt::format("the value of parameter '{}' is {}", parameter.name, *parameter.value),
                     "give a finite number");
        }
        const std::vector<double> values = model_.values_of(expressions_of(model_, ExpressionRole::in_parameters));
        const auto bad = std::find_if(values.begin(), values.end(), [](double value) { return !std::isfinite(value); });
        if (bad != values.end())
            fail_value(static_cast<std::size_t>(bad - values.begin()), *bad);
        checked_initial_state(model_, places_);
    }

    /// Reports which of the expressions in parameters has no finite value.
    [[noreturn]] void fail_value(std::size_t index, double value) const {
        std::vector<ModelExpression> items = model_expressions(model_);
        std::erase_if(items, [](const ModelExpression& item) { return !item.in_parameters; });
        fail(items[index].path, fmt::format("{} is {} at these parameters", items[index].path, value),
             "look for a division by zero, or the root or logarithm of a negative number");
    }

    const Model& model_;
    const Places& places_;
};

} // namespace

std::string name_remedy(std::string_view name, const std::vector<std::string>& known) {
    const std::string near = nearest_name(name, known);
    if (!near.empty())
        return fmt::format("did you mean '{}'?", near);
    if (known.empty())
        return "there are none";
    return fmt::format("known: {}", name_list(known, name));
}

void validate_names(const Model& model, const Places& places) {
    SymbolNames names(places);
    for (const Parameter& parameter : model.parameters)
        names.add(parameter.name, "parameter", "parameters." + parameter.name);
    for (const State& state : model.states)
        names.add(state.name, "state", "states." + state.name);
    for (const Definition& definition : model.definitions)
        names.add(definition.name, "definition", "definitions." + definition.name);
    for (const Friction& friction : model.frictions)
        names.add(friction.name, "friction", "friction." + friction.name);
    for (const auto& table : model.graph->tables())
        names.add(table->name(), "table", "tables." + table->name());
    std::set<std::string> controls; // several slides may have one control
    for (const Slide& slide : model.slides)
        if (!slide.control.empty() && controls.insert(slide.control).second)
            names.add(slide.control, "control", "slides." + slide.name + ".control");
}

void validate_declarations(const Model& model, const Places& places) {
    Validator(model, places).run_declarations();
}

void validate_model(const Model& model, const Places& places) {
    Validator(model, places).run();
}

std::vector<double> checked_initial_state(const Model& model, const Places& places) {
    std::vector<Expression> expressions;
    for (const State& state : model.states) {
        expressions.push_back(state.initial);
        expressions.push_back(state.period.value_or(model.graph->number(1)));
    }
    const std::vector<double> values = model.values_of(expressions);
    std::vector<double> result;
    for (std::size_t i = 0; i < model.states.size(); ++i) {
        const std::string path = "states." + model.states[i].name;
        double value = values[2 * i];
        const double period = values[2 * i + 1];
        if (!std::isfinite(value))
            throw InputError(places.of(path + ".initial"),
                             fmt::format("the initial value of '{}' is {}", model.states[i].name, value),
                             "give a finite number, or an expression that is finite at these parameters");
        if (!(period > 0) || !std::isfinite(period))
            throw InputError(places.of(path + ".period"),
                             fmt::format("the period of '{}' is {}", model.states[i].name, period),
                             "a period must be positive and finite");
        if (model.states[i].period) {
            value = std::fmod(value, period);
            if (value < 0)
                value += period;
            // The sum of a tiny negative number and the period rounds to the period itself.
            if (value >= period)
                value = 0;
        }
        result.push_back(value);
    }
    return result;
}

} // namespace graze
