#include "model/model_expressions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <unordered_map>

namespace graze {

namespace {

enum class Role {
    general,       ///< may contain anything
    in_parameters, ///< may contain parameters only
    unused,        ///< never evaluated
};

/// Expressions shared by several state maps; each is visited once.
class SharedImages {
public:
    /// Visits the images that a map uses and that have not been visited. @param visit receives a state and its image
    template <class Visit>
    void visit(const StateMap& map, const Visit& visit) {
        if (map.empty())
            return;
        const std::vector<Expression>& images = *map.shared();
        auto [found, added] = unvisited_.try_emplace(&images);
        std::vector<std::size_t>& unvisited = found->second;
        if (added) {
            unvisited.resize(images.size());
            std::iota(unvisited.begin(), unvisited.end(), std::size_t{0});
        }
        const auto changes = map.changes();
        std::erase_if(unvisited, [&](std::size_t state) {
            const bool used = !std::ranges::binary_search(changes, state, {}, &StateMap::Change::state);
            if (used)
                visit(state, images[state]);
            return used;
        });
    }

private:
    std::map<const std::vector<Expression>*, std::vector<std::size_t>> unvisited_;
};

/// Visits all expressions of a model, in the order of the file.
/// @param visit receives an expression, its role, and a function that returns its path (seldom needed)
/// @param visit_map receives the map of a jump and a function that returns the path of a state's image
template <class AnyModel, class Visit, class VisitMap>
void walk(AnyModel& model, const Visit& visit, const VisitMap& visit_map) {
    const auto visit_each_state = [&](auto& expressions, const auto& prefix) {
        for (std::size_t i = 0; i < expressions.size(); ++i)
            visit(expressions[i], Role::general, [&] { return prefix() + "." + model.states[i].name; });
    };
    const auto visit_optional = [&](auto& expression, const auto& path) {
        if (expression)
            visit(*expression, Role::in_parameters, path);
    };
    for (auto& parameter : model.parameters)
        visit_optional(parameter.expression, [&] { return "parameters." + parameter.name + ".value"; });
    for (auto& state : model.states) {
        visit(state.initial, Role::in_parameters, [&] { return "states." + state.name + ".initial"; });
        visit_optional(state.period, [&] { return "states." + state.name + ".period"; });
    }
    for (auto& definition : model.definitions)
        visit(definition.value, Role::general, [&] { return "definitions." + definition.name + ".value"; });
    for (auto& mode : model.modes)
        visit_each_state(mode.rates, [&] { return "modes." + mode.name + ".rates"; });
    for (auto& mode : model.modes)
        for (auto& end : mode.ends)
            visit(end, Role::general, [&] { return "modes." + mode.name + ".watch"; });
    for (auto& event : model.events)
        visit(event.function, Role::general, [&] { return "events." + event.name + ".function"; });
    for (auto& jump : model.jumps)
        visit_map(jump.map, [&](std::size_t state) { return "jumps." + jump.name + "." + model.states[state].name; });
    for (std::size_t i = 0; i < model.transitions.size(); ++i) {
        for (auto& condition : model.transitions[i].when)
            visit(condition.function, Role::general, [&] { return fmt::format("transitions.{}.when", i + 1); });
        for (std::size_t k = 0; k < model.transitions[i].next.size(); ++k)
            for (auto& condition : model.transitions[i].next[k].when)
                visit(condition.function, Role::general,
                      [&] { return fmt::format("transitions.{}.next.{}.when", i + 1, k + 1); });
    }
    for (auto& section : model.sections) {
        visit(section.function, section.state ? Role::unused : Role::general,
              [&] { return "sections." + section.name + ".function"; });
        visit(section.value, section.state ? Role::in_parameters : Role::unused,
              [&] { return "sections." + section.name + ".value"; });
    }
    for (auto& symmetry : model.symmetries)
        visit_each_state(symmetry.map, [&] { return "symmetries." + symmetry.name + ".map"; });
    for (auto& friction : model.frictions) {
        const auto path = [&](const char* key) { return "friction." + friction.name + "." + key; };
        visit(friction.velocity, Role::general, [&] { return path("velocity"); });
        visit(friction.normal, Role::general, [&] { return path("normal"); });
        visit(friction.coefficient, Role::general, [&] { return path("coefficient"); });
        if (friction.static_coefficient)
            visit(*friction.static_coefficient, Role::general, [&] { return path("static"); });
    }
    for (auto& mass : model.contact_settings.mass)
        visit(mass, Role::general, [] { return std::string("contacts.mass"); });
    for (auto& contact : model.contacts) {
        const auto path = [&](const char* key) { return "contacts." + contact.name + "." + key; };
        visit(contact.gap, Role::general, [&] { return path("gap"); });
        visit(contact.restitution, Role::general, [&] { return path("restitution"); });
        if (contact.friction)
            visit(*contact.friction, Role::general, [&] { return path("friction"); });
        if (contact.slip)
            visit(*contact.slip, Role::general, [&] { return path("slip"); });
    }
    for (auto& alternative : model.initial_modes)
        for (auto& condition : alternative.when)
            visit(condition.function, Role::general, [] { return std::string("initial.mode"); });
    for (auto& quantity : model.quantities)
        visit(quantity.value, Role::general, [&] { return "quantities." + quantity.name + ".value"; });
    for (auto& conserved : model.conserved) {
        visit(conserved.value, conserved.value.empty() ? Role::unused : Role::general,
              [&] { return "conserved." + conserved.name + ".value"; });
        for (auto& own : conserved.modes)
            visit(own.value, Role::general, [&] { return "conserved." + conserved.name + ".modes." + own.mode; });
    }
}

/// The same for a constant model. Images shared by jumps are visited once.
template <class Visit>
void walk(const Model& model, const Visit& visit) {
    SharedImages shared;
    walk(model, visit, [&](const StateMap& map, const auto& path) {
        const auto visit_state = [&](std::size_t state, const Expression& image) {
            visit(image, Role::general, [&] { return path(state); });
        };
        shared.visit(map, visit_state);
        for (const StateMap::Change& change : map.changes())
            visit_state(change.state, change.image);
    });
}

} // namespace

std::vector<ModelExpression> model_expressions(const Model& model) {
    std::vector<ModelExpression> result;
    walk(model, [&](const Expression& expression, Role role, const auto& path) {
        if (role != Role::unused)
            result.push_back({path(), expression, role == Role::in_parameters});
    });
    return result;
}

std::vector<Expression> expressions_of(const Model& model, ExpressionRole wanted) {
    std::vector<Expression> result;
    walk(model, [&](const Expression& expression, Role role, const auto&) {
        if (role == (wanted == ExpressionRole::general ? Role::general : Role::in_parameters))
            result.push_back(expression);
    });
    return result;
}

StateChanges changes_of(const StateMap& map, std::span<const Expression> states,
                        std::shared_ptr<const std::vector<Expression>>& identity) {
    StateChanges changes;
    if (map.empty())
        return changes; // an empty map is the identity
    const auto add = [&](std::size_t state, const Expression& image) {
        if (!(image == states[state]))
            changes.push_back({state, image});
    };
    if (map.shared() != identity && std::ranges::equal(*map.shared(), states))
        identity = map.shared();
    if (map.shared() == identity)
        for (const StateMap::Change& change : map.changes())
            add(change.state, change.image);
    else
        for (std::size_t state = 0; state < map.size(); ++state)
            add(state, map[state]);
    return changes;
}

Scope scope_of(const Model& model, Graph& graph) {
    Scope scope;
    const auto add = [&](const auto& items) {
        for (const auto& item : items)
            scope.insert_or_assign(item.name, graph.symbol(item.name));
    };
    add(model.parameters);
    add(model.states);
    add(model.definitions);
    return scope;
}

Scope scope_of(const Model& model) {
    return scope_of(model, *model.graph);
}

void visit_expressions(Model& model, const std::function<void(Expression&)>& visit) {
    // Images that were shared between maps before the visit are shared afterwards.
    std::unordered_map<const std::vector<Expression>*, std::shared_ptr<const std::vector<Expression>>> visited;
    const auto visit_map = [&](StateMap& map, const auto&) {
        auto& shared = visited[map.shared().get()];
        if (!shared && map.shared()) {
            std::vector<Expression> images = *map.shared();
            std::for_each(images.begin(), images.end(), visit);
            shared = std::make_shared<const std::vector<Expression>>(std::move(images));
        }
        map.replace(shared, visit);
    };
    walk(
        model, [&](Expression& expression, Role, const auto&) { visit(expression); }, visit_map);
}

} // namespace graze
