#include "graze/model/check.hpp"

#include "graze/base/printable.hpp"
#include "graze/model/conserved.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/check_symmetry.hpp"
#include "model/coefficients.hpp"
#include "model/model_drawing.hpp"
#include "model/model_expressions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace graze {

namespace {

/// Whether each item of a list is used.
using Used = std::vector<bool>;

/// The value to show: the sign of what is no number means nothing.
double unsigned_nan(double value) {
    return std::isnan(value) ? std::abs(value) : value;
}

class Checker {
public:
    explicit Checker(const Model& model) : model_(model) {
        for (std::size_t mode = 0; mode < model_.modes.size(); ++mode)
            for (const std::size_t event : model_.modes[mode].watched)
                watched_.emplace(mode, event);
        for (const Transition& transition : model_.transitions)
            with_transition_.emplace(transition.mode, transition.event);
    }

    std::vector<ModelWarning> run() {
        check_symbols();
        check_events();
        check_modes();
        check_jumps();
        check_transitions();
        check_start();
        check_coefficients();
        if (model_.drawing && !scene_limits(model_))
            warn_of("drawing",
                    "at these parameters the limits of the drawing are not finite, or not in order: it is not "
                    "shown");
        for (std::string& warning : symmetry_warnings(model_))
            warnings_.push_back({"", std::move(warning)});
        for (std::size_t i = 0; i < model_.conserved.size(); ++i)
            if (std::string none = why_no_first_integral(model_, i); !none.empty())
                warnings_.push_back(
                    {"", none + "; give an expression in states that no motion changes, or remove the declaration"});
            else if (std::string why = why_not_conserved(model_, i); !why.empty())
                warnings_.push_back({"", why + "; give this mode its own expression in `modes`, set what loses or "
                                               "gains to zero, such as damping, or remove the declaration"});
        return std::move(warnings_);
    }

private:
    template <typename... Arguments>
    void warn(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        warn_of("", format, std::forward<Arguments>(arguments)...);
    }
    template <typename... Arguments>
    void warn_of(const std::string& part, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        warnings_.push_back({part, fmt::format(format, std::forward<Arguments>(arguments)...)});
    }

    void check_symbols() {
        std::set<std::string> used;
        for (const ExpressionRole role : {ExpressionRole::in_parameters, ExpressionRole::general})
            for (const Expression& symbol : symbols_of(expressions_of(model_, role)))
                used.insert(symbol.name());
        for (const Expression& symbol : symbols_of(drawn_expressions(model_)))
            used.insert(symbol.name());
        for (const Parameter& parameter : model_.parameters)
            if (used.count(parameter.name) == 0)
                warn("nothing uses the parameter '{}'", parameter.name);
        for (const Definition& definition : model_.definitions)
            if (used.count(definition.name) == 0)
                warn("nothing uses the definition '{}'", definition.name);
    }

    void check_events() {
        Used watched(model_.events.size(), false);
        for (const Mode& mode : model_.modes)
            for (const std::size_t event : mode.watched)
                watched[event] = true;
        for (std::size_t i = 0; i < watched.size(); ++i)
            if (!watched[i] && !model_.events[i].derived)
                warn("no mode watches the event '{}'", model_.events[i].name);
    }

    void check_modes() {
        Used reached(model_.modes.size(), false);
        std::vector<std::size_t> open{model_.initial_mode};
        reached[model_.initial_mode] = true;
        const auto reach = [&](std::size_t mode) {
            if (!reached[mode])
                open.push_back(mode);
            reached[mode] = true;
        };
        std::vector<std::vector<const Transition*>> leaving(model_.modes.size());
        for (const Transition& transition : model_.transitions)
            if (is_watched(transition))
                leaving[transition.mode].push_back(&transition);
        while (!open.empty()) {
            const std::size_t mode = open.back();
            open.pop_back();
            for (const Transition* transition : leaving[mode]) {
                for (const Alternative& alternative : transition->next)
                    if (alternative.mode)
                        reach(*alternative.mode);
                if (transition->chatter)
                    reach(transition->chatter->mode);
            }
        }
        for (std::size_t i = 0; i < reached.size(); ++i)
            if (!reached[i] && !model_.modes[i].derived)
                warn("no transition leads from the initial mode '{}' to the mode '{}'",
                     model_.modes[model_.initial_mode].name, model_.modes[i].name);
    }

    bool is_watched(const Transition& transition) const {
        return watched_.contains({transition.mode, transition.event});
    }

