#include "identify/impact_proportion.hpp"

#include "graze/identify/restitution.hpp"
#include "identify/noise.hpp"

#include <algorithm>

namespace graze::testing::impact_proportion_test {

/// Impacts of a bouncing ball; each speed is the one before times the restitution.
std::vector<RecordedImpact> bounces(Noise& noise, double offset, double by_speed, double deviation) {
    std::vector<RecordedImpact> impacts;
    double speed = 1;
    for (int k = 0; k < 8; ++k) {
        const double e = 0.85 - by_speed * (speed - 0.6), after = -e * speed;
        const double before = speed + offset + deviation * noise.normal();
        impacts.push_back(
            {0, 0, before, deviation, after + offset + 1.5 * deviation * noise.normal(), 1.5 * deviation});
        speed = -after;
    }
    return impacts;
}

ImpactProportion tested(const std::vector<RecordedImpact>& impacts) {
    std::vector<ImpactSpeeds> speeds;
    for (const RecordedImpact& one : impacts)
        speeds.push_back({one.before, one.after, one.before_error, one.after_error});
    return test_proportion(impacts, restitution(speeds).coefficient.value);
}

/// The false-positive rate is at most the nominal level, and at least a fifth of it (the p values of several terms are
/// combined by Bonferroni's bound).
TEST(ImpactProportion, HasTheFalsePositiveRateOfItsLevel) {
    constexpr std::size_t records = 4000;
    constexpr double level = 0.05;
    std::size_t offsets = 0, changes = 0, rare = 0;
    for (std::size_t seed = 0; seed < records; ++seed) {
        Noise noise(seed);
        const ImpactProportion test = tested(bounces(noise, 0, 0, 0.004));
        offsets += test.offset < level ? 1 : 0;
        changes += test.change < level ? 1 : 0;
        rare += std::min(test.offset, test.change) < 1e-3 ? 1 : 0;
    }
    constexpr double four_deviations = 55; // of a count with a mean of 200
    EXPECT_LT(static_cast<double>(offsets), level * records + four_deviations);
    EXPECT_LT(static_cast<double>(changes), level * records + four_deviations);
    EXPECT_GT(static_cast<double>(offsets), level * records / 5);
    EXPECT_GT(static_cast<double>(changes), level * records / 5);
    EXPECT_LE(rare, 8U + 12U); // 0.2 % of the records, and four deviations
}

/// An offset of ten standard errors is hidden by the scatter that it causes, but not by the velocities' own errors.
TEST(ImpactProportion, DetectsAnOffsetAndAChangeWithSpeed) {
    for (std::size_t seed = 0; seed < 50; ++seed) {
        Noise noise(seed);
        const ImpactProportion shifted = tested(bounces(noise, 0.05, 0, 0.005));
        EXPECT_LT(shifted.offset, 1e-3) << seed;
        EXPECT_GT(shifted.scatter, 3) << seed;
        EXPECT_LT(tested(bounces(noise, 0, 0.2, 0.005)).change, 1e-3) << seed;
    }
}

/// If the restitution varies from impact to impact, no further term explains the residuals, and none is reported.
TEST(ImpactProportion, ReportsNoTermWhereImpactsDifferByMoreThanTheirErrors) {
    std::size_t told = 0;
    for (std::size_t seed = 0; seed < 200; ++seed) {
        Noise noise(seed);
        std::vector<RecordedImpact> impacts = bounces(noise, 0, 0, 0.001);
        for (RecordedImpact& one : impacts)
            one.after *= 1 + 0.05 * noise.normal();
        const ImpactProportion test = tested(impacts);
        told += std::min(test.offset, test.change) < 1e-3 ? 1 : 0;
        EXPECT_LT(test.unlike, 1e-6) << seed << ": a scatter of some 40 errors";
    }
    EXPECT_LE(told, 4U);
}

TEST(ImpactProportion, DoesNotReportScatterThatErrorsExplain) {
    for (std::size_t seed = 0; seed < 4000; ++seed) {
        Noise noise(seed);
        EXPECT_GT(tested(bounces(noise, 0, 0, 0.004)).unlike, 1e-5) << seed;
    }
}

TEST(ImpactProportion, CountsDoubtfulImpacts) {
    const RecordedImpact good{0, 0, 1, 0.1, -0.8, 0.1, 0}, weak{0, 0, 0.1, 0.1, -0.8, 0.1, 0},
        through{0, 0, 1, 0.1, 0.8, 0.1, 0}, plastic{0, 0, 1, 0.1, 0.15, 0.1, 0};
    EXPECT_EQ(doubtful_impacts(std::vector{good, weak, through, good, plastic}), 2U);
    EXPECT_EQ(doubtful_impacts({}), 0U);
}

} // namespace graze::testing::impact_proportion_test
