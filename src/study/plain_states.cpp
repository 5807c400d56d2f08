#include "graze/study/plain_states.hpp"

#include <algorithm>

namespace graze {

namespace {

constexpr std::size_t most_default_histories = 6;

bool is_plain(const State& state) {
    return !state.period && !state.drifting;
}

} // namespace

std::vector<std::string> default_portrait(const Model& model) {
    std::vector<std::string> plain;
    const std::vector<Expression> rates = Model(model).expand(model.modes[model.initial_mode].rates);
    for (std::size_t i = 0; i < model.states.size(); ++i) {
        if (!is_plain(model.states[i]))
            continue;
        plain.push_back(model.states[i].name);
        const Expression& rate = rates[i];
        if (!rate.is_symbol())
            continue;
        const auto velocity = model.find_state(rate.name());
        if (velocity && *velocity != i && is_plain(model.states[*velocity]))
            return {model.states[i].name, model.states[*velocity].name};
    }
    plain.resize(std::min<std::size_t>(plain.size(), 2));
    return plain.size() == 2 ? plain : std::vector<std::string>{};
}

std::vector<std::string> plain_states(const Model& model) {
    std::vector<std::string> names;
    for (const State& state : model.states)
        if (is_plain(state) && names.size() < most_default_histories)
            names.push_back(state.name);
    return names;
}

std::string usual_section(const Model& model) {
    const auto phase =
        std::ranges::find_if(model.sections, [](const Section& section) { return section.state.has_value(); });
    return phase != model.sections.end() ? phase->name : model.sections.empty() ? "" : model.sections.front().name;
}

} // namespace graze
