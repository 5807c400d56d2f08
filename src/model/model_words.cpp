#include "model/model_words.hpp"

#include "graze/symbolic/transform.hpp"
#include "symbolic/subgraph.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace graze {

namespace {

/// Returns the number of operations in the text of an expression, which repeats shared parts.
double written_operations(const Expression& expression) {
    const Subgraph part = subgraph_of({&expression, 1});
    std::vector<double> counts;
    for (const Subgraph::Item& item : part.items) {
        const int operands = arity(part.node(item).operation);
        counts.push_back(1 + (operands > 0 ? counts[item.left] : 0) + (operands > 1 ? counts[item.right] : 0));
    }
    return counts.back();
}

} // namespace

std::string formula(const Expression& expression) {
    constexpr std::size_t longest = 100;
    constexpr double most_operations = 1e6;
    if (const double operations = written_operations(expression); operations > most_operations)
        return fmt::format("an expression with {:.3g} operations", operations);
    std::string text = to_string(expression);
    if (text.size() > longest) {
        text.resize(longest - 4);
        text += " ...";
    }
    return text;
}

std::string transition_text(const Model& model, const Transition& transition) {
    const auto through = [&](std::size_t jump) { return jump == 0 ? std::string() : " / " + model.jumps[jump].name; };
    std::vector<std::string> alternatives;
    for (const Alternative& alternative : transition.next)
        alternatives.push_back((alternative.mode ? model.modes[*alternative.mode].name : "end") +
                               (alternative.when.empty() ? "" : fmt::format(" [{}]", alternative.when_text)));
    std::string text =
        fmt::format("{}: {}{} -> {}", model.modes[transition.mode].name, model.events[transition.event].name,
                    through(transition.jump), fmt::join(alternatives, ", "));
    if (transition.chatter)
        text += fmt::format("; chatter{} -> {}", through(transition.chatter->jump),
                            model.modes[transition.chatter->mode].name);
    return text;
}

std::string watched_by(const Model& model, const Mode& mode) {
    std::vector<std::string> names;
    for (const std::size_t event : mode.watched)
        names.push_back(model.events[event].name);
    return names.empty() ? "" : fmt::format("watches {}", fmt::join(names, ", "));
}

std::string slide_text(const Model& model, const Slide& slide) {
    return fmt::format("{} = 0 between {} and {}, {}", model.events[slide.surface].name, model.modes[slide.left].name,
                       model.modes[slide.right].name,
                       slide.convention == SlideConvention::filippov ? "Filippov"
                                                                     : fmt::format("Utkin ({})", slide.control));
}

std::vector<std::string> sliding_rates(const Model& model, const Slide& slide) {
    std::vector<std::string> result;
    const auto mode = model.find_mode(slide.name);
    for (std::size_t i = 0; mode && i < model.modes[*mode].rates.size(); ++i)
        result.push_back(fmt::format("{}' = {}", model.states[i].name, formula(model.modes[*mode].rates[i])));
    return result;
}

std::string friction_text(const Friction& friction) {
    const std::string rest =
        friction.static_coefficient ? fmt::format(", at rest {}", formula(*friction.static_coefficient)) : "";
    return fmt::format("against {}: coefficient {}{}, normal force {}", formula(friction.velocity),
                       formula(friction.coefficient), rest, formula(friction.normal));
}

std::string section_text(const Model& model, const Section& section) {
    if (section.state)
        return fmt::format("{} = {}", model.states[*section.state].name, formula(section.value));
    const char* direction = section.direction == Direction::both      ? ""
                            : section.direction == Direction::falling ? ", falling"
                                                                      : ", rising";
    return formula(section.function) + " = 0" + direction;
}

std::vector<std::string> images_of(const Model& model, const Symmetry& symmetry) {
    std::vector<std::string> images;
    for (std::size_t i = 0; i < model.states.size(); ++i)
        if (symmetry.map[i] != model.symbol(model.states[i].name))
            images.push_back(fmt::format("{} -> {}", model.states[i].name, formula(symmetry.map[i])));
    return images;
}

} // namespace graze
