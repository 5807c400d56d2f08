#include "graze/flow/roots.hpp"

#include "graze/base/input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace graze::roots_test {

// Reference values are computed in extended precision: 64 bits or more, so that its own errors are below the bounds
// tested.
using Wide = long double;
constexpr bool wide_enough = std::numeric_limits<Wide>::digits >= 64;
constexpr double unit = 0x1p-53;

Wide evaluate_wide(const std::vector<double>& c, Wide s) {
    Wide value = 0;
    for (std::size_t k = c.size(); k-- > 0;)
        value = value * s + static_cast<Wide>(c[k]);
    return value;
}

Wide derivative_wide(const std::vector<double>& c, Wide s) {
    Wide value = 0;
    for (std::size_t k = c.size(); k-- > 1;)
        value = value * s + static_cast<Wide>(k) * static_cast<Wide>(c[k]);
    return value;
}

/// Returns error(s) of the class's documentation, by its definition.
double error_at(const std::vector<double>& c, double s) {
    double sum = 0;
    for (std::size_t k = 0; k < c.size(); ++k)
        sum += static_cast<double>(2 * k + 4) * std::abs(c[k]) * std::pow(s, static_cast<double>(k));
    return unit * sum;
}

std::vector<Wide> product(const std::vector<Wide>& a, const std::vector<Wide>& b) {
    std::vector<Wide> c(a.size() + b.size() - 1, 0);
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j)
            c[i + j] += a[i] * b[j];
    return c;
}

std::vector<Wide> from_roots(const std::vector<Wide>& roots) {
    std::vector<Wide> c{1};
    for (const Wide r : roots)
        c = product(c, {-r, 1});
    return c;
}

/// Returns rounded coefficients for s = length t, with a sign that makes the value at 0 positive if possible.
std::vector<double> rounded(const std::vector<Wide>& c, double length) {
    std::vector<double> result;
    const Wide sign = c[0] < 0 ? -1 : 1;
    Wide power = 1;
    for (const Wide x : c) {
        result.push_back(static_cast<double>(sign * x / power));
        power *= static_cast<Wide>(length);
    }
    return result;
}

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
    double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }

    /// Returns a factor like a Taylor expansion: no roots near [0, 1], coefficients that decay like e^{-2k}.
    std::vector<Wide> decaying(int degree) {
        std::vector<Wide> g{1};
        for (int k = 1; k <= degree; ++k)
            g.push_back(static_cast<Wide>(uniform(-1, 1) * std::exp(-2.0 * k)));
        return g;
    }

private:
    std::mt19937_64 engine_;
};

/// Checks the guarantees for the first falling root of any polynomial, at the given points and on a grid.
void check_first_falling(RootFinder& finder, const std::vector<double>& c, double length, std::vector<double> places) {
    constexpr int grid = 24;
    for (int i = 0; i <= grid; ++i)
        places.push_back(length * i / grid);
    std::erase_if(places, [&](double s) { return !(s > 0) || s > length; });
    std::sort(places.begin(), places.end());
    Root root{};
    const bool found = finder.first_falling(c, length, RootStart::as_is, root);
    bool positive = c[0] > 0;
    double negative_from = std::numeric_limits<double>::infinity();
    for (const double s : places) {
        const double value = static_cast<double>(evaluate_wide(c, s)), error = 2 * error_at(c, s);
        if (value > error)
            positive = true;
        if (positive && value < -error) {
            negative_from = s;
            break;
        }
    }
    ASSERT_TRUE(found || negative_from > length) << "missed before " << negative_from;
    if (RootFinder::surely_positive(c, length, RootStart::as_is)) {
        ASSERT_FALSE(found);
        for (const double s : places)
            ASSERT_GT(evaluate_wide(c, s), 0);
    }
    if (!found)
        return;
    ASSERT_EQ(root.kind, RootKind::falling);
    ASSERT_GT(root.at, 0);
    ASSERT_LE(root.at, length);
    ASSERT_LE(root.at, negative_from);
    const double error = error_at(c, root.at);
    ASSERT_LE(std::abs(static_cast<double>(evaluate_wide(c, root.at))), error);
    // No false root: after the root the polynomial is negative somewhere, unless the root is at the end.
    bool negative = root.at == length && derivative_wide(c, length) < 0;
    for (const double s : places)
        negative |= s >= root.at && evaluate_wide(c, s) < 0;
    // a point between the root and the next given point, clearly beyond round-off
    const double slope = std::abs(static_cast<double>(derivative_wide(c, root.at)));
    for (const double step : {4 * error / slope, 16 * error / slope, 256 * error / slope})
        negative |= evaluate_wide(c, std::min(length, root.at + step)) < 0;
    ASSERT_TRUE(negative) << "invented at " << root.at;
}

