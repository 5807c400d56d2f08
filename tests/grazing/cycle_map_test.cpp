// Local maps of cycles that graze, against closed forms and published values.

#include "graze/grazing/cycle_map.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/orbit/solve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze {
namespace {

constexpr double pi = std::numbers::pi;

/// The ball at rest in front of the shaker, whose amplitude just reaches it.
Orbit resting_ball(const Model& model) {
    Orbit orbit;
    orbit.signature = parse_signature(model, "free:phase0");
    orbit.parameters = model.parameter_values();
    orbit.starts = {{0, 0, 0}};
    orbit.durations = {1 / orbit.parameters[model.independent_parameter("f").place()]};
    return orbit;
}

struct Shaker {
    double f, n, log_c;
};
constexpr Shaker published[] = {{6, 1, 1.01155084345},
                                {10, 2, 1.23874262010},
                                {14, 2, 1.23958271687},
                                {18, 3, 1.48867209817},
                                {22, 3, 1.34410718122}};

TEST(CycleMap, of_ball_and_shaker_has_the_published_growth) {
    constexpr double zeta = 0.0881, omega_n = 25.2, e = 0.55, b = 0.65;
    for (const Shaker& one : published) {
        Model model = load_model("ball-and-shaker");
        model.set_parameter("a", b);
        model.set_parameter("f", one.f);
        const System system(model);
        const Orbit orbit = resting_ball(model);
        const std::vector<OrbitTouch> touches = touches_of(system, orbit);
        ASSERT_EQ(touches.size(), 1U);
        EXPECT_NEAR(touches[0].time, 0.25 / one.f, 1e-8 / one.f);
        CycleMapOptions options;
        options.parameter = model.independent_parameter("a");
        const CycleMap map = cycle_map(system, orbit, touches[0], options);
        ASSERT_TRUE(map.exists()) << map.reason;
        EXPECT_EQ(map.contact.order, MapOrder::square_root);
        const double omega = 2 * pi * one.f, own = omega_n * std::sqrt(1 - zeta * zeta);
        // Sums of a few terms of the size of the result.
        EXPECT_NEAR(map.contact.acceleration, b * omega * omega, 1e-13 * b * omega * omega);
        EXPECT_NEAR(map.contact.restitution, e, 1e-14);
        ASSERT_TRUE(map.clearance_rate);
        EXPECT_NEAR(*map.clearance_rate, -1, 1e-13);
        const std::vector<double> projections = map.projections(12);
        std::size_t next = 0;
        for (std::size_t k = 1; k <= projections.size(); ++k) {
            const double time = static_cast<double>(k) / one.f;
            // The flow is integrated to 1e-13 of the size of what is carried, a few steps for each cycle.
            EXPECT_NEAR(projections[k - 1], (1 + e) * std::exp(-zeta * omega_n * time) * std::sin(own * time) / own,
                        1e-12 * (1 + e) / own)
                << k;
            if (next == 0 && projections[k - 1] < 0)
                next = k;
        }
        EXPECT_EQ(static_cast<double>(next), one.n);
        // The jump of the velocity is 1 + e times the speed: c of Eq. (4.25).
        const double c = std::sqrt(-2 * map.contact.acceleration * projections[next - 1] * (1 + e));
        EXPECT_NEAR(std::log10(c), one.log_c, 1e-11); // all digits that are published
        const double closed = omega * (1 + e) *
                              std::sqrt(-2 * b * std::exp(-2 * one.n * pi * zeta * omega_n / omega) / own *
                                        std::sin(2 * one.n * pi * own / omega));
        EXPECT_NEAR(c, closed, 1e-12 * closed);
    }
}

} // namespace
} // namespace graze
