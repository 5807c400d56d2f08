// Linearisations of models' rates against their sparse Jacobians.
#include "graze/model/microbeam.hpp"
#include "graze/symbolic/linearisation.hpp"
#include "model/chain.hpp"
#include "model/shipped_model.hpp"
#include "symbolic/multiplied_out.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <string>

namespace graze::linearised_models_test {

struct Compared {
    Linearisation linear, plain; ///< with respect to states only
    Linearisation of_many;       ///< for so many directions that the cost of coefficients is negligible
};

/// Linearises the rates of a mode by states and parameters, at random points near the model's own values.
Compared compare(Model model, const std::string& mode) {
    const std::vector<Expression> rates = model.expand(model.modes[testing::mode_index(model, mode.c_str())].rates),
                                  states = model.state_symbols();
    const SymbolIndex inputs(model.inputs()), of_states(states);
    const Linearisation linear = linearise(rates, inputs, states.size());
    const std::vector<double> parameters = model.parameter_values();
    std::mt19937_64 random(9);
    for (int trial = 0; trial < 5; ++trial) {
        std::vector<double> at;
        for (std::size_t i = 0; i < states.size(); ++i)
            at.push_back(std::uniform_real_distribution<>(-0.001, 0.001)(random));
        for (const double value : parameters)
            at.push_back(value * std::uniform_real_distribution<>(0.98, 1.02)(random));
        const std::vector<double> plain = testing::plain_derivatives(rates, inputs, at);
        const testing::DenseDerivatives derivatives = testing::multiplied_out(linear, inputs, at);
        for (std::size_t i = 0; i < plain.size(); ++i) {
            // Tolerance relative to each row's size: some hundred roundings accumulate in its sum.
            const double bound = 1e-13 * derivatives.sizes[i / inputs.size()];
            if (std::isfinite(plain[i])) {
                EXPECT_NEAR(derivatives.values[i], plain[i], bound) << model.name << ' ' << mode << ' ' << i;
            }
        }
    }
    return {linearise(rates, of_states, states.size()), testing::plain_linearisation(rates, of_states, states.size()),
            linearise(rates, of_states, states.size(), 1000000)};
}

/// Returns a description that the tests print for information.
std::string description(const Linearisation& one) {
    return std::to_string(one.entries.size()) + " entries (" + std::to_string(one.varying_entries()) + " vary), " +
           std::to_string(one.intermediates) + " intermediates, cost " + std::to_string(one.cost());
}

void compare_all(const Model& model) {
    for (const Mode& mode : model.modes) {
        const auto [linear, plain, of_many] = compare(model, mode.name);
        EXPECT_LE(of_many.cost(), plain.cost()) << model.name << ' ' << mode.name;
        if (linear.intermediates == 0) {
            EXPECT_EQ(linear.entries.size(), plain.entries.size()) << model.name << ' ' << mode.name;
        }
        std::cout << model.name << ' ' << mode.name << ": " << description(linear) << "; without " << description(plain)
                  << "; for many directions " << description(of_many) << '\n';
    }
}

TEST(LinearisedModels, EqualTheirJacobians) {
    for (const auto& file : std::filesystem::directory_iterator(testing::models_folder()))
        compare_all(read_model(file.path().string()));
}

TEST(LinearisedModels, MicrobeamsEqualTheirJacobiansAndCostLessWithManyModes) {
    for (const int modes : {1, 9})
        compare_all(microbeam({.modes = modes}));
    // Each rate depends on the stretch and on one projection of the slope.
    const auto [off, plain_off, off_many] = compare(microbeam({.modes = 9}), "free_off");
    EXPECT_EQ(plain_off.varying_entries(), 81u);
    EXPECT_EQ(off.varying_entries(), 36u);
    EXPECT_EQ(off_many.varying_entries(), 36u);
    // The attraction at 19 points of the beam.
    const auto [on, plain_on, on_many] = compare(microbeam({.modes = 18}), "free_on");
    EXPECT_EQ(plain_on.varying_entries(), 18u * 18u);
    EXPECT_EQ(on.varying_entries(), 19u + 4 * 18u);
    EXPECT_EQ(on_many.varying_entries(), 19u + 4 * 18u);
}

TEST(LinearisedModels, FewDirectionsDoNotPayForManyCoefficients) {
    // With nine modes both forms cost about the same for each direction, but 81 coefficients of 19 terms cost far more.
    Model model = microbeam({.modes = 9});
    const std::vector<Expression> rates = model.expand(model.modes[testing::mode_index(model, "free_on")].rates);
    const SymbolIndex inputs(model.inputs()), states(model.state_symbols());
    const auto operations = [&](std::size_t directions) {
        std::vector<Expression> coefficients;
        for (const LinearEntry& entry : linearise(rates, states, states.size(), directions).entries)
            coefficients.push_back(entry.coefficient);
        return Function(inputs, coefficients).operations();
    };
    EXPECT_LT(3 * operations(4), operations(1000));
}

TEST(LinearisedModels, ChainsHaveNoIntermediates) {
    const auto [linear, plain, of_many] = compare(testing::chain(30), "free");
    EXPECT_EQ(linear.intermediates, 0u);
    EXPECT_EQ(linear.entries.size(), 5 * 30u - 1); // the ends have one neighbour; the first oscillator is forced
    EXPECT_EQ(linear.varying_entries(), 30u + 1);
    EXPECT_EQ(plain.cost(), linear.cost());
    EXPECT_EQ(of_many.cost(), linear.cost());
}

} // namespace graze::linearised_models_test