TEST(RootFinder, FindsTheFirstFallingRootOfRandomPolynomials) {
    if (!wide_enough)
        GTEST_SKIP();
    Random random(1);
    RootFinder finder(40);
    for (int n = 0; n < 60000; ++n) {
        std::vector<Wide> roots;
        for (int i = random.integer(0, 8); i > 0; --i)
            roots.push_back(random.integer(0, 2) ? random.uniform(0, 1) : random.uniform(-2, 3));
        const double length = random.logarithmic(1e-6, 1e6);
        const std::vector<double> c =
            rounded(product(from_roots(roots), random.decaying(random.integer(0, 20))), length);
        std::sort(roots.begin(), roots.end());
        std::vector<double> places;
        for (std::size_t i = 0; i + 1 < roots.size(); ++i)
            places.push_back(length * static_cast<double>((roots[i] + roots[i + 1]) / 2));
        SCOPED_TRACE(n);
        check_first_falling(finder, c, length, places);
        if (HasFatalFailure())
            return;
    }
}

TEST(RootFinder, ResolvesClusters) {
    if (!wide_enough)
        GTEST_SKIP();
    Random random(2);
    RootFinder finder(40);
    for (int n = 0; n < 20000; ++n) {
        const Wide centre = random.uniform(0.02, 0.98);
        const double spread = random.logarithmic(1e-9, 1e-1);
        std::vector<Wide> roots;
        for (int i = random.integer(2, 5); i > 0; --i)
            roots.push_back(centre + static_cast<Wide>(random.uniform(-spread, spread)));
        for (int i = random.integer(0, 2); i > 0; --i)
            roots.push_back(random.uniform(-1, 2));
        const std::vector<double> c = rounded(product(from_roots(roots), random.decaying(random.integer(4, 18))), 1);
        std::sort(roots.begin(), roots.end());
        std::vector<double> places;
        for (std::size_t i = 0; i + 1 < roots.size(); ++i)
            for (const Wide part : {0.3L, 0.5L, 0.7L})
                places.push_back(static_cast<double>(roots[i] + part * (roots[i + 1] - roots[i])));
        SCOPED_TRACE(n);
        check_first_falling(finder, c, 1, places);
        if (HasFatalFailure())
            return;
    }
}

TEST(RootFinder, DecidesNearlyDoubleRootsDownToResolution) {
    if (!wide_enough)
        GTEST_SKIP();
    Random random(3);
    RootFinder finder(40);
    std::vector<Root> touches;
    touches.reserve(8);
    int undecided = 0;
    for (int n = 0; n < 60000; ++n) {
        const double length = std::ldexp(1, random.integer(-20, 20));
        const Wide at = random.uniform(0.05, 0.95);
        const Wide depth = static_cast<Wide>(random.logarithmic(1e-16, 1e-1) * (random.integer(0, 1) ? 1 : -1));
        // ((t - at)^2 - depth) g(t), g > 0
        const std::vector<double> c =
            rounded(product({at * at - depth, -2 * at, 1}, random.decaying(random.integer(6, 22))), length);
        const double middle = length * static_cast<double>(at);
        // the minimum, displaced by g
        Wide bottom = middle;
        for (int i = 0; i < 60; ++i) {
            const Wide step = 1e-4L * static_cast<Wide>(length);
            const Wide curvature = (derivative_wide(c, bottom + step) - derivative_wide(c, bottom - step)) / (2 * step);
            bottom -= derivative_wide(c, bottom) / curvature;
        }
        Root root{};
        touches.clear();
        const bool found = finder.first_falling(c, length, RootStart::as_is, root, 0, &touches);
        SCOPED_TRACE(n);
        if (depth > 0 && at - std::sqrt(depth) < 0) // negative at the start
            continue;
        const bool inside = bottom > 0 && bottom < static_cast<Wide>(length);
        if (!inside)
            continue;
        const double value = static_cast<double>(evaluate_wide(c, bottom));
        const double error = error_at(c, static_cast<double>(bottom));
        if (value < -2 * error) {
            ASSERT_TRUE(found) << value / error;
            const double exact = length * static_cast<double>(at - std::sqrt(depth));
            const double slope = std::abs(static_cast<double>(derivative_wide(c, exact)));
            const double curvature = 2 / (length * length);
            // the interval of roots of a parabola shifted by the error
            ASSERT_NEAR(root.at, exact, 3 * std::min(error / slope, std::sqrt(error / curvature)) + unit * exact);
            ASSERT_TRUE(touches.empty());
        } else if (value > 2 * error) {
            ASSERT_FALSE(found) << value / error;
            ASSERT_TRUE(touches.empty());
        } else {
            ASSERT_TRUE(found || touches.size() == 1 || value > 0.5 * error) << value / error;
            ++undecided;
        }
        if (!found && touches.size() == 1) {
            ASSERT_NEAR(touches[0].at, static_cast<double>(bottom), 1e-13 * length);
            ASSERT_LE(std::abs(touches[0].value), 2 * error);
        }
    }
    EXPECT_GT(undecided, 100);
    EXPECT_LT(undecided, 10000);
}

