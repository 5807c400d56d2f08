#include "branch/torus_amplitude.hpp"

#include "maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

namespace graze::torus_amplitude_test {

using namespace graze::testing;

/// z -> z exp(i angle) (1 - |z|^2/size^2), with z = x + i y.
struct Turning {
    explicit Turning(double size)
        : model(map_model(fmt::format("p = 0\na = {:.17g}\nb = {:.17g}\nsize = {}", std::cos(1.1), std::sin(1.1), size),
                          {"(a*x - b*y)*(1 + p - (x^2 + y^2)/size^2)", "(b*x + a*y)*(1 + p - (x^2 + y^2)/size^2)"})),
          simulation(System(model), {}, {}, {.tolerance = 1e-14}) {
        const Orbit orbit = fixed_point(model, {0, 0});
        const auto states = static_cast<Eigen::Index>(model.states.size());
        const ParameterId parameter = model.independent_parameter("p");
        setting.active = {0, 1};
        setting.scales = Eigen::VectorXd::Ones(states);
        setting.parameter = parameter;
        setting.back = std::make_shared<SignatureReturn>(simulation, orbit, parameter, setting.scales);
        at = setting.back->follow(orbit.starts[0], 0, orbit.durations);
        pair.multiplier = std::polar(1.0, 1.1);
        pair.vector = Eigen::Vector2cd(1, std::complex<double>(0, -1)) / std::numbers::sqrt2;
    }
    Model model;
    Simulation simulation;
    TorusSetting setting;
    std::optional<SignatureReturn::Image> at;
    TurningPair pair;
};

TEST(TorusAmplitude, IsThatAtWhichTheReturnBends) {
    for (const double size : {1e-9, 1e-3, 1.0, 1e6}) {
        const Turning one(size);
        ASSERT_TRUE(one.at);
        const auto amplitude = amplitude_of_tori(one.setting, *one.at, 0, one.pair);
        ASSERT_TRUE(amplitude);
        // Circles of amplitude r have the radius r/sqrt(2): they depart by r (r/size)^2/2^1.5.
        const double exact = std::pow(2, 0.25) * size;
        EXPECT_LE(*amplitude, exact * (1 + 1e-9)) << size;
        EXPECT_GE(*amplitude, 0.499 * exact) << size;
    }
}

TEST(TorusAmplitude, ScalesOnlyWhatDiffersByOrdersOfMagnitude) {
    Turning small(1e-6), usual(0.3);
    ASSERT_TRUE(small.at && usual.at);
    EXPECT_FALSE(scale_by_amplitude(usual.setting, *usual.at, 0, usual.pair));
    EXPECT_EQ(usual.setting.scales[0], 1);
    ASSERT_TRUE(scale_by_amplitude(small.setting, *small.at, 0, small.pair));
    EXPECT_LE(small.setting.scales[0], 1.2e-6);
    EXPECT_GE(small.setting.scales[0], 5e-7);
    EXPECT_DOUBLE_EQ(small.setting.scales[0], small.setting.scales[1]);
}

} // namespace graze::torus_amplitude_test
