#include "page/model_json.hpp"

#include "graze/model/drawing.hpp"
#include "graze/model/model_file.hpp"
#include "graze/results/model_table.hpp"
#include "graze/study/plain_states.hpp"
#include "page/json_text.hpp"
#include "page/quantity_json.hpp"
#include "page/simulation_json.hpp"
#include "picture/shown_names.hpp"

#include <optional>

namespace graze {

namespace {

nlohmann::json pair_json(const DrawnPair& pair) {
    return nlohmann::json::array({pair.x, pair.y});
}

nlohmann::json shape_json(const Model& model, const DrawnShape& shape) {
    nlohmann::json one{{"kind", name_of(shape.kind)}, {"colour", name_of(shape.colour)}};
    one["points"] = nlohmann::json::array();
    for (const DrawnPair& point : shape.points)
        one["points"].push_back(pair_json(point));
    if (shape.kind == ShapeKind::box)
        one["size"] = pair_json(shape.size);
    if (shape.kind == ShapeKind::circle)
        one["radius"] = shape.radius;
    if (shape.kind == ShapeKind::text)
        one["text"] = shape.text;
    one["modes"] = nlohmann::json::array();
    for (const std::size_t mode : shape.modes)
        one["modes"].push_back(model.modes.at(mode).name);
    return one;
}

nlohmann::json drawing_json(const Model& model) {
    const std::optional<SceneLimits> limits = scene_limits(model);
    if (!limits)
        return {};
    nlohmann::json one{{"text", model.drawing->text}};
    one["x"] = numbers_json(limits->x);
    one["y"] = numbers_json(limits->y);
    one["shapes"] = nlohmann::json::array();
    for (const DrawnShape& shape : model.drawing->shapes)
        one["shapes"].push_back(shape_json(model, shape));
    return one;
}

nlohmann::json parameters_of_model(const Model& model) {
    nlohmann::json list = parameters_json(model);
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Parameter& parameter = model.parameters[i];
        list[i]["text"] = parameter.text;
        list[i]["dependent"] = parameter.expression.has_value();
    }
    return list;
}

nlohmann::json states_of_model(const Model& model) {
    nlohmann::json list = nlohmann::json::array();
    const std::vector<double> initial = model.initial_state(), periods = model.periods();
    for (std::size_t i = 0; i < model.states.size(); ++i) {
        const State& state = model.states[i];
        list.push_back(quantity_json(state.name, state.unit, first_words(state.text)));
        list.back()["text"] = state.text;
        list.back()["initial"] = number_json(initial[i]);
        list.back()["cyclic"] = state.period.has_value();
        list.back()["period"] = state.period ? number_json(periods[i]) : nlohmann::json();
        list.back()["drifting"] = state.drifting;
    }
    return list;
}

} // namespace

nlohmann::json model_json(const Model& model, const std::string& text) {
    nlohmann::json one{{"name", model.name},
                       {"words", model.text},
                       {"source", model.source},
                       {"time_unit", model.time_unit},
                       {"text", text.empty() ? write_model(model) : text},
                       {"initial_mode", model.modes.at(model.initial_mode).name},
                       {"duration", number_json(usual_duration(model))},
                       {"histories", plain_states(model)},
                       {"portrait", default_portrait(model)}};
    one["parameters"] = parameters_of_model(model);
    one["states"] = states_of_model(model);
    one["quantities"] = nlohmann::json::array();
    for (const Quantity& quantity : model.quantities)
        one["quantities"].push_back(quantity_json(quantity.name, quantity.unit, first_words(quantity.text)));
    one["modes"] = nlohmann::json::array();
    for (const Mode& mode : model.modes)
        one["modes"].push_back({{"name", mode.name}, {"words", first_words(mode.text)}});
    one["events"] = nlohmann::json::array();
    for (const Event& event : model.events)
        one["events"].push_back({{"name", event.name}, {"words", first_words(event.text)}});
    one["drawing"] = drawing_json(model);
    return one;
}

} // namespace graze
