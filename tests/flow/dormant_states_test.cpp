#include "graze/flow/dormant_states.hpp"

#include "graze/flow/mode_flow.hpp"
#include "graze/model/model_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace graze::dormant_states_test {

/// A chain of first-order lags, the first driven by 1: state n is the probability that n events of a Poisson process
/// have happened.
Model lags(int count, const std::string& pull = "") {
    std::string states, rates;
    for (int i = 1; i <= count; ++i) {
        states += fmt::format("x{} = 0\n", i);
        rates += fmt::format("x{0} = \"{1} - x{0}{2}\"\n", i, i == 1 ? "1" : fmt::format("x{}", i - 1),
                             pull.empty() ? "" : fmt::vformat(pull, fmt::make_format_args(i)));
    }
    return parse_model("name = \"lags\"\n[states]\n" + states + "[modes.one.rates]\n" + rates, "lags.toml");
}

double chance(int count, double time) {
    long double term = std::exp(-static_cast<long double>(time)), sum = 0;
    for (int k = 0; k < count; term *= static_cast<long double>(time) / ++k)
        sum += term;
    return static_cast<double>(1 - sum);
}

struct Followed {
    std::vector<double> state;
    std::size_t steps = 0;
};

Followed followed(const Model& model, double time, double tolerance = 1e-12) {
    const System system(model);
    ModeFlow flow(system, tolerance);
    flow.set_parameters(model.parameter_values());
    Followed run{model.initial_state()};
    EXPECT_EQ(flow.run(0, run.state, time), ModeFlow::Ending::done);
    run.steps = flow.steps();
    return run;
}

TEST(DormantStates, StepsGrowLinearlyWithTheLengthOfAChain) {
    // Some forty steps until all states have a size, and about one for each lag.
    for (const int count : {10, 60, 200}) {
        const Followed run = followed(lags(count), count);
        EXPECT_LE(run.steps, 60 + static_cast<std::size_t>(count)) << count;
        EXPECT_NEAR(run.state.back(), chance(count, count), 1e-12) << count;
    }
}

TEST(DormantStates, StatesAreAccurateWhereTheyMatter) {
    // Errors are relative to the first states, wherever the motion ends.
    const Model model = lags(60);
    for (const double time : {0.01, 1.0, 5.0, 20.0, 40.0, 100.0}) {
        const Followed run = followed(model, time);
        for (int i = 1; i <= 60; ++i)
            EXPECT_NEAR(run.state[static_cast<std::size_t>(i) - 1], chance(i, time), 1e-12) << i << " at " << time;
    }
}

TEST(DormantStates, NonlinearChainsAreAsAccurate) {
    const Model model = lags(40, " - x{0}^3");
    const Followed run = followed(model, 30), finer = followed(model, 30, 1e-16);
    EXPECT_LE(run.steps, 150u);
    for (std::size_t i = 0; i < run.state.size(); ++i)
        EXPECT_NEAR(run.state[i], finer.state[i], 1e-12) << i;
}

TEST(DormantStates, AreNotUsedWhereASmallStateCanBecomeLargeAtOnce) {
    // The bell-shaped term is negligible at first; a floor must not hide it.
    const Model model = parse_model(R"(name = "bell"
states = { s = -20, y = 0 }
modes.one = { rates = { s = 1, y = "s*exp(-s^2) + 0*y" } }
)",
                                    "bell.toml");
    const Followed run = followed(model, 20);
    EXPECT_NEAR(run.state[1], -0.5, 1e-11); // - (exp(0) - exp(-400)) / 2
}

} // namespace graze::dormant_states_test
