#include "graze/results/model_table.hpp"

#include "model/model_words.hpp"

namespace graze {

std::vector<double> all_parameter_values(const Model& model) {
    std::vector<Expression> values;
    for (const Parameter& parameter : model.parameters)
        values.push_back(model.symbol(parameter.name));
    return model.values_of(values);
}

Table model_table(const Model& model) {
    Table table({{"item", ""}, {"name", ""}, {"value", ""}, {"unit", ""}, {"text", ""}});
    table.add("model", model.name, "", model.time_unit, model.text);
    const std::vector<double> parameters = all_parameter_values(model);
    for (std::size_t i = 0; i < parameters.size(); ++i)
        table.add("parameter", model.parameters[i].name, parameters[i], model.parameters[i].unit,
                  model.parameters[i].text);
    const std::vector<double> states = model.initial_state();
    for (std::size_t i = 0; i < states.size(); ++i)
        table.add("state", model.states[i].name, states[i], model.states[i].unit, model.states[i].text);
    for (const Definition& item : model.definitions)
        table.add("definition", item.name, formula(item.value), "", item.text);
    for (const Mode& item : model.modes) {
        table.add("mode", item.name, "", "", item.text);
        for (const std::size_t event : item.watched)
            table.add("watched event", item.name, model.events[event].name, "", "");
    }
    for (const Event& item : model.events)
        table.add(item.kind == EventKind::barrier ? "barrier" : "section event", item.name, formula(item.function), "",
                  item.text);
    for (const Jump& item : model.jumps)
        if (&item != &model.jumps.front())
            table.add("jump", item.name, "", "", item.text);
    for (const Transition& item : model.transitions)
        table.add("transition", item.label, transition_text(model, item), "", "");
    for (const Slide& item : model.slides) {
        table.add("slide", item.name, slide_text(model, item), "", item.text);
        for (const std::string& rate : sliding_rates(model, item))
            table.add("rate of a slide", item.name, rate, "", "");
    }
    for (const Friction& item : model.frictions)
        table.add("friction", item.name, friction_text(item), "", item.text);
    for (const UnilateralContact& item : model.contacts)
        table.add("contact", item.name, contact_text(item), "", item.text);
    for (const std::string& remark : contact_remarks(model))
        table.add("remark on contacts", "", remark, "", "");
    for (const Section& item : model.sections)
        table.add("section", item.name, section_text(model, item), "", item.text);
    for (const Symmetry& item : model.symmetries) {
        table.add("symmetry", item.name, "", "", item.text);
        for (const std::string& image : images_of(model, item))
            table.add("image", item.name, image, "", "");
    }
    for (const Quantity& item : model.quantities)
        table.add("quantity", item.name, formula(item.value), item.unit, item.text);
    for (const ConservedQuantity& item : model.conserved) {
        if (!item.value.empty())
            table.add("conserved quantity", item.name, formula(item.value), item.unit, item.text);
        for (const ConservedQuantity::InMode& own : item.modes)
            table.add("conserved in " + own.mode, item.name, formula(own.value), item.unit, item.text);
    }
    return table;
}

} // namespace graze