    void check_jumps() {
        Used used(model_.jumps.size(), false);
        for (const Transition& transition : model_.transitions) {
            used[transition.jump] = true;
            if (transition.chatter)
                used[transition.chatter->jump] = true;
        }
        for (std::size_t i = 1; i < used.size(); ++i)
            if (!used[i] && !model_.jumps[i].derived)
                warn("no transition uses the jump '{}'", model_.jumps[i].name);
    }

    void check_transitions() {
        for (std::size_t i = 0; i < model_.modes.size(); ++i)
            for (const std::size_t event : model_.modes[i].watched)
                if (!with_transition_.contains({i, event}))
                    warn("mode '{}' watches the section '{}' but has no transition for it: nothing will happen there",
                         model_.modes[i].name, model_.events[event].name);
        std::set<std::string> labels;
        for (const Transition& transition : model_.transitions) {
            if (!labels.insert(transition.label).second)
                warn("two transitions have the label '{}'", transition.label);
            if (!is_watched(transition))
                warn("the transition '{}' is never taken: mode '{}' does not watch the event '{}'", transition.label,
                     model_.modes[transition.mode].name, model_.events[transition.event].name);
            if (transition.chatter && model_.events[transition.event].kind == EventKind::section)
                warn("the transition '{}' says where chatter leads, but '{}' is not a barrier", transition.label,
                     model_.events[transition.event].name);
            if (!transition.derived)
                check_alternatives(transition);
        }
    }

    void check_alternatives(const Transition& transition) {
        const auto& next = transition.next;
        const auto last = std::find_if(next.begin(), next.end(), [](const auto& item) { return item.when.empty(); });
        if (last == next.end())
            warn("the conditions of the transition '{}' may all fail: the motion ends where they do", transition.label);
        for (auto item = next.begin(); item != next.end(); ++item) {
            const bool repeated =
                std::any_of(next.begin(), item, [&](const auto& other) { return item->when == other.when; });
            if (repeated || item > last)
                warn("alternative {} of the transition '{}' is never taken: an earlier one always comes first",
                     item - next.begin() + 1, transition.label);
        }
    }

    /// Returns the values of expressions in the initial state.
    std::vector<double> at_start(const std::vector<Expression>& expressions) const {
        std::vector<double> values = model_.initial_state();
        for (const double value : model_.parameter_values())
            values.push_back(value);
        return model_.function_of(expressions)(values);
    }

    void check_start() {
        const Mode& mode = model_.modes[model_.initial_mode];
        const std::vector<double> rates = at_start(mode.rates);
        for (std::size_t i = 0; i < rates.size(); ++i)
            if (!std::isfinite(rates[i])) {
                const std::string reason = culprit(mode.rates[i]);
                warn("in the initial state the rate of '{}' is {}{}", model_.states[i].name, unsigned_nan(rates[i]),
                     reason.empty() ? "" : ", because " + reason);
            }
        std::vector<Expression> functions;
        for (const std::size_t event : mode.watched)
            functions.push_back(model_.events[event].function);
        const std::vector<double> values = at_start(functions);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const Event& event = model_.events[mode.watched[i]];
            if (!std::isfinite(values[i]))
                warn_of("events." + event.name, "in the initial state the event '{}' is {}", event.name,
                        unsigned_nan(values[i]));
            else if (values[i] < 0 && event.kind == EventKind::barrier)
                warn_of("events." + event.name,
                        "in the initial state the barrier '{}' is {}: the motion starts on the wrong side of it; give "
                        "the function the other sign, or begin where it is positive",
                        event.name, values[i]);
        }
    }

    /// Coefficients that depend on parameters or states may be out of their range at some values only.
    void check_coefficients() {
        const std::vector<Coefficient> all = coefficients_of(model_);
        std::vector<Expression> expressions;
        for (const Coefficient& one : all)
            expressions.push_back(one.value);
        const std::vector<double> values = at_start(expressions);
        for (std::size_t i = 0; i < all.size(); ++i)
            if (!all[i].allows(values[i]))
                warn_of(all[i].part(), "in the initial state {} is {}: it should be {}", all[i].what,
                        unsigned_nan(values[i]), all[i].allowed());
    }

    /// Returns the definition or dependent parameter in which a value first becomes non-finite: its own inputs are
    /// finite. Empty when this is the expression itself.
    std::string culprit(const Expression& expression) const {
        std::string result;
        std::vector<Expression> search{expression};
        while (true) {
            std::vector<Expression> used;
            for (const Expression& symbol : symbols_of(search))
                if (!expression_of(symbol).empty())
                    used.push_back(symbol);
            const std::vector<double> values = at_start(used);
            const auto bad = std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
            if (bad == values.end())
                return result;
            const Expression& symbol = used[static_cast<std::size_t>(bad - values.begin())];
            result = fmt::format("'{}' is {}", symbol.name(), *bad);
            search = {expression_of(symbol)};
        }
    }