TEST(RootFinder, ReportsEachTouchBeforeTheFallingRootOnce) {
    Random random(4);
    RootFinder finder(32);
    std::vector<Root> touches;
    touches.reserve(8);
    for (int n = 0; n < 3000; ++n) {
        // t in [0, 1]; minima of 1e-6 g and 1e-3 g, then a falling root
        const Wide first = random.uniform(0.05, 0.3), second = random.uniform(0.45, 0.6), fall = random.uniform(0.8, 1);
        const Wide gap = static_cast<Wide>(random.logarithmic(1e-13, 1e-8));
        std::vector<Wide> p = product({first * first + gap, -2 * first, 1}, {second * second + 1e-3L, -2 * second, 1});
        p = product(product(p, {fall, -1}), random.decaying(15));
        const std::vector<double> c = rounded(p, 1);
        Root root{};
        touches.clear();
        ASSERT_TRUE(finder.first_falling(c, 1, RootStart::as_is, root, 1e-7, &touches));
        ASSERT_NEAR(root.at, static_cast<double>(fall), 1e-10);
        ASSERT_EQ(touches.size(), 1u);
        ASSERT_EQ(touches[0].kind, RootKind::touch);
        ASSERT_NEAR(touches[0].at, static_cast<double>(first), 1e-6);
        ASSERT_GT(touches[0].value, 0);
        ASSERT_LE(touches[0].value, 1e-7);
        touches.clear();
        ASSERT_TRUE(finder.first_falling(c, 1, RootStart::as_is, root, 1, &touches));
        ASSERT_EQ(touches.size(), 2u);
        ASSERT_NEAR(touches[1].at, static_cast<double>(second), 2e-2);
        // located as a root of the derivative
        const double slope_error = 50 * RootFinder::resolution(c, 1);
        ASSERT_LE(std::abs(static_cast<double>(derivative_wide(c, touches[1].at))), slope_error);
    }
}

