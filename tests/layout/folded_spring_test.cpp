#include "graze/layout/folded_spring.hpp"

#include "graze/base/input_error.hpp"
#include "plane_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace graze::folded_spring_test {

/// Finite elements of both halves of a flexure with vertical walls, without the links' mass, divided by two; joints are
/// 1e4 times stiffer than trusses.
std::pair<double, double> by_elements(const FoldedSpring& spring, double density) {
    const double w = spring.beam_width.top, t = spring.truss_width.top, l = spring.beam_length, h = spring.height;
    const auto bending = [&](double width) { return spring.modulus * h * width * width * width / 12; };
    const auto stretching = [&](double width) { return spring.modulus * h * width; };
    constexpr double rigid = 1e4;
    const double truss = density * h * t;
    PlaneFrame frame;
    std::vector<std::size_t> held, moved, middles;
    for (const double side : {1.0, -1.0}) {
        double x = side * (spring.half_middle + w / 2), y = 0, direction = 1;
        std::size_t last = frame.add_joint(x, y);
        held.push_back(last);
        const auto go = [&](double dx, double dy, double i, double a, double mass, int elements) {
            x += side * dx;
            y += dy;
            const std::size_t next = frame.add_joint(x, y);
            frame.add_beam(last, next, i, a, mass, elements);
            last = next;
        };
        for (std::size_t i = 0; i < spring.beams; ++i) {
            const bool is_last = i + 1 == spring.beams;
            const double mass = is_last ? 0 : truss;
            go(0, direction * l, bending(w), stretching(w), density * h * w, 6);
            go(0, direction * t / 2, rigid * bending(t), rigid * stretching(t), 0, 1);
            if (i == 0)
                middles.push_back(last);
            const double joint = i == 0 ? mass : 2 * mass; // of the whole beam's width; the branch has the other half
            go(w / 2, 0, rigid * bending(t), rigid * stretching(t), joint, 1);
            go(spring.spacing, 0, bending(t), stretching(t), mass, 2);
            if (!is_last) {
                go(w / 2, 0, rigid * bending(t), rigid * stretching(t), 2 * mass, 1);
                go(0, -direction * t / 2, rigid * bending(t), rigid * stretching(t), 0, 1);
            }
            direction = -direction;
        }
        moved.push_back(last);
    }
    const double at = l + t / 2;
    const std::size_t left = frame.add_joint(-spring.half_middle, at), right = frame.add_joint(spring.half_middle, at);
    frame.add_beam(middles[0], right, rigid * bending(t), rigid * stretching(t), truss, 1);
    frame.add_beam(middles[1], left, rigid * bending(t), rigid * stretching(t), truss, 1);
    frame.add_beam(left, right, bending(t), stretching(t), truss, 2);
    const auto [force, energy] = frame.driven(moved, held);
    return {force / 2, energy / 2};
}

FoldedSpring spring_of(std::size_t beams, double truss) {
    return {.beams = beams,
            .beam_length = 1.15e-3,
            .beam_width = {.top = 6e-6, .bottom = 6e-6},
            .spacing = 30e-6,
            .half_middle = 30e-6,
            .truss_width = {.top = truss, .bottom = truss},
            .height = 2.5e-4,
            .modulus = 1.69e11,
            .finger_length = 0,
            .bar_length = 0,
            .bar_width = {}};
}

TEST(FoldedSpring, HasTheStiffnessOfItsFiniteElements) {
    for (const std::size_t beams : {2U, 4U, 6U})
        for (const double truss : {4e-6, 10e-6, 40e-6}) {
            const FoldedSpring spring = spring_of(beams, truss);
            const double stiffness = by_elements(spring, 0).first;
            // Joints are not quite rigid.
            EXPECT_NEAR(properties_of(spring).stiffness, stiffness, 1e-4 * stiffness) << beams << ' ' << truss;
        }
}

