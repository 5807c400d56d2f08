#include "graze/results/model_table.hpp"

#include "model/model_words.hpp"

#include <string_view>

namespace graze {

namespace {

/// Adds a row. @param value a number or a text
template <typename Value>
void add_row(Table& table, std::string_view item, std::string_view name, const Value& value, std::string_view unit,
             std::string_view text) {
    table.add(item);
    table.add(name);
    table.add(value);
    table.add(unit);
    table.add(text);
}

} // namespace

std::vector<double> all_parameter_values(const Model& model) {
    std::vector<Expression> values;
    for (const Parameter& parameter : model.parameters)
        values.push_back(model.symbol(parameter.name));
    return model.values_of(values);
}

Table model_table(const Model& model) {
    Table table({{"item", ""}, {"name", ""}, {"value", ""}, {"unit", ""}, {"text", ""}});
    add_row(table, "model", model.name, "", model.time_unit, model.text);
    const std::vector<double> parameters = all_parameter_values(model);
    for (std::size_t i = 0; i < parameters.size(); ++i)
        add_row(table, "parameter", model.parameters[i].name, parameters[i], model.parameters[i].unit,
                model.parameters[i].text);
    const std::vector<double> states = model.initial_state();
    for (std::size_t i = 0; i < states.size(); ++i)
        add_row(table, "state", model.states[i].name, states[i], model.states[i].unit, model.states[i].text);
    for (const Definition& item : model.definitions)
        add_row(table, "definition", item.name, formula(item.value), "", item.text);
    for (const Mode& item : model.modes) {
        add_row(table, "mode", item.name, "", "", item.text);
        for (const std::size_t event : item.watched)
            add_row(table, "watched event", item.name, model.events[event].name, "", "");
    }
    for (const Event& item : model.events)
        add_row(table, item.kind == EventKind::barrier ? "barrier" : "section event", item.name, formula(item.function),
                "", item.text);
    for (const Jump& item : model.jumps)
        if (&item != &model.jumps.front())
            add_row(table, "jump", item.name, "", "", item.text);
    for (const Transition& item : model.transitions)
        add_row(table, "transition", item.label, transition_text(model, item), "", "");
    for (const Section& item : model.sections)
        add_row(table, "section", item.name, section_text(model, item), "", item.text);
    for (const Symmetry& item : model.symmetries) {
        add_row(table, "symmetry", item.name, "", "", item.text);
        for (const std::string& image : images_of(model, item))
            add_row(table, "image", item.name, image, "", "");
    }
    for (const Quantity& item : model.quantities)
        add_row(table, "quantity", item.name, formula(item.value), item.unit, item.text);
    return table;
}

} // namespace graze