TEST(RootFinder, ReportsTouchesAtExactDoubleRoots) {
    RootFinder finder(8);
    std::vector<Root> touches;
    Root root{};
    // (s - 1/2)^2 and (s - 1/4)^2 (s - 1/2)^2 are exact in binary numbers
    EXPECT_FALSE(finder.first_falling(std::vector{0.25, -1.0, 1.0}, 1, RootStart::as_is, root, 0, &touches));
    ASSERT_EQ(touches.size(), 1u);
    EXPECT_EQ(touches[0].at, 0.5);
    EXPECT_EQ(touches[0].value, 0);
    touches.clear();
    const std::vector<double> twice{0.015625, -0.1875, 0.8125, -1.5, 1.0};
    EXPECT_FALSE(finder.first_falling(twice, 1, RootStart::as_is, root, 0, &touches));
    ASSERT_EQ(touches.size(), 2u);
    EXPECT_NEAR(touches[0].at, 0.25, 1e-15);
    EXPECT_NEAR(touches[1].at, 0.5, 1e-15);
    // -(s - 1/2)^3: a falling root with zero slope
    touches.clear();
    EXPECT_TRUE(finder.first_falling(std::vector{0.125, -0.75, 1.5, -1.0}, 1, RootStart::as_is, root, 0, &touches));
    EXPECT_NEAR(root.at, 0.5, 1e-5);
    EXPECT_TRUE(touches.empty());
    // a touch at the end, with and without a list of touches
    touches.clear();
    EXPECT_FALSE(finder.first_falling(std::vector{1.0, -2.0, 1.0}, 1, RootStart::as_is, root, 0, &touches));
    ASSERT_EQ(touches.size(), 1u);
    EXPECT_NEAR(touches[0].at, 1, 1e-15);
    EXPECT_FALSE(finder.first_falling(std::vector{1.0, -2.0, 1.0}, 1, RootStart::as_is, root));
    // a minimum above the threshold
    touches.clear();
    EXPECT_FALSE(finder.first_falling(std::vector{1.25, -2.0, 1.0}, 1, RootStart::as_is, root, 0.3, &touches));
    ASSERT_EQ(touches.size(), 1u);
    EXPECT_NEAR(touches[0].value, 0.25, 1e-15);
}

TEST(RootFinder, DeflatesTheStart) {
    RootFinder finder(32);
    Root root{};
    for (double speed = 1; speed > 1e-18; speed *= 0.37) {
        // a flight p = v s - a s^2 / 2, and one with higher terms that matter only later
        const std::vector<double> ball{0, speed, -0.5};
        ASSERT_TRUE(finder.first_falling(ball, 4, RootStart::deflate, root)) << speed;
        EXPECT_NEAR(root.at, 2 * speed, 4 * unit * speed);
        const std::vector<double> shaken{0, speed, -0.5, 0.25, -0.1, 0.03, -0.004, 0.0005};
        if (speed < 1e-6) {
            ASSERT_TRUE(finder.first_falling(shaken, 1, RootStart::deflate, root));
            EXPECT_NEAR(root.at, 2 * speed * (1 + speed), 8 * speed * speed * speed + 8 * unit * speed);
        }
        // falls at first: the rising root is not reported
        EXPECT_FALSE(finder.first_falling(std::vector{0.0, -speed, 0.5}, 4, RootStart::deflate, root));
        std::vector<Root> roots;
        finder.crossings(std::vector{0.0, -speed, 0.5}, 4, RootStart::deflate, roots);
        ASSERT_EQ(roots.size(), 1u);
        EXPECT_EQ(roots[0].kind, RootKind::rising);
        EXPECT_NEAR(roots[0].at, 2 * speed, 4 * unit * speed);
        // rises throughout
        EXPECT_TRUE(RootFinder::surely_positive(std::vector{-1e-17, speed, 0.5}, 4, RootStart::deflate));
        EXPECT_FALSE(RootFinder::surely_positive(ball, 4, RootStart::deflate));
    }
    // falls, rises through 0.25, falls through 0.75
    ASSERT_TRUE(finder.first_falling(std::vector{0.0, -0.1875, 1.0, -1.0}, 1, RootStart::deflate, root));
    EXPECT_NEAR(root.at, 0.75, 4 * unit);
    // the true c[0] shifts the root: 1e-10 + s - s^2
    ASSERT_TRUE(finder.first_falling(std::vector{1e-10, 1.0, -1.0}, 2, RootStart::deflate, root));
    EXPECT_NEAR(root.at, 0.5 + std::sqrt(0.25 + 1e-10), 1e-15);
    // but not if the flight is too short for the correction
    ASSERT_TRUE(finder.first_falling(std::vector{-1e-17, 1e-12, -0.5}, 1, RootStart::deflate, root));
    EXPECT_NEAR(root.at, 2e-12, 2e-13);
    EXPECT_GT(root.at, 0);
}