TEST(FoldedSpring, WithStiffTrussesEqualsGuidedBeamsInSeries) {
    FoldedSpring spring = spring_of(2, 40e-6);
    spring.modulus = 1;
    for (const double width : {4e-6, 1e-6}) {
        spring.beam_width = {.top = width, .bottom = width};
        spring.truss_width = {.top = 400e-6, .bottom = 400e-6};
        const SpringProperties found = properties_of(spring);
        const double guided = 0.5 * spring.height * std::pow(width / spring.beam_length, 3);
        EXPECT_NEAR(found.stiff_trusses, guided, 1e-14 * guided);
        // The truss rotates a little, as beams stretch: (width/spacing)^2 of the stiffness.
        EXPECT_NEAR(found.stiffness, guided, 0.5 * guided * std::pow(width / spring.spacing, 2));
        // 3 E w (u/2)/L^2 in each of two beams, plus the axial force that stretches them.
        const double bending = 1.5 * width / (spring.beam_length * spring.beam_length);
        EXPECT_NEAR(found.stress_per_travel, bending, bending * width / spring.spacing);
    }
}

TEST(FoldedSpring, ScalesWithTheCubeOfWidthOverLength) {
    FoldedSpring spring = spring_of(2, 40e-6);
    const double first = properties_of(spring).stiffness;
    spring.beam_width = {.top = 6.06e-6, .bottom = 6.06e-6};
    EXPECT_NEAR(std::log(properties_of(spring).stiffness / first) / std::log(1.01), 3, 0.1); // trusses bend, too
    spring.beam_width = {.top = 5.5e-6, .bottom = 6.5e-6};
    // Inclined walls: mean of (6 + x)^3 = 216 (1 + (0.5/6)^2).
    EXPECT_NEAR(properties_of(spring).stiffness / first, 1 + 0.25 / 36, 1e-4);
    spring = spring_of(2, 40e-6);
    for (double* size :
         {&spring.beam_length, &spring.spacing, &spring.half_middle, &spring.height, &spring.beam_width.top,
          &spring.beam_width.bottom, &spring.truss_width.top, &spring.truss_width.bottom})
        *size *= 1e9; // in nm: stiffness is proportional to size for the same shape
    EXPECT_NEAR(properties_of(spring).stiffness, 1e9 * first, 1e-4 * first);
}

TEST(FoldedSpring, MovesTheShareOfItsMassByRayleighsQuotient) {
    // Rayleigh's quotient of the static shape; with stiff trusses this is the shape of guided beams.
    const FoldedSpring spring = spring_of(2, 100e-6);
    const double energy = by_elements(spring, 2330).second;
    const double area = properties_of(spring).moving_area;
    // neglected: axial motion and rotation of the trusses
    EXPECT_NEAR(2330 * spring.height * area, energy, 0.005 * energy);
    // Two beams of 12/35 each, and a quarter of the truss.
    const double beams = 2 * 6e-6 * 1.15e-3 * 12 / 35, truss = 0.25 * 100e-6 * 72e-6;
    EXPECT_NEAR(area, beams + truss, 1e-12 * area);
}

TEST(FoldedSpring, RefusesInvalidSprings) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto field : {&FoldedSpring::beam_length, &FoldedSpring::spacing, &FoldedSpring::half_middle,
                             &FoldedSpring::height, &FoldedSpring::modulus})
        for (const double wrong : {0.0, -1.0, nan}) {
            FoldedSpring spring = spring_of(2, 40e-6);
            spring.*field = wrong;
            EXPECT_THROW(properties_of(spring), InputError);
        }
    FoldedSpring etched_away = spring_of(2, 40e-6);
    etched_away.beam_width.bottom = 0;
    EXPECT_THROW(properties_of(etched_away), InputError);
    EXPECT_THROW(properties_of(spring_of(1, 40e-6)), InputError);
}

} // namespace graze::folded_spring_test