    /// Returns the expression of a definition or dependent parameter.
    Expression expression_of(const Expression& symbol) const {
        for (const Definition& definition : model_.definitions)
            if (definition.name == symbol.name())
                return definition.value;
        for (const Parameter& parameter : model_.parameters)
            if (parameter.name == symbol.name() && parameter.expression)
                return *parameter.expression;
        return {};
    }

    const Model& model_;
    std::set<std::pair<std::size_t, std::size_t>> watched_, with_transition_; ///< mode and event
    std::vector<ModelWarning> warnings_;
};

/// Returns a string literal of the Graphviz language.
std::string dot_string(const std::string& text) {
    std::string line = text, result = "\"";
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == '\n' || c == '\t' || c == '\r'; }, ' ');
    for (const char c : printable_line(line)) {
        if (c == '"' || c == '\\')
            result += '\\';
        result += c;
    }
    return result + '"';
}

/// The arrows of the graph: one for all transitions from one mode to another, its label has a line for each.
class Arrows {
public:
    void add(const std::string& from, const std::string& to, const std::string& label, bool dashed) {
        for (Arrow& arrow : all_)
            if (arrow.from == from && arrow.to == to && arrow.dashed == dashed) {
                arrow.label.insert(arrow.label.size() - 1, "\\n" + within_quotes(label));
                return;
            }
        all_.push_back({from, to, dot_string(label), dashed});
    }
    std::string text() const {
        std::string result;
        for (const Arrow& arrow : all_)
            result += fmt::format("    {} -> {} [label = {}{}];\n", arrow.from, arrow.to, arrow.label,
                                  arrow.dashed ? ", style = dashed" : "");
        return result;
    }

private:
    static std::string within_quotes(const std::string& label) {
        const std::string quoted = dot_string(label);
        return quoted.substr(1, quoted.size() - 2);
    }
    struct Arrow {
        std::string from, to, label;
        bool dashed;
    };
    std::vector<Arrow> all_;
};

} // namespace

std::vector<ModelWarning> located_warnings(const Model& model) {
    return Checker(model).run();
}

std::vector<std::string> model_warnings(const Model& model) {
    model.validate();
    std::vector<std::string> texts;
    for (ModelWarning& warning : located_warnings(model))
        texts.push_back(std::move(warning.text));
    return texts;
}

std::string connectivity_graph(const Model& model) {
    model.validate();
    std::string result = fmt::format("digraph {} {{\n"
                                     "    rankdir = LR;\n"
                                     "    node [shape = box, style = rounded, fontname = \"Helvetica\"];\n"
                                     "    edge [fontname = \"Helvetica\", fontsize = 10];\n"
                                     "    start [shape = point];\n",
                                     dot_string(model.name));
    const auto node = [](std::optional<std::size_t> mode) { return mode ? fmt::format("mode{}", *mode) : "end"; };
    for (std::size_t i = 0; i < model.modes.size(); ++i)
        result += fmt::format("    {} [label = {}];\n", node(i), dot_string(model.modes[i].name));
    const auto ends = [](const Transition& transition) {
        return std::any_of(transition.next.begin(), transition.next.end(), [](const auto& item) { return !item.mode; });
    };
    if (std::any_of(model.transitions.begin(), model.transitions.end(), ends))
        result += "    end [shape = doublecircle, label = \"end\"];\n";
    result += fmt::format("    start -> {};\n", node(model.initial_mode));
    Arrows arrows;
    for (const Transition& transition : model.transitions) {
        const std::string& event = model.events[transition.event].name;
        const std::string default_label = model.modes[transition.mode].name + ":" + event;
        const std::string label = transition.label == default_label ? "" : transition.label + ": ";
        const auto through = [&](std::size_t jump) {
            return label + event + (jump == 0 ? "" : " / " + model.jumps[jump].name);
        };
        for (const Alternative& alternative : transition.next) {
            const std::string when = alternative.when.empty() ? "" : " [" + alternative.when_text + "]";
            arrows.add(node(transition.mode), node(alternative.mode), through(transition.jump) + when, false);
        }
        if (transition.chatter)
            arrows.add(node(transition.mode), node(transition.chatter->mode),
                       through(transition.chatter->jump) + " [chatter]", true);
    }
    result += arrows.text();
    return result + "}\n";
}

} // namespace graze