TEST(RootFinder, FindsDeflatedRootsOfAllSizesToRelativeAccuracy) {
    if (!wide_enough)
        GTEST_SKIP();
    Random random(10);
    RootFinder finder(40);
    std::vector<Root> touches, all;
    touches.reserve(16);
    for (int n = 0; n < 20000; ++n) {
        std::vector<Wide> roots;
        for (int i = random.integer(1, 5); i > 0; --i)
            roots.push_back(static_cast<Wide>(random.logarithmic(1e-14, 2)));
        std::sort(roots.begin(), roots.end());
        std::vector<double> c =
            rounded(product(from_roots(roots), random.decaying(random.integer(4, 18))), 1); // q, positive at 0
        c.insert(c.begin(), 0.0);
        bool clear = true; // compared only if the roots are well separated relative to round-off
        std::size_t inside = 0;
        for (std::size_t i = 0; i < roots.size(); ++i) {
            const double at = static_cast<double>(roots[i]);
            const double margin = error_at(c, at) / std::abs(static_cast<double>(derivative_wide(c, roots[i])));
            clear &= (i == 0 || roots[i] - roots[i - 1] > 100 * margin) &&
                     (i + 1 == roots.size() || roots[i + 1] - roots[i] > 100 * margin) &&
                     std::abs(roots[i] - 1) > 100 * margin;
            inside += roots[i] < 1 ? 1 : 0;
        }
        if (!clear)
            continue;
        finder.crossings(c, 1, RootStart::deflate, all);
        ASSERT_EQ(all.size(), inside) << n;
        Root root{};
        touches.clear();
        ASSERT_EQ(finder.first_falling(c, 1, RootStart::deflate, root, random.logarithmic(1e-12, 1), &touches),
                  inside > 0);
        for (std::size_t i = 0; i < inside; ++i) {
            const double at = static_cast<double>(roots[i]);
            const double margin = error_at(c, at) / std::abs(static_cast<double>(derivative_wide(c, roots[i])));
            ASSERT_NEAR(all[i].at, at, 2 * margin + unit * at) << n;
        }
        if (inside > 0) {
            const double at = static_cast<double>(roots[0]);
            const double margin = error_at(c, at) / std::abs(static_cast<double>(derivative_wide(c, roots[0])));
            ASSERT_NEAR(root.at, at, 2 * margin + unit * at);
        }
    }
}

TEST(RootFinder, DividesOutMultipleRootsAtTheStart) {
    RootFinder finder(8);
    Root root{};
    ASSERT_TRUE(finder.first_falling(std::vector{0.0, 0.0, 1.0, -2.0}, 1, RootStart::deflate, root));
    EXPECT_NEAR(root.at, 0.5, unit);
    EXPECT_FALSE(finder.first_falling(std::vector{0.0, 0.0, -1.0, 1.0}, 1, RootStart::deflate, root));
    EXPECT_FALSE(finder.first_falling(std::vector{0.0, 0.0, 1.0}, 1, RootStart::deflate, root));
    EXPECT_FALSE(finder.first_falling(std::vector{0.0, 0.0, -1.0}, 1, RootStart::as_is, root));
    // a zero at the start is not a root of the open interval, deflated or not
    ASSERT_TRUE(finder.first_falling(std::vector{0.0, 1.0, -2.0}, 1, RootStart::as_is, root));
    EXPECT_EQ(root.at, 0.5);
}

TEST(RootFinder, AssignsARootAtTheEndToThisStep) {
    Random random(5);
    RootFinder finder(32);
    Root root{};
    for (int n = 0; n < 5000; ++n) {
        const double length = random.logarithmic(1e-3, 1e3);
        // a root within round-off of the end, on either side
        const Wide offset = static_cast<Wide>(random.uniform(-1, 1) * unit);
        const std::vector<double> c = rounded(product({1 + offset, -1}, random.decaying(18)), length);
        ASSERT_TRUE(finder.first_falling(c, length, RootStart::as_is, root));
        ASSERT_LE(root.at, length);
        ASSERT_NEAR(root.at, length, 16 * unit * length);
        std::vector<Root> roots;
        std::vector<double> mirrored;
        for (const double x : c)
            mirrored.push_back(-x);
        finder.crossings(mirrored, length, RootStart::as_is, roots);
        ASSERT_EQ(roots.size(), 1u);
        ASSERT_EQ(roots[0].kind, RootKind::rising);
        ASSERT_EQ(roots[0].at, root.at);
    }
    EXPECT_FALSE(finder.first_falling(std::vector{1.0, -1.0}, 1 - 1e-14, RootStart::as_is, root));
    // roots at both ends
    ASSERT_TRUE(finder.first_falling(std::vector{0.0, 1.0, -1.0}, 1, RootStart::deflate, root));
    EXPECT_EQ(root.at, 1);
}

