#include "graze/layout/squeeze_film.hpp"

#include "graze/base/input_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace graze::squeeze_film_test {

const Gas air{.pressure = 101325, .viscosity = 1.82e-5, .mean_free_path = 67e-9};
/// A gas so dense that it does not slip.
const Gas dense{.pressure = 1e12, .viscosity = 1.82e-5, .mean_free_path = 67e-9};

EtchedWidth straight(double gap) {
    return {.top = gap, .bottom = gap};
}

/// Solves Reynolds' equation on a grid by over-relaxation: damping of a film with sides 1 and `length`, mu = 1, and a
/// gap that varies linearly along the first side.
double damping_on_grid(double length, double top, double bottom, int n) {
    const int m = static_cast<int>(std::lround(n * length));
    const double h = 1.0 / n;
    std::vector<double> p(static_cast<std::size_t>((n + 1) * (m + 1)));
    const auto at = [&](int i, int j) -> double& {
        const int place = i * (m + 1) + j;
        return p[static_cast<std::size_t>(place)];
    };
    const auto cube = [&](double z) { return std::pow(top + (bottom - top) * z, 3); };
    const double over = 2 / (1 + std::sin(std::numbers::pi / n));
    for (int sweep = 0; sweep < 40 * n; ++sweep)
        for (int i = 1; i < n; ++i) {
            const double before = cube((i - 0.5) * h), after = cube((i + 0.5) * h), here = cube(i * h);
            for (int j = 1; j < m; ++j) {
                const double sum = before * at(i - 1, j) + after * at(i + 1, j) + here * (at(i, j - 1) + at(i, j + 1));
                at(i, j) += over * ((sum + 12 * h * h) / (before + after + 2 * here) - at(i, j));
            }
        }
    double force = 0;
    for (const double one : p)
        force += one * h * h;
    return force;
}

TEST(SqueezeFilm, EqualsKnownValuesOfALongAndASquareFilm) {
    // A square film: 0.42173 mu s^4/g^3 (tabulated, five digits).
    const double square = squeeze_film_damping({.length = 1e-3, .height = 1e-3, .gap = straight(1e-5)}, dense);
    EXPECT_NEAR(square / (1.82e-5 * 1e-12 / 1e-15), 0.42173, 1e-5);
    const double longest = squeeze_film_damping({.length = 1, .height = 1e-3, .gap = straight(1e-5)}, dense);
    // The ends reduce the length by 0.63 heights: 192 zeta(5) (31/32)/pi^5.
    const double ends = 192 * 1.0369277551433699 * (31.0 / 32) / std::pow(std::numbers::pi, 5);
    EXPECT_NEAR(longest / (1.82e-5 * 1e-9 / 1e-15), 1 - 1e-3 * ends, 1e-9); // slip: 2e-10
    // Either side may be the longer.
    EXPECT_DOUBLE_EQ(squeeze_film_damping({.length = 3e-4, .height = 1e-3, .gap = straight(1e-5)}, dense),
                     squeeze_film_damping({.length = 1e-3, .height = 3e-4, .gap = straight(1e-5)}, dense));
}

TEST(SqueezeFilm, SolvesReynoldsEquation) {
    const Gas unit{.pressure = 1e20, .viscosity = 1, .mean_free_path = 1e-9};
    // Second-order differences, extrapolated from two grids.
    const auto exact = [](double length, double top, double bottom) {
        return (4 * damping_on_grid(length, top, bottom, 40) - damping_on_grid(length, top, bottom, 20)) / 3;
    };
    EXPECT_NEAR(squeeze_film_damping({.length = 2, .height = 1, .gap = straight(1)}, unit), exact(2, 1, 1), 2e-5);
    // A wedge: the factor for the ends is that of a constant gap, a small error.
    const double wedge = squeeze_film_damping({.length = 6, .height = 1, .gap = {.top = 0.8, .bottom = 1.2}}, unit);
    EXPECT_NEAR(wedge, exact(6, 0.8, 1.2), 0.01 * wedge);
}

TEST(SqueezeFilm, OfAWedgeEqualsItsIntegral) {
    for (const double a : {0.0, 0.05, 0.0999999, 0.1, 0.1000001, 0.5}) {
        // 12 (I2 - I1^2/I0) by the midpoint rule.
        double i0 = 0, i1 = 0, i2 = 0;
        constexpr int n = 20000;
        for (int k = 0; k < n; ++k) {
            const double z = (k + 0.5) / n, g = 1 - a + 2 * a * z, weight = 1 / (g * g * g * n);
            i0 += weight;
            i1 += z * weight;
            i2 += z * z * weight;
        }
        const GasFilm film{.length = 1e9, .height = 1, .gap = {.top = 1 - a, .bottom = 1 + a}};
        const double found = squeeze_film_damping(film, {.pressure = 1e20, .viscosity = 1e-9, .mean_free_path = 1e-9});
        EXPECT_NEAR(found, 12 * (i2 - i1 * i1 / i0), 1e-7) << a; // the rule's error is 1e-8
    }
}

TEST(SqueezeFilm, IsReducedInARarefiedGas) {
    EXPECT_NEAR(effective_viscosity(air, 1e-3), air.viscosity, 2e-4 * air.viscosity);
    Gas thin = air;
    thin.pressure = air.pressure / 100;
    EXPECT_DOUBLE_EQ(mean_free_path_of(thin), 6.7e-6);
    // K = 1: lower by 10.638.
    EXPECT_NEAR(effective_viscosity(thin, 6.7e-6), air.viscosity / 10.638, 1e-12 * air.viscosity);
    const GasFilm film{.length = 4e-3, .height = 2.5e-4, .gap = straight(1.5e-5)};
    EXPECT_LT(squeeze_film_damping(film, thin), squeeze_film_damping(film, air));
    // 12 mu omega s^2/(p g^2), with negligible slip.
    EXPECT_NEAR(squeeze_number(film, dense, 6283) * 1e12, 12 * 1.82e-5 * 6283 * 6.25e-8 / 2.25e-10, 1e-6);
}

TEST(SqueezeFilm, SlipsAtBothWallsWhenSheared) {
    // The speed falls by 2 lambda du/dz at the walls: 1 + 2 K, with K = 1 a third.
    Gas thin = air;
    thin.pressure = air.pressure / 100;
    EXPECT_NEAR(sliding_film_damping(1e-6, 6.7e-6, thin), air.viscosity * 1e-6 / 6.7e-6 / 3, 1e-20);
    EXPECT_NEAR(sliding_film_damping(1e-6, 1e-5, dense), 1.82e-6, 1e-14);
    EXPECT_THROW(sliding_film_damping(1, 0, air), InputError);
}

TEST(SqueezeFilm, RefusesInvalidFilms) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(squeeze_film_damping({.length = 0, .height = 1, .gap = straight(1)}, air), InputError);
    EXPECT_THROW(squeeze_film_damping({.length = 1, .height = nan, .gap = straight(1)}, air), InputError);
    EXPECT_THROW(squeeze_film_damping({.length = 1, .height = 1, .gap = {.top = 1, .bottom = -1}}, air), InputError);
    EXPECT_THROW(effective_viscosity({.pressure = -1, .viscosity = 1, .mean_free_path = 1}, 1), InputError);
    EXPECT_THROW(sliding_film_damping(-1, 1, air), InputError);
}

} // namespace graze::squeeze_film_test
