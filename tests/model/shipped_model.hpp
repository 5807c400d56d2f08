#pragma once

#include "graze/model/model_file.hpp"
#include "model/evaluate_model.hpp"
#include "places.hpp"

#include <algorithm>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace graze::testing {

inline std::filesystem::path models_folder() {
    return std::filesystem::path(testing::source_folder) / "models";
}

inline Model shipped(const std::string& name) {
    return read_model((models_folder() / (name + ".toml")).string());
}

inline Expression event_function(const Model& model, const char* event) {
    return model.events[model.find_event(event).value()].function;
}

inline std::size_t mode_index(const Model& model, const char* mode) {
    return model.find_mode(mode).value();
}

/// Rates of the states in the mode of this name.
inline std::vector<double> rates(const Model& model, const char* mode, std::span<const double> state) {
    return evaluate(model, model.modes[mode_index(model, mode)].rates, state);
}

inline std::vector<double> jumped(const Model& model, std::size_t jump, std::span<const double> state) {
    const std::vector<Expression>& map = model.jumps[jump].map;
    return map.empty() ? std::vector<double>(state.begin(), state.end()) : evaluate(model, map, state);
}

inline double quantity(const Model& model, const char* name, std::span<const double> state) {
    return evaluate(model, model.quantities[model.find_quantity(name).value()].value, state);
}

/// Returns the name of the mode that follows a transition, by its guards, or "end".
inline std::string next_mode(const Model& model, const Transition& transition, std::span<const double> after) {
    for (const Alternative& alternative : transition.next) {
        const bool holds =
            std::all_of(alternative.when.begin(), alternative.when.end(), [&](const Condition& condition) {
                const double value = evaluate(model, condition.function, after);
                return condition.strict ? value > 0 : value >= 0;
            });
        if (holds)
            return alternative.mode ? model.modes[*alternative.mode].name : "end";
    }
    return "none";
}

} // namespace graze::testing
