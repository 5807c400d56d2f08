#include "study/run_forms.hpp"

#include "graze/base/name_list.hpp"
#include "graze/symbolic/parser.hpp"
#include "graze/symbolic/transform.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

/// An expression in states and parameters, which is added to the model's graph.
Expression parsed_start(const StudyReader& reader, Model& model, const TomlEntry& item) {
    Scope scope;
    for (const Parameter& parameter : model.parameters)
        scope.emplace(parameter.name, model.symbol(parameter.name));
    for (const State& state : model.states)
        scope.emplace(state.name, model.symbol(state.name));
    const Expression value = parse_expression(*model.graph, reader.toml().string(item), scope, reader.inside(item));
    return model.expand(value);
}

std::vector<std::string> names_in(const Expression& expression) {
    std::vector<std::string> names;
    for (const Expression& symbol : symbols_of({{expression}}))
        names.push_back(symbol.name());
    return names;
}

} // namespace

bool follows_what_varies(const StudyReader& reader, const StudyRun& run, const TomlEntry& item) {
    if (!run.has_motions() || !item.node->is_string())
        return false;
    try {
        Model scratch = run.model;
        const std::vector<std::string> names = names_in(parsed_start(reader, scratch, item));
        return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
            return run.varies(name) || run.model.find_state(name).has_value();
        });
    } catch (const InputError&) {
        return false; // mistakes are reported where the entry is read as a number
    }
}

void read_following_states(const StudyReader& reader, StudyRun& run, const TomlEntry& from) {
    std::vector<std::string> known = run.model.independent_parameters();
    for (const Variation& axis : run.motion().axes)
        if (axis.state)
            known.push_back(axis.name);
    reader.each_of(from, {}, [&](const TomlEntry& item) {
        const auto state = run.model.find_state(item.name);
        if (state && run.varies(item.name))
            throw InputError(item.place, fmt::format("'{}' varies: its initial value is said twice", item.name),
                             "leave it out here, or in `vary`");
        if (!state || !follows_what_varies(reader, run, item))
            return;
        const Expression value = parsed_start(reader, run.model, item);
        for (const std::string& name : names_in(value))
            if (run.model.find_state(name) && !run.varies(name))
                throw InputError(
                    reader.inside(item),
                    fmt::format("the initial value of '{}' depends on '{}', which does not vary", item.name, name),
                    fmt::format("use what varies, and parameters: {}", name_list(known)));
        run.motion().following.push_back({*state, value});
    });
}

void check_following_states(const StudyRun& run, const Place& place) {
    for (const FollowingState& one : run.motion().following) {
        const std::vector<std::string> names = names_in(one.value);
        const bool good = std::all_of(names.begin(), names.end(), [&](const std::string& name) {
            return run.varies(name) || run.model.find_independent_parameter(name).has_value();
        });
        if (!good || one.state >= run.model.states.size() || run.varies(run.model.states[one.state].name))
            throw InputError(place, "initial states follow from something that does not vary",
                             "run the study again, into another folder");
    }
}

} // namespace graze
