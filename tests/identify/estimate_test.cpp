#include "graze/identify/estimate.hpp"

#include "graze/base/input_error.hpp"
#include "identify/noise.hpp"

#include <numbers>
#include <vector>

namespace graze::testing::estimate_test {

TEST(Estimate, QuantilesAreThoseOfStudentsDistribution) {
    // Closed forms: the tangent for one degree of freedom, p sqrt(2/(1 - p^2)) for two.
    EXPECT_NEAR(student_quantile(0.95, 1), std::tan(std::numbers::pi * 0.475), 1e-12);
    EXPECT_NEAR(student_quantile(0.95, 2), 0.95 * std::sqrt(2 / (1 - 0.95 * 0.95)), 1e-13);
    const double root = std::sqrt(0.75); // for four: the root of a cubic
    EXPECT_NEAR(student_quantile(0.5, 4), 2 * std::sqrt(std::cos(std::acos(root) / 3) / root - 1), 1e-13);
    const double z = 1.959963984540054, many = 1e6; // the normal quantile, and the first-order correction
    EXPECT_NEAR(student_quantile(0.95, many), z + (z * z * z + z) / (4 * many), 1e-9);
    EXPECT_THROW(student_quantile(1, 3), InputError);
    EXPECT_THROW(student_quantile(0.5, 0), InputError);
    EXPECT_EQ((Estimate{1, 2, 0}.half_width()), 0);
}

// Tabulated quantiles (M. Abramowitz and I. A. Stegun, Table 26.8), to their digits.
TEST(ChiSquare, TailEqualsTabulatedValues) {
    EXPECT_NEAR(chi_square_tail(3.84146, 1), 0.05, 1e-6);
    EXPECT_NEAR(chi_square_tail(9.21034, 2), 0.01, 1e-7);
    EXPECT_NEAR(chi_square_tail(7.81473, 3), 0.05, 1e-6);
    EXPECT_NEAR(chi_square_tail(20.5150, 5), 0.001, 1e-7);
    EXPECT_NEAR(chi_square_tail(18.3070, 10), 0.05, 1e-5);
    EXPECT_NEAR(chi_square_tail(43.7730, 30), 0.05, 1e-5);
    EXPECT_EQ(chi_square_tail(0, 4), 1);
    EXPECT_EQ(chi_square_tail(1e6, 4), 0);
}

TEST(Estimate, SetsThatDifferByTheirErrorsAreAveragedByInverseVariance) {
    const std::vector<Estimate> sets{{1, 0.1, 10}, {1.02, 0.2, 10}, {0.99, 0.1, 10}};
    const Combined all = combine(sets);
    EXPECT_EQ(all.spread, 0);
    EXPECT_NEAR(all.mean.value, (100 * 1 + 25 * 1.02 + 100 * 0.99) / 225, 1e-14);
    EXPECT_NEAR(all.mean.error, 1 / 15.0, 1e-14);
    EXPECT_EQ(combine(std::vector<Estimate>{{3, 0.5, 7}}).mean.error, 0.5);
    EXPECT_EQ(combine(std::vector<Estimate>{{3, 0, 7}, {5, 0, 7}}).mean.value, 4);
    EXPECT_THROW(combine({}), InputError);
}

TEST(Estimate, IntervalOfSetsThatDifferByMoreCoversTheirMean) {
    std::size_t covered = 0;
    for (std::size_t seed = 0; seed < experiments; ++seed) {
        Noise noise(seed);
        std::vector<Estimate> sets;
        for (int i = 0; i < 8; ++i) {
            const double error = 0.01 * (1 + i % 3), own = 0.866 + 0.03 * noise.normal();
            sets.push_back({own + error * noise.normal(), error, 200});
        }
        const Combined all = combine(sets);
        covered += covers(all.mean, 0.866) ? 1 : 0;
    }
    expect_coverage(covered, "mean of sets");
}

} // namespace graze::testing::estimate_test
