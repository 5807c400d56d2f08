// Branches of a shipped model do not depend on the units in which it is written.

#include "follow.hpp"

#include "graze/symbolic/transform.hpp"

#include <gtest/gtest.h>

#include <map>

namespace graze::shipped_units_test {

using namespace graze::testing;

/// Factors from the model's units to other units.
struct Factors {
    std::map<std::string, double> states; ///< factors of states that are not dimensionless
    double time = 1, parameters = 1, events = 1;

    double of(const State& state) const {
        const auto found = states.find(state.name);
        return found == states.end() ? 1 : found->second;
    }
};

/// Returns the model in other units. Definitions, such as dependent parameters, keep theirs.
Model rescaled(const Model& given, const Factors& factors) {
    Model model = given;
    std::vector<Replacement> old;
    for (const State& state : model.states)
        old.emplace_back(model.symbol(state.name), model.symbol(state.name) / factors.of(state));
    for (const std::string& name : model.independent_parameters())
        old.emplace_back(model.symbol(name), model.symbol(name) / factors.parameters);
    const auto in_old = [&](Expression& expression, double factor) {
        expression = substitute(expression, old) * factor;
    };
    for (Parameter& parameter : model.parameters)
        if (parameter.expression)
            in_old(*parameter.expression, 1);
        else
            parameter.value = *parameter.value * factors.parameters;
    for (State& state : model.states) {
        in_old(state.initial, factors.of(state));
        if (state.period)
            in_old(*state.period, factors.of(state));
    }
    for (Definition& definition : model.definitions)
        in_old(definition.value, 1);
    for (Mode& mode : model.modes)
        for (std::size_t i = 0; i < mode.rates.size(); ++i)
            in_old(mode.rates[i], factors.of(model.states[i]) / factors.time);
    for (Event& event : model.events)
        in_old(event.function, factors.events);
    for (std::size_t j = 1; j < model.jumps.size(); ++j) // the first is the identity
        for (std::size_t i = 0; i < model.states.size(); ++i)
            in_old(model.jumps[j].map[i], factors.of(model.states[i]));
    for (Section& section : model.sections)
        in_old(section.state ? section.value : section.function,
               section.state ? factors.of(model.states[*section.state]) : 1);
    for (Symmetry& symmetry : model.symmetries)
        for (std::size_t i = 0; i < model.states.size(); ++i)
            in_old(symmetry.map[i], factors.of(model.states[i]));
    for (Quantity& quantity : model.quantities)
        in_old(quantity.value, 1);
    for (Transition& transition : model.transitions)
        for (Alternative& alternative : transition.next)
            for (Condition& condition : alternative.when)
                in_old(condition.function, 1);
    return model;
}

Branch microactuator_branch(const Factors& factors) {
    const Model given = shipped_with("impact-microactuator", {{"V", 0.1}, {"omega", 0.9189}});
    const Model model = rescaled(given, factors);
    const BranchSettings settings = in_parameter(model, "V", 0, 3 * factors.parameters);
    return follow_branch(System(model), settled(model, "longest", 4000).orbit, settings);
}

/// Lengths in nm and times in us instead of m and s; and all units scaled by a million up and down.
TEST(Units, ShippedModelDoesNotDependOnUnits) {
    const Branch reference = microactuator_branch({});
    ASSERT_EQ(names(reference), "PD PD SN GR");
    const auto lengths = [](double length, double velocity) {
        return std::map<std::string, double>{{"x1", length}, {"x2", velocity}, {"x3", length}, {"x4", velocity}};
    };
    for (const Factors& factors : {Factors{lengths(1e9, 1e3), 1e6, 1, 1e9}, Factors{lengths(1e6, 1), 1e6, 1e6, 1e6},
                                   Factors{lengths(1e-6, 1), 1e-6, 1e-6, 1e-6}}) {
        const Branch branch = microactuator_branch(factors);
        ASSERT_EQ(names(branch), names(reference)) << factors.time;
        EXPECT_EQ(branch.outcome, reference.outcome) << branch.detail;
        for (std::size_t i = 0; i < branch.special.size(); ++i) {
            EXPECT_NEAR(branch.special[i].parameter / factors.parameters / reference.special[i].parameter, 1, 1e-12);
            EXPECT_NEAR(branch.special[i].solution.orbit.period() / factors.time /
                            reference.special[i].solution.orbit.period(),
                        1, 1e-12);
        }
    }
}

} // namespace graze::shipped_units_test
