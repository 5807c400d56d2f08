#include "branch/signature_return.hpp"

#include "follow.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::signature_return_test {

using namespace graze::testing;

/// The impact oscillator with its orbit of one impact.
struct Impacting {
    Model model = shipped_with("impact-oscillator", {{"omega", 2.8}});
    Simulation simulation{System(model), {}, {}, {.tolerance = 1e-14}};
    Orbit orbit = orbit_of("impact");
    Eigen::VectorXd scales = Eigen::VectorXd::Ones(3);

    Orbit orbit_of(const std::string& signature) const {
        const auto found = orbit_with_signature(System(model), parse_signature(model, signature));
        EXPECT_TRUE(found && found->outcome == OrbitOutcome::converged);
        return found->orbit;
    }
    SignatureReturn return_by(const char* parameter) const {
        return {simulation, orbit, model.independent_parameter(parameter), scales};
    }
    double value(const char* parameter) const {
        return orbit.parameters[model.independent_parameter(parameter).place()];
    }
};

TEST(SignatureReturn, TheStartOfAnOrbitReturns) {
    const Impacting one;
    const auto image = one.return_by("sigma").follow(one.orbit.starts[0], one.value("sigma"), one.orbit.durations);
    ASSERT_TRUE(image);
    for (std::size_t i = 0; i < 3; ++i) // the clock too, without its whole period
        EXPECT_NEAR(image->after[i], one.orbit.starts[0][i], 1e-11) << i;
    EXPECT_NEAR(image->motion.return_time(), one.orbit.return_time(), 1e-11);
}

TEST(SignatureReturn, DerivativesAreThoseOfTheMap) {
    const Impacting one;
    for (const char* parameter : {"sigma", "omega", "e"}) {
        SignatureReturn back = one.return_by(parameter);
        const double at = one.value(parameter);
        const auto image = back.follow(one.orbit.starts[0], at, one.orbit.durations);
        ASSERT_TRUE(image);
        constexpr double h = 1e-5; // central differences are good to h^2 and round-off/h
        for (std::size_t j = 0; j < 4; ++j) {
            std::vector<double> low = one.orbit.starts[0], high = low;
            if (j < 3) {
                low[j] -= h;
                high[j] += h;
            }
            const auto before = back.follow(low, j < 3 ? at : at - h, one.orbit.durations),
                       after = back.follow(high, j < 3 ? at : at + h, one.orbit.durations);
            ASSERT_TRUE(before && after);
            for (std::size_t i = 0; i < 3; ++i) {
                const double difference = (after->after[i] - before->after[i]) / (2 * h);
                EXPECT_NEAR(image->derivatives(index(i), index(j)), difference, 1e-7 * (1 + std::abs(difference)))
                    << parameter << ' ' << i << ' ' << j;
            }
        }
    }
}

TEST(SignatureReturn, SaysWhereTheMotionDoesNotReturn) {
    const Impacting one;
    SignatureReturn back = one.return_by("sigma");
    EXPECT_FALSE(back.follow(one.orbit.starts[0], 50, one.orbit.durations)); // a stop out of reach
    EXPECT_EQ(back.problem(), "the motion does not come to the end of segment 1");
}

} // namespace graze::signature_return_test
