#include "sweep/approach.hpp"

#include "settle.hpp"

#include "sweep/attractor_setting.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace graze::unstable_orbits_test {

/// The logistic map at r, whose fixed point 1 - 1/r has the multiplier 2 - r.
struct Logistic {
    explicit Logistic(double r)
        : model(iterated(fmt::format("{}*z*(1 - z)", r), 0.3)), fixed(1 - 1 / r),
          setting(System(model), {.section = "half"}, {}, {}, {}), maps(setting.variational),
          derivatives(setting.variational, maps),
          finder(setting.map, setting.field, setting.layout, setting.image, setting.image_modes, &derivatives),
          motion(setting.map, 50, {}), jets(setting.simulation, LaneKind::single) {}

    /// Follows a motion that starts at z for some returns.
    void follow(double z, std::size_t returns) {
        Trajectory trajectory(setting.simulation, {}, borrowed(motion));
        std::vector<double> thresholds(50, 0.0);
        motion.begin({}, periods, nullptr);
        motion.watch_recurrence(&thresholds, 6);
        motion.start_leg(0, 0);
        motion.stop_after(returns);
        const std::vector<double> state{z, 0};
        trajectory.start(state, 0, 0, 100);
        run(trajectory, jets);
        motion.watch_recurrence(nullptr, 6);
    }
    void look_for_orbit(std::size_t period) {
        finder.begin({}, periods, motion.recent(0).state, 0, period, motion.scale(), static_cast<double>(period),
                     false);
        do
            run(finder.trajectory(), jets);
        while (finder.proceed());
    }

    Model model;
    double fixed;
    AttractorSetting setting;
    StepMaps maps;
    MotionDerivatives derivatives;
    OrbitFinder finder;
    ReturnWatcher motion;
    JetSet jets;
    std::vector<double> periods{0, 1};
};

TEST(UnstableOrbits, ExplainRecurrencesOfPassingMotions) {
    for (const double r : {3.7, 4.1}) { // Newton's method converges to the orbit, or gives up since it is too unstable
        Logistic map(r);
        map.follow(1 - map.fixed - 1e-4, 3); // to the image of fixed + 1e-4, from farther away
        map.look_for_orbit(1);
        EXPECT_EQ(map.finder.found(), r < 4);
        EXPECT_EQ(map.finder.clearly_unstable(), r > 4);
        EXPECT_NEAR(map.finder.point()[0], map.fixed, r < 4 ? 1e-12 : 1e-5);
        UnstableOrbits orbits;
        EXPECT_FALSE(orbits.explain(map.motion, 1, 1e-6));
        orbits.add(map.finder, map.motion);
        EXPECT_TRUE(orbits.explain(map.motion, 1, 1e-6)) << r;
        map.follow(1 - map.fixed + 2e-4, 3);
        EXPECT_TRUE(orbits.explain(map.motion, 1, 1e-6)) << r;
        EXPECT_TRUE(orbits.explain(map.motion, 2, 1e-6)) << r;
        map.follow(1 - map.fixed + 2e-4, 3); // within the distance at which a motion may stay
        EXPECT_FALSE(orbits.explain(map.motion, 1, 1)) << r;
        orbits.clear();
        EXPECT_FALSE(orbits.explain(map.motion, 1, 1e-6)) << r;
    }
}

TEST(UnstableOrbits, DoNotExplainAStableOrbitNearby) {
    // Just after the flip at r = 3 the stable orbit of period two is close to the unstable fixed point.
    const double r = 3.001;
    Logistic map(r);
    const double apart = std::sqrt((r + 1) * (r - 3)) / (2 * r);
    map.follow(map.fixed, 3);
    map.look_for_orbit(1);
    ASSERT_TRUE(map.finder.found());
    EXPECT_NEAR(map.finder.multipliers().front().real(), 2 - r, 1e-9);
    UnstableOrbits orbits;
    orbits.add(map.finder, map.motion);
    map.follow((r + 1) / (2 * r) + apart * 1.01, 9);
    EXPECT_FALSE(orbits.explain(map.motion, 2, 1e-6));
    // Stable orbits are not added.
    map.look_for_orbit(2);
    ASSERT_TRUE(map.finder.found());
    EXPECT_LT(std::abs(map.finder.multipliers().front()), 1);
    UnstableOrbits none;
    none.add(map.finder, map.motion);
    EXPECT_FALSE(none.explain(map.motion, 2, 0));
}

} // namespace graze::unstable_orbits_test
