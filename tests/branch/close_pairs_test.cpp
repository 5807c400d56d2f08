// Two special points of a type at a distance of 1e-6 to 1e-3 from each other, on random branches with closed forms: a
// test function has the same sign at both ends of the step in which they lie.

#include "follow.hpp"
#include "maps.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace graze::close_pairs_test {

using namespace graze::testing;

/// A model with two special points of a type at known values of p.
struct Pair {
    PointType type;
    Model model;
    std::vector<double> start; ///< fixed point at p = -1
    double first, second;
};

class Pairs {
public:
    explicit Pairs(unsigned seed) : random_(seed) {}

    Pair next() {
        apart_ = std::pow(10, between(-6, -3));
        at_ = between(-0.7, 0.7);
        const double steepness = std::pow(10, between(-0.5, 1.5)), largest = between(0.1, 0.9);
        kind_ = (kind_ + 1) % 5;
        if (kind_ == 2)
            return folds();
        constexpr double least_depth = 2e-11; // beyond what derivatives of motions resolve
        apart_ = std::max(apart_, std::sqrt(4 * least_depth / (steepness * largest)));
        // Zero at both places, negative between them, at most `largest` elsewhere, and not symmetric.
        const std::string product = fmt::format("({:.17g}*(p-{:.17g})*(p-{:.17g})*(1+0.3*sin({:.17g}*p+{:.17g})))",
                                                steepness, at_, at_ + apart_, between(0.5, 3), between(0, 6));
        const std::string dip = fmt::format("({0}/(1+{0}*{0})^0.5*{1:.17g})", product, largest);
        const std::string other = fmt::format("{:.17g}*y+{:.17g}*x^2", between(0.05, 0.5), between(-0.3, 0.3));
        switch (kind_) {
        case 0:
            return of_map(PointType::flip, {fmt::format("(-1+{})*x-0.5*x^3", dip), other});
        case 1:
            return tori(fmt::format("(1+{}-x^2-y^2)", dip));
        case 3:
            return of_map(PointType::branch_point, {fmt::format("(1+{})*x-0.5*x^3", dip), other});
        default:
            return touches(dip);
        }
    }

private:
    double between(double least, double greatest) {
        return least + (greatest - least) * static_cast<double>(random_() >> 11) * 0x1p-53;
    }
    Pair of_map(PointType type, const std::vector<std::string>& images) const {
        return {type, map_model("p = -1", images), std::vector<double>(images.size(), 0.0), at_, at_ + apart_};
    }
    Pair tori(const std::string& growth) {
        const double angle = between(0.5, 2.5), c = std::cos(angle), s = std::sin(angle);
        return of_map(PointType::torus, {fmt::format("{}*({:.17g}*x-{:.17g}*y)", growth, c, s),
                                         fmt::format("{}*({:.17g}*x+{:.17g}*y)", growth, s, c)});
    }
    /// Fixed points lie on p = at + z^3/3 - h^2 z + b (z^4/4 - h^2 z^2/2) with z = x - centre, whose folds are at z =
    /// +-h.
    Pair folds() {
        const double h = std::cbrt(0.75 * apart_), centre = between(-0.3, 0.3), bend = between(-0.2, 0.2),
                     rate = between(0.05, 0.4) * (random_() % 2 == 0 ? -1 : 1);
        const auto place = [&](double z) {
            return at_ + z * z * z / 3 - h * h * z + bend * (z * z * z * z / 4 - h * h * z * z / 2);
        };
        const std::string z = fmt::format("(x-{:.17g})", centre);
        const std::string curve =
            fmt::format("({0}^3/3-{1:.17g}*{0}+{2:.17g}*({0}^4/4-{1:.17g}*{0}^2/2))", z, h * h, bend);
        double low = -3.5, high = -h; // the curve rises from below p = -1.5 up to the fold
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (low + high);
            (place(middle) < -1 ? low : high) = middle;
        }
        Model model = map_model("p = -1", {fmt::format("x+{:.17g}*(p-{:.17g}-{})", rate, at_, curve)});
        return {PointType::fold, std::move(model), {centre + low}, place(-h), place(h)};
    }
    Pair touches(const std::string& clearance) const {
        const OneMode one{.parameters = "p = -1",
                          .states = "x = 0\nclock = 0",
                          .definitions = fmt::format("clearance = '{}'", clearance),
                          .rates = "x = '-x', clock = 1",
                          .stops = {{"tick", "1 - clock", "x = '0.5*x + 1'\nclock = 0", "map"},
                                    {"wall", "1 + clearance - sin(2*pi*clock)", "x = '-x'"}}};
        return {PointType::grazing, one.model(), {1}, at_, at_ + apart_};
    }

    std::mt19937_64 random_;
    int kind_ = -1;
    double apart_ = 0, at_ = 0;
};

/// @param longest largest step
void expect_none_lost(unsigned seed, int count, double longest = ContinuationOptions().largest_step) {
    constexpr double accuracy = 1e-8;
    Pairs pairs(seed);
    for (int i = 0; i < count; ++i) {
        const Pair pair = pairs.next();
        BranchSettings settings = in_parameter(pair.model, "p", -1, 1);
        settings.stop_when_unphysical = false;
        settings.continuation.largest_step = longest;
        const Branch branch = follow_branch(System(pair.model), fixed_point(pair.model, pair.start), settings);
        const auto found = of_type(branch, pair.type);
        ASSERT_EQ(found.size(), 2U) << i << ": " << name_of(pair.type) << " at " << pair.first << " and "
                                    << pair.second - pair.first << " beyond: " << names(branch);
        EXPECT_EQ(branch.special.size(), 3U) << i << ": " << names(branch); // the third is the bound
        const auto [least, greatest] = std::minmax(found[0].parameter, found[1].parameter);
        EXPECT_NEAR(least, std::min(pair.first, pair.second), accuracy) << i;
        EXPECT_NEAR(greatest, std::max(pair.first, pair.second), accuracy) << i;
    }
}

TEST(ClosePairs, NoneIsLostOnRandomBranches) {
    expect_none_lost(1, 100);
}

TEST(ClosePairsSlow, NoneIsLostOnAThousandRandomBranches) {
    expect_none_lost(2, 1000);
}

/// Steps are four times as long only where no test comes near zero.
TEST(ClosePairs, NoneIsLostWithLongSteps) {
    expect_none_lost(3, 100, 0.2);
}

} // namespace graze::close_pairs_test
