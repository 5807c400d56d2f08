#include "graze/layout/plate_attraction.hpp"

#include "graze/base/input_error.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace graze::plate_attraction_test {

/// A strip of surface charge.
struct Strip {
    double x, y, tx, ty, length; // start, direction
};

/// Divides the outline of a block into strips that are finer towards the edges, where charge concentrates.
void add_block(std::vector<Strip>& strips, double left, double right, double height, int n) {
    const std::array<std::array<double, 2>, 5> corners{
        {{left, 0}, {right, 0}, {right, height}, {left, height}, {left, 0}}};
    for (std::size_t side = 0; side < 4; ++side) {
        const double dx = corners[side + 1][0] - corners[side][0], dy = corners[side + 1][1] - corners[side][1];
        const auto share = [n](int k) { return 0.5 * (1 - std::cos(std::numbers::pi * k / n)); };
        for (int k = 0; k < n; ++k) {
            const double extent = std::hypot(dx, dy), a = share(k), b = share(k + 1);
            strips.push_back(
                {corners[side][0] + a * dx, corners[side][1] + a * dy, dx / extent, dy / extent, (b - a) * extent});
        }
    }
}

/// Capacitance per length over epsilon of two blocks in free space by boundary elements (constant charge, exact
/// potentials, collocation at the middle of each strip).
double capacitance_by_charges(double height, double gap, double backing, int n) {
    std::vector<Strip> strips;
    add_block(strips, -0.5 * gap - backing, -0.5 * gap, height, n);
    add_block(strips, 0.5 * gap, 0.5 * gap + backing, height, n);
    const auto size = static_cast<Eigen::Index>(strips.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size + 1, size + 1);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size + 1), lengths(size);
    for (Eigen::Index i = 0; i < size; ++i) {
        const Strip& at = strips[static_cast<std::size_t>(i)];
        const double mx = at.x + 0.5 * at.length * at.tx, my = at.y + 0.5 * at.length * at.ty;
        for (Eigen::Index j = 0; j < size; ++j) {
            const Strip& from = strips[static_cast<std::size_t>(j)];
            const double dx = mx - from.x, dy = my - from.y, along = dx * from.tx + dy * from.ty,
                         beside = std::abs(dy * from.tx - dx * from.ty);
            const auto integral = [beside](double u) {
                const double square = u * u + beside * beside;
                return 0.5 * u * std::log(square) - u + (beside > 0 ? beside * std::atan(u / beside) : 0);
            };
            matrix(i, j) = -(integral(from.length - along) - integral(-along)) / (2 * std::numbers::pi);
        }
        matrix(i, size) = 1; // the potential is known up to a constant, and the total charge is zero
        matrix(size, i) = lengths[i] = at.length;
        right[i] = i < size / 2 ? 0.5 : -0.5;
    }
    const Eigen::VectorXd charge = matrix.partialPivLu().solve(right);
    return charge.head(size / 2).dot(lengths.head(size / 2));
}

TEST(PlateAttraction, HasTheFringeOfBoundaryElements) {
    struct Case {
        double height, gap, backing, share; // allowed error of the fringe
    };
    // For thick blocks, as in a device, the error is 2 percent of the fringe; for sheets, and plates of few gaps, 15.
    for (const Case& one :
         {Case{250, 15, 300, 0.02}, Case{250, 5, 100, 0.02}, Case{50, 10, 10, 0.1}, Case{250, 15, 1, 0.15}}) {
        const auto charged = [&](double gap) { return capacitance_by_charges(one.height, gap, one.backing, 40); };
        const double by_charges = charged(one.gap);
        EXPECT_NEAR(capacitance_by_length(one.height, one.gap, one.backing), by_charges, 0.015 * by_charges);
        const double step = 0.01 * one.gap; // error of the difference: 1e-4 of the force
        const double force = (charged(one.gap - step) - charged(one.gap + step)) / (2 * step);
        const double seen = force * one.gap * one.gap; // height of plates without fringe field and equal force
        constexpr double length = 1e9;
        const EquivalentPlates plates = equivalent_plates({.length = length,
                                                           .height = one.height,
                                                           .backing = one.backing,
                                                           .gap = {.top = one.gap, .bottom = one.gap}});
        EXPECT_DOUBLE_EQ(plates.gap, one.gap);
        EXPECT_NEAR(plates.area / length - one.height, seen - one.height, one.share * (seen - one.height));
    }
}

TEST(PlateAttraction, IsTheDerivativeOfItsCapacitance) {
    constexpr double height = 250, gap = 15, backing = 300, length = 1e12, step = 1e-4;
    const double slope =
        (capacitance_by_length(height, gap - step, backing) - capacitance_by_length(height, gap + step, backing)) /
        (2 * step);
    const EquivalentPlates plates =
        equivalent_plates({.length = length, .height = height, .backing = backing, .gap = {.top = gap, .bottom = gap}});
    // Round-off of the difference: 1e-16/1e-4 of 20.
    EXPECT_NEAR(plates.area / (length * gap * gap), slope, 1e-10);
}

TEST(PlateAttraction, OfAWedgeHasItsForceAndDerivative) {
    constexpr double top = 14, bottom = 17, height = 1e6, length = 1e6; // negligible fringe field
    const EquivalentPlates plates =
        equivalent_plates({.length = length, .height = height, .backing = 0, .gap = {.top = top, .bottom = bottom}});
    // Integrals over the depth of 1/g^2 and 2/g^3 by the midpoint rule, to 1e-9.
    double force = 0, derivative = 0;
    constexpr int n = 20000;
    for (int k = 0; k < n; ++k) {
        const double g = top + (bottom - top) * (k + 0.5) / n;
        force += 1 / (g * g * n);
        derivative += 2 / (g * g * g * n);
    }
    const double area = plates.area / (height * length), d = plates.gap;
    EXPECT_NEAR(area / (d * d), force, 1e-4 * force); // the fringe: 1e-5 of the height
    EXPECT_NEAR(2 * area / (d * d * d), derivative, 1e-4 * derivative);
    EXPECT_NEAR((2 / d) / (derivative / force), 1, 1e-8);
}

TEST(PlateAttraction, RefusesInvalidPlates) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const FacingPlates good{
        .length = 4e-3, .height = 2.5e-4, .backing = 3e-4, .gap = {.top = 1.5e-5, .bottom = 1.5e-5}};
    EXPECT_NO_THROW(equivalent_plates(good));
    for (const auto field : {&FacingPlates::length, &FacingPlates::height})
        for (const double wrong : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
            FacingPlates bad = good;
            bad.*field = wrong;
            EXPECT_THROW(equivalent_plates(bad), InputError);
        }
    FacingPlates closed = good;
    closed.gap.bottom = 0;
    EXPECT_THROW(equivalent_plates(closed), InputError);
    EXPECT_THROW(capacitance_by_length(1, nan, 0), InputError);
}

} // namespace graze::plate_attraction_test