/// Returns the coefficients about `at`, rounded.
std::vector<double> shifted(const std::vector<double>& c, double at) {
    std::vector<Wide> b(c.begin(), c.end());
    for (std::size_t i = 0; i + 1 < b.size(); ++i)
        for (std::size_t j = b.size() - 1; j-- > i;)
            b[j] += static_cast<Wide>(at) * b[j + 1];
    return {b.begin(), b.end()};
}

TEST(RootFinder, NeitherLosesNorRepeatsRootsWhereStepsMeet) {
    if (!wide_enough)
        GTEST_SKIP();
    Random random(11);
    RootFinder finder(32);
    std::vector<Root> touches;
    int first_step = 0, second_step = 0, touches_seen = 0;
    for (int n = 0; n < 5000; ++n) {
        const double middle = random.uniform(0.3, 0.7);
        const Wide offset = static_cast<Wide>(random.logarithmic(1e-18, 1e-13) * (random.integer(0, 1) ? 1 : -1));
        const std::vector<double> c =
            rounded(product({static_cast<Wide>(middle) + offset, -1}, random.decaying(14)), 1);
        std::vector<double> next = shifted(c, middle);
        next[0] += random.uniform(-0.5, 0.5) * error_at(c, middle); // the state there has its own round-off
        Root root{};
        if (finder.first_falling(c, middle, RootStart::as_is, root)) {
            ++first_step;
            ASSERT_FALSE(finder.first_falling(next, 0.2, RootStart::deflate, root));
        } else {
            ++second_step;
            ASSERT_TRUE(finder.first_falling(next, 0.2, RootStart::as_is, root)) << static_cast<double>(offset);
        }
        // a minimum of 1e-9, below the threshold of touches
        const Wide at = static_cast<Wide>(middle) + offset;
        const std::vector<double> p = rounded({at * at + 1e-9L, -2 * at, 1}, 1);
        touches.clear();
        ASSERT_FALSE(finder.first_falling(p, middle, RootStart::as_is, root, 1e-6, &touches));
        ASSERT_LE(touches.size(), 1u);
        ASSERT_FALSE(finder.first_falling(shifted(p, middle), 0.2, RootStart::as_is, root, 1e-6, &touches));
        ASSERT_GE(touches.size(), 1u);
        touches_seen += static_cast<int>(touches.size());
    }
    EXPECT_GT(first_step, 500);
    EXPECT_GT(second_step, 500);
    EXPECT_LE(touches_seen, 10000);
}

TEST(RootFinder, ScalesExactly) {
    Random random(6);
    RootFinder finder(32);
    for (int n = 0; n < 3000; ++n) {
        std::vector<Wide> roots;
        for (int i = random.integer(1, 6); i > 0; --i)
            roots.push_back(random.uniform(-0.2, 1.5));
        const std::vector<double> c = rounded(product(from_roots(roots), random.decaying(14)), 1);
        const int values = random.integer(-200, 200), places = random.integer(-12, 12);
        std::vector<double> scaled;
        for (std::size_t k = 0; k < c.size(); ++k)
            scaled.push_back(std::ldexp(c[k], values - static_cast<int>(k) * places));
        const double length = std::ldexp(1, places);
        std::vector<Root> plain, other;
        finder.crossings(c, 1, RootStart::as_is, plain);
        finder.crossings(scaled, length, RootStart::as_is, other);
        ASSERT_EQ(plain.size(), other.size());
        for (std::size_t i = 0; i < plain.size(); ++i) {
            ASSERT_EQ(std::ldexp(plain[i].at, places), other[i].at);
            ASSERT_EQ(std::ldexp(plain[i].value, values), other[i].value);
        }
        const Minimum a = finder.minimum(c, 1), b = finder.minimum(scaled, length);
        ASSERT_EQ(std::ldexp(a.at, places), b.at);
        ASSERT_EQ(std::ldexp(a.lower_bound, values), b.lower_bound);
    }
}

