#include "graze/sweep/escape_law.hpp"

#include "settle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace graze::escape_law_test {

/// Pseudorandom numbers between 0 and 1.
class Draws {
public:
    double next() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(state_ >> 11) * 0x1p-53;
    }

private:
    std::uint64_t state_ = 88172645463325252u;
};

/// Lifetimes of motions that leave at this rate, observed for a limited number of returns.
std::vector<Stay> stays_of(Draws& draws, std::size_t motions, double rate, std::size_t most, std::size_t later = 0) {
    std::vector<Stay> stays;
    for (std::size_t k = 0; k < motions; ++k) {
        const auto cycles = later + 1 + static_cast<std::size_t>(-std::log(draws.next()) / rate);
        stays.push_back({std::min(cycles, most), cycles <= most});
    }
    return stays;
}

TEST(EscapeLaw, RateOfAKnownLawLiesWithinItsError) {
    Draws draws;
    int all = 0, within = 0;
    for (const double rate : {0.0005, 0.01, 0.4, 1.5})
        for (const std::size_t most : {400u, 100000u})
            for (int k = 0; k < 25; ++k)
                if (const auto law = escape_law(stays_of(draws, 200, rate, most))) {
                    ++all;
                    within += std::abs(law->rate - rate) <= law->error ? 1 : 0;
                    EXPECT_NEAR(law->rate, rate, 3 * law->error);
                }
    EXPECT_GE(all, 190); // a constant rate is rejected once in ten cases, and then accepted later
    EXPECT_GE(within, 0.9 * all);
}

TEST(EscapeLaw, MotionsMayBeCounted) {
    Draws draws;
    const std::vector<Stay> stays = stays_of(draws, 5000, 0.05, 60, 3);
    std::map<std::pair<std::size_t, bool>, std::size_t> counts;
    for (const Stay& stay : stays)
        ++counts[{stay.cycles, stay.left}];
    std::vector<Stay> counted{{4, true, 0}};
    for (const auto& [of, motions] : counts)
        counted.push_back({of.first, of.second, motions});
    ASSERT_LT(counted.size(), 100u);
    const auto one = escape_law(stays), other = escape_law(counted);
    ASSERT_TRUE(one && other);
    EXPECT_EQ(one->rate, other->rate);
    EXPECT_EQ(one->error, other->error);
    EXPECT_EQ(one->from, other->from);
    EXPECT_EQ(one->left, other->left);
    EXPECT_EQ(one->remaining, other->remaining);
    EXPECT_GT(one->remaining, 0u);
}

TEST(EscapeLaw, ReturnsBeforeTheLawAreExcluded) {
    Draws draws;
    // Half of the motions settle at once; the others begin to leave after 30 returns.
    std::vector<Stay> stays = stays_of(draws, 300, 0.002, 5000, 30);
    const std::vector<Stay> others = stays_of(draws, 300, 0.2, 5000);
    stays.insert(stays.end(), others.begin(), others.end());
    const auto law = escape_law(stays);
    ASSERT_TRUE(law);
    EXPECT_GT(law->from, 0u);
    EXPECT_NEAR(law->rate, 0.002, 2 * law->error);
}

TEST(EscapeLaw, ThereIsNoneIfSomeNeverLeaveOrFewLeave) {
    Draws draws;
    for (int k = 0; k < 20; ++k) {
        std::vector<Stay> stays = stays_of(draws, 200, 0.02, 2000);
        for (int staying = 0; staying < 50; ++staying)
            stays.push_back({2000, false});
        EXPECT_FALSE(escape_law(stays)) << k;
    }
    EXPECT_FALSE(escape_law(stays_of(draws, 9, 0.02, 2000)));
    EXPECT_FALSE(escape_law({}));
    EXPECT_FALSE(escape_law(std::vector<Stay>(50, {2000, false})));
}

TEST(EscapeLaw, ThereIsNoneOfTheLastMotionsToSettleAlone) {
    // 400 motions on their way to a regular attractor: the last ones happen to leave at a constant rate.
    std::vector<Stay> stays;
    const auto add = [&](std::size_t cycles, std::size_t motions) {
        stays.insert(stays.end(), motions, {cycles, true});
    };
    for (const auto& [cycles, motions] : std::vector<std::pair<std::size_t, std::size_t>>{
             {7, 1},   {8, 2},   {9, 4},   {10, 24}, {11, 53}, {12, 40}, {13, 9}, {14, 2}, {16, 1},
             {37, 1},  {42, 1},  {43, 1},  {44, 4},  {45, 2},  {46, 3},  {47, 7}, {48, 9}, {49, 12},
             {50, 18}, {51, 25}, {52, 38}, {53, 45}, {54, 54}, {55, 38}, {56, 4}, {57, 1}, {58, 1}})
        add(cycles, motions);
    EXPECT_FALSE(escape_law(stays));
}

TEST(EscapeLaw, TentMapIsLeftAtTheRateOfItsClosedForm) {
    // Of a uniform distribution over [0, 1], a share 2/s remains after each application of a tent map of slope s.
    for (const double slope : {2.1, 2.5, 3.0}) {
        std::vector<Stay> stays;
        AttractorOptions options;
        options.bounds = {{0, 0, 1}};
        options.cycles = 3000;
        for (int k = 0; k < 300; ++k) {
            const double start = std::fmod(0.137 + k * 0.6180339887498949, 1);
            const PointResult result = settle(
                in_two_pieces(fmt::format("{}*z", slope), fmt::format("{}*(1 - z)", slope), 0.5, start), options);
            EXPECT_EQ(result.label, Label::escaped) << slope << " " << start;
            stays.push_back({result.cycles + 1, true}); // the motion leaves between two returns
        }
        const auto law = escape_law(stays);
        ASSERT_TRUE(law) << slope;
        EXPECT_NEAR(law->rate, std::log(slope / 2), 1.5 * law->error) << slope;
        EXPECT_LT(law->error, 0.25 * law->rate) << slope;
    }
}

} // namespace graze::escape_law_test
