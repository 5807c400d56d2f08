// High powers of slowly varying functions are narrow peaks, which coefficients far away do not show.

#include "closed_form.hpp"
#include "simulate.hpp"

#include <gtest/gtest.h>

#include <numbers>

using namespace graze;
using namespace graze::testing;

namespace hidden_peak_test {

using std::numbers::pi;

/// Powers u^n with a peak of height 1 at s = centre, and the integral over the whole line or half a period.
struct Peak {
    std::string text;
    double integral = 0;
    double half_width = 0; ///< distance from the centre where the value is 1/2
    double centre = 0;
    double reach = 0; ///< distance from the centre without another peak
};

/// @param kind 0 .. 4
Peak draw_peak(Random& random, int kind) {
    const double reach = kind == 3 ? 1.4 : kind == 4 ? 0.5 : 0.9, centre = random.uniform(-0.3, 0.3);
    const double n = std::round(random.log_uniform(64, 1e6));
    const auto raised = [&](const std::string& base, double exponent) {
        return fmt::format("({})^({:.17g})", base, exponent);
    };
    const std::string u = fmt::format("(s - {:.17g})", centre);
    const double log_half = std::log(2.0) / n;
    switch (kind) {
    case 0:
        return {raised(fmt::format("exp(-{}^2)", u), n), std::sqrt(pi / n), std::sqrt(log_half), centre, reach};
    case 1:
        return {raised(fmt::format("1 - {}^2", u), n),
                std::sqrt(pi) * std::exp(std::lgamma(n + 1) - std::lgamma(n + 1.5)), std::sqrt(-std::expm1(-log_half)),
                centre, reach};
    case 2:
        return {raised(fmt::format("1 + {}^2", u), -n), std::sqrt(pi) * std::exp(std::lgamma(n - 0.5) - std::lgamma(n)),
                std::sqrt(std::expm1(log_half)), centre, reach};
    case 3:
        return {raised(fmt::format("cos({})", u), n),
                std::sqrt(pi) * std::exp(std::lgamma((n + 1) / 2) - std::lgamma(n / 2 + 1)),
                std::acos(std::exp(-log_half)), centre, reach};
    default:
        return {raised(fmt::format("4*({0} + 0.5)*(0.5 - {0})", u), n),
                std::sqrt(pi) * std::exp(std::lgamma(n + 1) - std::lgamma(n + 1.5)) / 2,
                std::sqrt(-std::expm1(-log_half)) / 2, centre, reach};
    }
}

TEST(HiddenPeaks, OfHighPowersAreIntegrated) {
    Random random(71);
    for (int i = 0; i < 200; ++i) {
        // Tails reach 1e-15 at a distance of ten half widths.
        const auto [text, integral, half_width, centre, reach] = draw_peak(random, i % 5);
        const double tolerance = random.log_uniform(1e-13, 1e-6);
        Experiment experiment(
            model_from(fmt::format("[states]\ns = 0\ny = 0\n[modes.m]\nrates = {{ s = 1, y = \"{}\" }}\n", text)),
            with_tolerance(tolerance));
        const Outcome outcome = experiment.run_from({centre - reach, 0}, 0, 2 * reach);
        ASSERT_EQ(outcome.ending, Ending::end_time) << text << " " << outcome.detail;
        if (9 * half_width > reach)
            continue;
        // Uncertainty of the position is relative to the half width; round-off of a base near one adds to it.
        const double sensitivity = 1 + epsilon / (half_width * half_width * tolerance);
        EXPECT_NEAR(experiment.state()[1], integral, 100 * tolerance * sensitivity * integral) << text;
    }
}

TEST(HiddenPeaks, EventsOfHighPowersAreMet) {
    Random random(72);
    for (int i = 0; i < 300; ++i) {
        const auto [text, integral, half_width, centre, reach] = draw_peak(random, i % 5);
        const double start = centre - random.uniform(std::min(1.5 * half_width, reach), reach);
        Experiment experiment(model_from(fmt::format(
                                  "[states]\ns = 0\n[events]\nhit = \"0.5 - {}\"\n[modes.m]\nrates = {{ s = 1 }}\n"
                                  "watch = [\"hit\"]\n[[transitions]]\nmode = \"m\"\nevent = \"hit\"\nnext = \"end\"\n",
                                  text)),
                              with_tolerance(random.log_uniform(1e-13, 1e-6)));
        const Outcome outcome = experiment.run_from({start}, 0, 2 * reach);
        ASSERT_EQ(experiment.recorder.contacts().size(), 1U) << text << " from " << start << outcome.detail;
        EXPECT_NEAR(outcome.time, centre - half_width - start, 1e-6 * half_width + 100 * epsilon / half_width) << text;
    }
}

TEST(HiddenPeaks, FunctionsThatUnderflowDoNotEndTheMotion) {
    Random random(73);
    for (int i = 0; i < 40; ++i) {
        const double steepness = random.log_uniform(100, 1000), at = random.uniform(0.2, 0.6);
        const auto final_of = [&](const std::string& rate) {
            Experiment experiment(
                model_from(fmt::format("[states]\ns = 0\ny = 0\n[modes.m]\nrates = {{ s = 1, y = \"{}\" }}\n", rate)));
            const Outcome outcome = experiment.run(1);
            EXPECT_EQ(outcome.ending, Ending::end_time) << rate << " " << outcome.detail;
            return experiment.state()[1];
        };
        // exp(-exp(x)) integrates to E1(exp(x)): -gamma - x for x far below 0, and 0 far above.
        EXPECT_NEAR(final_of(fmt::format("exp(-exp({:.17g}*(s - {:.17g})))", steepness, at)),
                    at - 0.57721566490153286 / steepness, 1e-10);
        // ln(1 + exp(-x^2)) integrates to -sqrt(pi) Li_{3/2}(-1).
        const double width = 1 / (steepness * std::sqrt(at));
        EXPECT_NEAR(final_of(fmt::format("log(1 + exp(-((s - {:.17g})/{:.17g})^2))", at, width)),
                    width * std::sqrt(pi) * 0.7651470246254079, 1e-9 * width);
    }
}

TEST(HiddenPeaks, KinksOfSectionsArePassed) {
    Random random(74);
    int passed = 0;
    for (int i = 0; i < 100; ++i) {
        const double at = random.uniform(0.3, 0.7), height = random.log_uniform(1e-4, 0.2);
        Experiment experiment(
            model_from(fmt::format("[states]\ns = 0\n[events]\nz = {{ function = \"{:.17g} - sqrt((s - {:.17g})^2)\", "
                                   "kind = \"section\" }}\n[modes.m]\nrates = {{ s = 1 }}\nwatch = [\"z\"]\n"
                                   "[[transitions]]\nmode = \"m\"\nevent = \"z\"\nnext = \"m\"\n",
                                   height, at)),
            with_tolerance(random.log_uniform(1e-13, 1e-6)));
        const Outcome outcome = experiment.run(1);
        EXPECT_LT(experiment.trajectory.steps(), 500U);
        if (outcome.ending == Ending::undefined) { // a step has ended exactly on the kink
            EXPECT_NEAR(outcome.time, at, 16 * epsilon);
            continue;
        }
        ++passed;
        EXPECT_EQ(outcome.ending, Ending::end_time) << outcome.detail;
        ASSERT_EQ(experiment.recorder.contacts().size(), 1U) << at << " " << height;
        EXPECT_NEAR(experiment.recorder.contacts()[0].contact.time, at + height, 1e-12);
    }
    EXPECT_GT(passed, 90);
}

} // namespace hidden_peak_test
