// Times at which solutions cease to exist, in closed form.

#include "closed_form.hpp"
#include "simulate.hpp"

#include <gtest/gtest.h>

using namespace graze;
using namespace graze::testing;

namespace end_times_test {

struct Family {
    const char* rate;
    double power; ///< x' = -+ k x^power; 0: random
    double low, high;
    bool falls; ///< falls to zero; otherwise grows without bound
};

constexpr Family families[] = {
    {"-k*x^p", 0, 0.05, 0.8, true},
    {"-k*sqrt(x)", 0.5, 0, 0, true},
    {"-k*x^(1/3)", 1 / 3.0, 0, 0, true},
    {"-k*x^(2/3)", 2 / 3.0, 0, 0, true},
    {"-k*x^0.75", 0.75, 0, 0, true},
    {"-k*x^0.9", 0.9, 0, 0, true},
    {"-k/x", -1, 0, 0, true},
    {"-k/x^2", -2, 0, 0, true},
    {"-k/x^p", 0, -3, -0.3, true},
    {"k*x^2", 2, 0, 0, false},
    {"k*x^p", 0, 1.2, 4, false},
};

TEST(EndTimes, OfRootsPowersAndPolesAreExact) {
    Random random(71);
    for (const Family& family : families) {
        SCOPED_TRACE(family.rate);
        Model model = model_from(fmt::format("name = \"end\"\nparameters = {{ p = 1, k = 1 }}\nstates = {{ x = 1 "
                                             "}}\nmodes.one.rates = {{ x = \"{}\" }}\n",
                                             family.rate));
        for (int i = 0; i < 60; ++i) {
            const double p = family.power != 0 ? family.power : random.uniform(family.low, family.high);
            const double time = random.log_uniform(30, 1e6), x = random.log_uniform(1e-6, 1e6);
            const double k = std::pow(x, 1 - p) / std::abs(1 - p) / time;
            model.set_parameter("p", std::abs(p));
            model.set_parameter("k", k);
            const double tolerance = random.log_uniform(1e-15, 1e-6);
            Experiment experiment(model, with_tolerance(tolerance));
            const Outcome outcome = experiment.run_from({x}, 0, time * (random.chance(0.5) ? 2 : 1e5));
            EXPECT_TRUE(outcome.ending == Ending::singular || outcome.ending == Ending::undefined);
            // Errors of a step are relative to the state at its start, of which a tenth to a hundredth is left; where
            // the remaining time varies with the power 1/(1 - p) of the state, they have less effect.
            EXPECT_NEAR(outcome.time, time, (100 * tolerance + 1e-13) * time)
                << "p = " << p << ", x = " << x << ", tolerance " << tolerance;
        }
    }
}

TEST(EndTimes, OfSnapThroughAreExact) {
    // q'' = (c/2)/q^2 towards a fixed electrode, from rest: q = cos^2(u), t = sqrt(1/c) (u + sin u cos u), contact at u
    // = pi/2.
    Random random(72);
    for (int i = 0; i < 100; ++i) {
        const double length = random.log_uniform(1e-6, 1e3), time = random.log_uniform(30, 1e5);
        const double pi = 3.14159265358979323846, c = pi * pi / 4 * length * length * length / (time * time);
        const Model model =
            model_from(fmt::format("name = \"snap\"\nparameters = {{ c = {:.17g} }}\nstates = {{ q = 1, v = 0 }}\n"
                                   "modes.one.rates = {{ q = \"v\", v = \"-c/2/q^2\" }}\n",
                                   c));
        const double tolerance = random.log_uniform(1e-15, 1e-6);
        Experiment experiment(model, with_tolerance(tolerance));
        const Outcome outcome = experiment.run_from({length, 0}, 0, 5 * time);
        EXPECT_EQ(outcome.ending, Ending::singular);
        EXPECT_NEAR(outcome.time, time, (100 * tolerance + 1e-13) * time) << length << " " << tolerance;
    }
}

} // namespace end_times_test
