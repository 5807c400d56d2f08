#include "graze/identify/restitution.hpp"

#include "graze/base/input_error.hpp"
#include "identify/noise.hpp"

namespace graze::testing::restitution_test {

TEST(Restitution, IsExactForExactImpacts) {
    const std::vector<ImpactSpeeds> impacts{{0.1, -0.0866}, {0.05, -0.0433}, {-0.2, 0.1732}};
    const Restitution found = restitution(impacts);
    EXPECT_NEAR(found.coefficient.value, 0.866, 1e-15);
    EXPECT_NEAR(found.mean_ratio, 0.866, 1e-15);
    EXPECT_LT(found.coefficient.error, 1e-15);
}

TEST(Restitution, EqualsTheClosedFormForEqualNoise) {
    Noise noise(3);
    std::vector<ImpactSpeeds> impacts;
    double before = 0, after = 0, product = 0;
    for (int i = 0; i < 50; ++i) {
        const double v = 0.05 + 0.05 * noise.uniform();
        impacts.push_back({v + 0.01 * noise.normal(), -0.7 * v + 0.01 * noise.normal()});
        before += std::pow(impacts.back().before, 2);
        after += std::pow(impacts.back().after, 2);
        product += impacts.back().before * impacts.back().after;
    }
    // The slope of the first principal axis.
    const double slope = (after - before + std::hypot(after - before, 2 * product)) / (2 * product);
    EXPECT_NEAR(restitution(impacts).coefficient.value, -slope, 1e-12);
}

// Impacts of many speeds; the slowest are ten times the noise: their ratios are biased.
TEST(Restitution, IntervalsCoverTheTruth) {
    for (const double ratio : {1.0, 3.0}) {
        std::size_t covered = 0;
        for (std::size_t seed = 0; seed < experiments; ++seed) {
            Noise noise(seed);
            std::vector<ImpactSpeeds> impacts;
            for (int i = 0; i < 300; ++i) {
                const double v = 0.02 + 0.08 * noise.uniform();
                impacts.push_back({v + 0.002 * ratio * noise.normal(), -0.866 * v + 0.002 * noise.normal(), ratio, 1});
            }
            const Restitution found = restitution(impacts);
            covered += covers(found.coefficient, 0.866) ? 1 : 0;
        }
        expect_coverage(covered, "restitution");
    }
}

TEST(Restitution, RefusesVelocitiesThatAreNotThoseOfImpacts) {
    EXPECT_THROW(restitution({}), InputError);
    EXPECT_THROW(restitution(std::vector<ImpactSpeeds>{{1, -1}}), InputError);
    EXPECT_THROW(restitution(std::vector<ImpactSpeeds>{{1, 1}, {1, 1}}), InputError);
    EXPECT_THROW(restitution(std::vector<ImpactSpeeds>{{0, 1}, {1, -1}}), InputError);
    EXPECT_THROW(restitution(std::vector<ImpactSpeeds>{{1, -1, 1, 0}, {1, -1}}), InputError);
    EXPECT_THROW(restitution(std::vector<ImpactSpeeds>{{1, std::nan("")}, {1, -1}}), InputError);
}

} // namespace graze::testing::restitution_test
