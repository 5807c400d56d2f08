#include "model/model_completion.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/coefficients.hpp"
#include "model/contact_modes.hpp"
#include "model/model_expressions.hpp"
#include "model/model_validate.hpp"
#include "model/slide_corners.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>
#include <string>
#include <utility>

namespace graze {

namespace {

/// Returns what `complete` changes, as it is.
DeclaredParts parts_to_keep(const Model& model) {
    DeclaredParts parts{.modes = model.modes,
                        .events = model.events,
                        .jumps = model.jumps,
                        .transitions = model.transitions,
                        .symmetries = model.symmetries,
                        .slides = model.slides,
                        .initial_mode = model.initial_mode};
    if (model.drawing)
        for (const DrawnShape& shape : model.drawing->shapes)
            parts.modes_of_shapes.push_back(shape.modes);
    return parts;
}

bool same_expression(const Expression& one, const Expression& other) {
    return one.index() == other.index(); // both graphs are copies of one, and the second only grew
}

bool same_expressions(std::span<const Expression> one, std::span<const Expression> other) {
    return std::ranges::equal(one, other, same_expression);
}

bool same_when(const std::vector<Condition>& one, const std::vector<Condition>& other) {
    return std::ranges::equal(one, other, [](const Condition& a, const Condition& b) {
        return a.strict == b.strict && same_expression(a.function, b.function);
    });
}

bool same_conditions(const Alternative& one, const Alternative& other) {
    return one.mode == other.mode && same_when(one.when, other.when);
}

bool same_transition(const Transition& one, const Transition& other) {
    const bool chatter =
        one.chatter.has_value() == other.chatter.has_value() &&
        (!one.chatter || (one.chatter->jump == other.chatter->jump && one.chatter->mode == other.chatter->mode));
    const bool same_case = one.also == other.also && same_when(one.when, other.when);
    return chatter && same_case && one.label == other.label && one.mode == other.mode && one.event == other.event &&
           one.jump == other.jump && std::ranges::equal(one.next, other.next, same_conditions);
}

bool same_mode(const Mode& one, const Mode& other) {
    return one.name == other.name && one.text == other.text && one.watched == other.watched &&
           same_expressions(one.rates, other.rates);
}

bool same_event(const Event& one, const Event& other) {
    return one.name == other.name && one.text == other.text && one.kind == other.kind &&
           same_expression(one.function, other.function);
}

bool same_jump(const Jump& one, const Jump& other) {
    const std::vector<Expression> map = one.map, other_map = other.map;
    return one.name == other.name && one.text == other.text && same_expressions(map, other_map);
}

bool same_symmetry(const Symmetry& one, const Symmetry& other) {
    return one.name == other.name && one.text == other.text && one.modes == other.modes &&
           same_expressions(one.map, other.map);
}

bool same(const Event& one, const Event& other) {
    return one.function == other.function;
}
bool same(const Jump& one, const Jump& other) {
    return one.map == other.map;
}

template <class Item>
std::size_t derived_item(std::vector<Item>& items, const Places& places, const std::string& path, Item item,
                         const char* kind) {
    if (const auto known = find_named(items, item.name)) {
        if (!items[*known].derived || !same(items[*known], item))
            throw InputError(places.of(path),
                             fmt::format("{} makes the {} '{}', but there is one of this name", path, kind, item.name),
                             "rename what it is made for, or the other one");
        return *known;
    }
    item.derived = true;
    items.push_back(std::move(item));
    return items.size() - 1;
}

void add_derived_mode(Model& model, const Places& places, const std::string& path, std::string name) {
    if (const auto known = model.find_mode(name)) {
        if (!model.modes[*known].rates.empty())
            throw InputError(places.of(path),
                             fmt::format("{} makes the mode '{}', but there is one of this name", path, name),
                             "rename what it is made for, or the other one");
        model.modes[*known].derived = true;
        return;
    }
    model.modes.push_back({.name = std::move(name), .derived = true});
    for (Symmetry& symmetry : model.symmetries)
        symmetry.modes.push_back(model.modes.size() - 1);
}

} // namespace

std::vector<double> values_at_start(const Model& model, std::span<const Expression> expressions) {
    try {
        std::vector<double> inputs = model.initial_state();
        for (const double value : model.parameter_values())
            inputs.push_back(value);
        return model.function_of(expressions)(inputs);
    } catch (const InputError&) {
        return {}; // `validate` tells what is wrong with the initial state
    }
}

bool contains_symbol(const Expression& expression, const Expression& symbol) {
    const std::vector<Expression> symbols = symbols_of({&expression, 1});
    return std::ranges::find(symbols, symbol) != symbols.end();
}

std::size_t derived_event(Model& model, const Places& places, const std::string& path, Event event) {
    return derived_item(model.events, places, path, std::move(event), "event");
}

std::size_t derived_jump(Model& model, const Places& places, const std::string& path, Jump jump) {
    return derived_item(model.jumps, places, path, std::move(jump), "jump");
}

void visit_mode_indices(Model& model, const std::function<void(std::size_t&)>& visit) {
    for (Transition& transition : model.transitions) {
        visit(transition.mode);
        for (Alternative& alternative : transition.next)
            if (alternative.mode)
                visit(*alternative.mode);
        if (transition.chatter)
            visit(transition.chatter->mode);
    }
    for (Symmetry& symmetry : model.symmetries)
        for (std::size_t& mode : symmetry.modes)
            visit(mode);
    for (Slide& slide : model.slides) {
        visit(slide.left);
        visit(slide.right);
    }
    for (Alternative& alternative : model.initial_modes)
        visit(*alternative.mode);
    if (model.drawing)
        for (DrawnShape& shape : model.drawing->shapes)
            for (std::size_t& mode : shape.modes)
                visit(mode);
}

std::vector<RubbingMode> rubbing_modes(const Model& model) {
    std::vector<RubbingMode> result;
    std::vector<std::string> names;
    for (std::size_t mode = 0; mode < model.modes.size() && !model.frictions.empty(); ++mode) {
        names.clear();
        if (std::ranges::none_of(model.modes[mode].rates, &Expression::empty))
            for (const Expression& symbol : symbols_of(model.modes[mode].rates))
                names.push_back(symbol.name());
        RubbingMode rubbing{.mode = mode};
        for (std::size_t i = 0; i < model.frictions.size(); ++i)
            if (std::ranges::find(names, model.frictions[i].name) != names.end())
                rubbing.frictions.push_back(i);
        if (!rubbing.frictions.empty())
            result.push_back(std::move(rubbing));
    }
    return result;
}

void name_derived_modes(Model& model, const Places& places) {
    constexpr std::size_t most_frictions = 3;
    std::set<std::string> made;
    const auto add = [&](const std::string& path, const std::string& name) {
        if (!made.insert(name).second)
            throw InputError(places.of(path), fmt::format("{} makes a second mode '{}'", path, name),
                             "rename one of the two for which it is made");
        add_derived_mode(model, places, path, name);
    };
    for (const RubbingMode& rubbing : rubbing_modes(model)) {
        const std::string name = model.modes[rubbing.mode].name;
        if (rubbing.frictions.size() > most_frictions)
            throw InputError(places.of("modes." + name + ".rates"),
                             fmt::format("the mode '{}' has {} frictions", name, rubbing.frictions.size()),
                             fmt::format("a mode may have {}: join some, or write the modes out", most_frictions));
        std::vector<std::string> names{name};
        for (const std::size_t friction : rubbing.frictions) {
            std::vector<std::string> longer;
            for (const std::string& one : names)
                for (const std::string_view word : friction_words)
                    longer.push_back(fmt::format("{}-{}", one, word));
            names = std::move(longer);
            if (friction == rubbing.frictions.back())
                for (const std::string& one : names)
                    add("friction." + model.frictions[friction].name, one);
        }
    }
    for (const Slide& slide : model.slides)
        add("slides." + slide.name, slide.name);
    if (!model.contacts.empty())
        for (const std::size_t base : modes_with_contacts(model))
            for (const std::string& name : names_of_contact_modes(model, places, base))
                add("contacts", name);
}

void name_corner_modes(Model& model, const Places& places) {
    std::set<std::string> made;
    for (const Slide& slide : model.slides)
        made.insert(slide.name);
    for (const SlideCorner& corner : corners_of(model)) {
        const std::string path = "slides." + model.slides[corner.surfaces[0].above].name;
        if (!made.insert(corner.name).second)
            throw InputError(places.of(path), fmt::format("{} makes a second mode '{}'", path, corner.name),
                             "rename one of the two for which it is made");
        add_derived_mode(model, places, path, corner.name);
    }
}

void choose_initial_mode(Model& model) {
    if (model.initial_modes.empty())
        return;
    std::vector<Expression> functions;
    for (const Alternative& alternative : model.initial_modes)
        for (const Condition& condition : alternative.when)
            functions.push_back(condition.function);
    const std::vector<double> values = values_at_start(model, functions);
    if (values.empty())
        return;
    auto value = values.begin();
    for (const Alternative& alternative : model.initial_modes) {
        const auto end = value + static_cast<std::ptrdiff_t>(alternative.when.size());
        const bool holds = std::ranges::all_of(alternative.when, [&](const Condition& condition) {
            const double one = *value++;
            return condition.strict ? one > 0 : one >= 0;
        });
        value = end; // conditions after one that fails are not looked at
        if (holds) {
            model.initial_mode = *alternative.mode;
            return;
        }
    }
}

void complete_model(Model& model, const Places& places) {
    if (model.declared || (model.slides.empty() && model.frictions.empty() && model.contacts.empty()))
        return;
    Model made = model; // the given one stays as it is if this fails
    validate_declarations(made, places);
    check_contacts(made, places);
    check_coefficients(made, places);
    name_derived_modes(made, places);
    name_corner_modes(made, places);
    made.declared = std::make_shared<const DeclaredParts>(parts_to_keep(made));
    complete_frictions(made, places, rubbing_modes(made));
    complete_slides(made, places);
    complete_contacts(made, places);
    choose_initial_mode(made);
    model = std::move(made);
}

Model declared_model(const Model& model) {
    Model result = model;
    const DeclaredParts& parts = *model.declared;
    result.declared = nullptr;
    result.initial_modes.clear();
    result.modes = parts.modes;
    result.events = parts.events;
    result.jumps = parts.jumps;
    result.transitions = parts.transitions;
    result.symmetries = parts.symmetries;
    result.slides = parts.slides;
    if (result.drawing)
        for (std::size_t i = 0; i < result.drawing->shapes.size() && i < parts.modes_of_shapes.size(); ++i)
            result.drawing->shapes[i].modes = parts.modes_of_shapes[i];
    result.initial_mode = parts.initial_mode;
    if (model.initial_modes.empty())
        result.initial_mode =
            find_named(parts.modes, model.modes[model.initial_mode].name).value_or(parts.initial_mode);
    visit_expressions(result, [&](Expression& one) {
        if (!one.empty() && one.graph() != result.graph)
            one = result.graph->adopt(one);
    });
    return result;
}

bool is_as_declared(const Model& model) {
    if (!model.declared)
        return false;
    Model again = declared_model(model);
    try {
        again.complete();
    } catch (const InputError&) {
        return false;
    }
    return std::ranges::equal(model.modes, again.modes, same_mode) &&
           std::ranges::equal(model.events, again.events, same_event) &&
           std::ranges::equal(model.jumps, again.jumps, same_jump) &&
           std::ranges::equal(model.transitions, again.transitions, same_transition) &&
           std::ranges::equal(model.symmetries, again.symmetries, same_symmetry);
}

void Model::complete() {
    complete_model(*this, Places(name));
}

} // namespace graze