TEST(RootFinder, FindsAllCrossings) {
    if (!wide_enough)
        GTEST_SKIP();
    Random random(7);
    RootFinder finder(40);
    std::vector<Root> found;
    for (int n = 0; n < 20000; ++n) {
        std::vector<Wide> roots, inner;
        for (int i = random.integer(0, 7); i > 0; --i)
            roots.push_back(random.uniform(-1, 2));
        std::sort(roots.begin(), roots.end());
        const std::vector<double> c = rounded(product(from_roots(roots), random.decaying(random.integer(0, 20))), 1);
        // compared only if each root is well separated relative to round-off
        bool clear = std::abs(c[0]) > 0;
        for (std::size_t i = 0; i < roots.size(); ++i) {
            const double margin = 8 * error_at(c, 2.1) / std::abs(static_cast<double>(derivative_wide(c, roots[i])));
            clear &= (i == 0 || roots[i] - roots[i - 1] > 100 * margin) && std::abs(roots[i]) > margin &&
                     std::abs(roots[i] - 1) > 100 * margin;
            if (roots[i] > 0 && roots[i] < 1)
                inner.push_back(roots[i]);
        }
        if (!clear)
            continue;
        finder.crossings(c, 1, RootStart::as_is, found);
        ASSERT_EQ(found.size(), inner.size()) << n;
        RootKind kind = RootKind::falling; // positive at first by construction
        for (std::size_t i = 0; i < found.size(); ++i) {
            ASSERT_EQ(found[i].kind, kind);
            kind = kind == RootKind::falling ? RootKind::rising : RootKind::falling;
            const double at = static_cast<double>(inner[i]);
            ASSERT_NEAR(found[i].at, at,
                        2 * error_at(c, at) / std::abs(static_cast<double>(derivative_wide(c, at))) + unit);
        }
    }
}

TEST(RootFinder, BoundsTheMinimum) {
    if (!wide_enough)
        GTEST_SKIP();
    Random random(8);
    RootFinder finder(40);
    for (int n = 0; n < 10000; ++n) {
        std::vector<Wide> roots;
        for (int i = random.integer(0, 6); i > 0; --i)
            roots.push_back(random.uniform(-0.5, 1.5));
        std::vector<Wide> p = product(from_roots(roots), random.decaying(random.integer(0, 18)));
        p[0] += static_cast<Wide>(random.uniform(-1, 1));
        const double length = random.logarithmic(1e-3, 1e3);
        const std::vector<double> c = rounded(p, length);
        const Minimum minimum = finder.minimum(c, length);
        const double resolution = RootFinder::resolution(c, length);
        ASSERT_GE(minimum.at, 0);
        ASSERT_LE(minimum.at, length);
        ASSERT_LE(minimum.lower_bound, minimum.value);
        ASSERT_GE(minimum.lower_bound, minimum.value - 16 * resolution) << n;
        ASSERT_NEAR(minimum.value, static_cast<double>(evaluate_wide(c, minimum.at)), resolution);
        for (int i = 0; i <= 200; ++i)
            ASSERT_GE(evaluate_wide(c, static_cast<Wide>(length) * i / 200), minimum.lower_bound);
    }
    const Minimum parabola = finder.minimum(std::vector{1.0, -2.0, 3.0}, 5);
    EXPECT_NEAR(parabola.at, 1.0 / 3, unit);
    EXPECT_NEAR(parabola.value, 2.0 / 3, 4 * unit);
    const Minimum quartic = finder.minimum(std::vector{0.0625, -0.5, 1.5, -2.0, 1.0}, 1); // (s - 1/2)^4
    EXPECT_NEAR(quartic.value, 0, 10 * unit);
    EXPECT_GT(quartic.lower_bound, -500 * unit);
}

TEST(RootFinder, HandlesInvalidInput) {
    RootFinder finder(64);
    Root root{};
    std::vector<Root> roots, touches;
    const double infinite = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::vector<double>> useless{{},
                                                   {0.0},
                                                   {0.0, 0.0, 0.0},
                                                   {1.0},
                                                   {-1.0, 0.0},
                                                   {nan, 1.0},
                                                   {1.0, nan},
                                                   {1.0, -infinite},
                                                   {1e308, -1e308, -1e308}};
    for (const auto& c : useless) {
        EXPECT_FALSE(finder.first_falling(c, 1, RootStart::as_is, root, 1e-3, &touches));
        EXPECT_FALSE(finder.first_falling(c, 1, RootStart::deflate, root));
        finder.crossings(c, 1, RootStart::as_is, roots);
        EXPECT_TRUE(roots.empty());
        EXPECT_TRUE(touches.empty());
        EXPECT_FALSE(std::isnan(finder.minimum(c, 1).value));
    }
    for (const double length : {0.0, -1.0, infinite, nan}) {
        EXPECT_FALSE(finder.first_falling(std::vector{1.0, -2.0}, length, RootStart::as_is, root));
        EXPECT_FALSE(RootFinder::surely_positive(std::vector{1.0, nan}, length, RootStart::as_is));
    }
    EXPECT_FALSE(RootFinder::surely_positive(std::vector{1.0}, 1, RootStart::deflate));
    EXPECT_FALSE(RootFinder::surely_positive(std::vector{1.0, nan, 1.0}, 1, RootStart::as_is));
    EXPECT_FALSE(RootFinder::surely_positive(std::vector{1.0, infinite}, 1, RootStart::as_is));
    EXPECT_THROW(RootFinder(3).first_falling(std::vector{1.0, 0.0, 0.0, 0.0, -2.0}, 1, RootStart::as_is, root),
                 InputError);
    // trailing zeros have no effect
    ASSERT_TRUE(finder.first_falling(std::vector{1.0, -2.0, 0.0, 0.0}, 1, RootStart::as_is, root));
    EXPECT_EQ(root.at, 0.5);
}

TEST(RootFinder, HandlesIllConditionedPolynomials) {
    if (!wide_enough)
        GTEST_SKIP();
    RootFinder finder(64);
    for (int degree = 1; degree <= 20; ++degree) { // Wilkinson's, with roots k / (n + 1)
        std::vector<Wide> roots;
        std::vector<double> places;
        for (int k = 1; k <= degree; ++k) {
            roots.push_back(static_cast<Wide>(k) / (degree + 1));
            places.push_back((k + 0.5) / (degree + 1));
        }
        SCOPED_TRACE(degree);
        check_first_falling(finder, rounded(from_roots(roots), 1), 1, places);
        std::vector<Root> found;
        finder.crossings(rounded(from_roots(roots), 1), 1, RootStart::as_is, found);
        if (degree <= 10) {
            ASSERT_EQ(found.size(), roots.size());
        }
    }
    for (const int degree : {10, 20, 30, 45, 64}) { // Chebyshev's on [0, 1]: the last ones are round-off only
        std::vector<Wide> previous{1}, current{-1, 2};
        for (int k = 2; k <= degree; ++k) {
            std::vector<Wide> next = product({-2, 4}, current);
            for (std::size_t i = 0; i < previous.size(); ++i)
                next[i] -= previous[i];
            previous = current;
            current = next;
        }
        SCOPED_TRACE(degree);
        check_first_falling(finder, rounded(current, 1), 1, {});
        check_first_falling(finder,
                            rounded(product(current, current), 1).size() <= 65 ? rounded(product(current, current), 1)
                                                                               : rounded(current, 1),
                            1, {});
    }
    Random random(9);
    for (int n = 0; n < 3000; ++n) { // random coefficients of all sizes
        std::vector<double> c;
        for (int k = random.integer(0, 40); k >= 0; --k)
            c.push_back(random.uniform(-1, 1) * random.logarithmic(1e-30, 1));
        SCOPED_TRACE(n);
        check_first_falling(finder, c, random.logarithmic(1e-2, 1e2), {});
        if (HasFatalFailure())
            return;
    }
    for (int n = 1; n < 60; n += 4) { // (1/2 - s)^n: zero within round-off on a wide interval
        std::vector<Wide> p{1};
        for (int k = 0; k < n; ++k)
            p = product(p, {0.5L, -1});
        SCOPED_TRACE(n);
        check_first_falling(finder, rounded(p, 1), 1, {});
    }
}

} // namespace graze::roots_test
