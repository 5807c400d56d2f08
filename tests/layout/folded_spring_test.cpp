#include "graze/layout/folded_spring.hpp"

#include "graze/symbolic/input_error.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace graze {
namespace {

/// A plane frame by finite elements: displacements of joints, each element a cubic polynomial.
class PlaneFrame {
public:
    std::size_t add_joint(double x, double y) {
        joints_.push_back({x, y});
        return joints_.size() - 1;
    }
    /// In equal elements.
    void add_beam(std::size_t from, std::size_t to, double bending, double stretching, double density = 0,
                  int elements = 8) {
        std::size_t last = from;
        for (int i = 1; i < elements; ++i) {
            const double share = static_cast<double>(i) / elements;
            const std::size_t next = add_joint(joints_[from][0] + share * (joints_[to][0] - joints_[from][0]),
                                               joints_[from][1] + share * (joints_[to][1] - joints_[from][1]));
            elements_.push_back({last, next, bending, stretching, density});
            last = next;
        }
        elements_.push_back({last, to, bending, stretching, density});
    }
    /// Force that moves some joints by one in x, without a turn or a motion in y, while others are held; and twice the
    /// kinetic energy at unit speed of those.
    std::pair<double, double> driven(const std::vector<std::size_t>& moved,
                                     const std::vector<std::size_t>& held) const {
        const std::size_t n = 3 * joints_.size();
        std::vector<std::vector<long double>> stiffness(n, std::vector<long double>(n)), mass = stiffness;
        for (const Element& one : elements_)
            assemble(one, stiffness, mass);
        std::vector<long double> motion(n), right(n);
        for (const std::size_t joint : moved)
            motion[3 * joint] = 1;
        for (std::size_t i = 0; i < n; ++i)
            for (const std::size_t joint : moved)
                right[i] -= stiffness[i][3 * joint];
        std::vector<std::vector<long double>> reduced = stiffness;
        for (const auto& joints : {held, moved})
            for (const std::size_t joint : joints)
                for (std::size_t k = 3 * joint; k < 3 * joint + 3; ++k) {
                    for (std::size_t i = 0; i < n; ++i)
                        reduced[i][k] = reduced[k][i] = 0;
                    reduced[k][k] = 1;
                    right[k] = motion[k];
                }
        solve(reduced, right);
        long double force = 0, energy = 0;
        for (std::size_t i = 0; i < n; ++i) {
            for (const std::size_t joint : moved)
                force += stiffness[3 * joint][i] * right[i];
            for (std::size_t k = 0; k < n; ++k)
                energy += right[i] * mass[i][k] * right[k];
        }
        return {static_cast<double>(force), static_cast<double>(energy)};
    }

private:
    struct Element {
        std::size_t from, to;
        double bending, stretching, density; // E I, E A, mass by length
    };
    using Matrix = std::array<std::array<double, 6>, 6>;

    void assemble(const Element& one, std::vector<std::vector<long double>>& stiffness,
                  std::vector<std::vector<long double>>& mass) const {
        const double dx = joints_[one.to][0] - joints_[one.from][0], dy = joints_[one.to][1] - joints_[one.from][1];
        const double l = std::hypot(dx, dy), c = dx / l, s = dy / l;
        const double b = one.bending / (l * l * l), a = one.stretching / l, m = one.density * l / 420;
        const Matrix local{{{a, 0, 0, -a, 0, 0},
                            {0, 12 * b, 6 * b * l, 0, -12 * b, 6 * b * l},
                            {0, 6 * b * l, 4 * b * l * l, 0, -6 * b * l, 2 * b * l * l},
                            {-a, 0, 0, a, 0, 0},
                            {0, -12 * b, -6 * b * l, 0, 12 * b, -6 * b * l},
                            {0, 6 * b * l, 2 * b * l * l, 0, -6 * b * l, 4 * b * l * l}}};
        const Matrix inert{{{140 * m, 0, 0, 70 * m, 0, 0},
                            {0, 156 * m, 22 * m * l, 0, 54 * m, -13 * m * l},
                            {0, 22 * m * l, 4 * m * l * l, 0, 13 * m * l, -3 * m * l * l},
                            {70 * m, 0, 0, 140 * m, 0, 0},
                            {0, 54 * m, 13 * m * l, 0, 156 * m, -22 * m * l},
                            {0, -13 * m * l, -3 * m * l * l, 0, -22 * m * l, 4 * m * l * l}}};
        Matrix turn{};
        for (const std::size_t k : {std::size_t{0}, std::size_t{3}}) {
            turn[k][k] = turn[k + 1][k + 1] = c;
            turn[k][k + 1] = s;
            turn[k + 1][k] = -s;
            turn[k + 2][k + 2] = 1;
        }
        const auto place = [&](std::size_t i) { return 3 * (i < 3 ? one.from : one.to) + i % 3; };
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 0; j < 6; ++j)
                for (std::size_t p = 0; p < 6; ++p)
                    for (std::size_t q = 0; q < 6; ++q) {
                        stiffness[place(i)][place(j)] += turn[p][i] * local[p][q] * turn[q][j];
                        mass[place(i)][place(j)] += turn[p][i] * inert[p][q] * turn[q][j];
                    }
    }
    /// Elimination; the matrix is symmetric and positive. In double precision rigid joints would cost ten digits.
    static void solve(std::vector<std::vector<long double>>& matrix, std::vector<long double>& right) {
        const std::size_t n = right.size();
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = i + 1; k < n; ++k) {
                const long double factor = matrix[k][i] / matrix[i][i];
                if (factor == 0)
                    continue;
                for (std::size_t j = i; j < n; ++j)
                    matrix[k][j] -= factor * matrix[i][j];
                right[k] -= factor * right[i];
            }
        for (std::size_t i = n; i-- > 0;) {
            for (std::size_t j = i + 1; j < n; ++j)
                right[i] -= matrix[i][j] * right[j];
            right[i] /= matrix[i][i];
        }
    }

    std::vector<std::array<double, 2>> joints_;
    std::vector<Element> elements_;
};

/// Both halves of a flexure whose walls are straight, without the links' mass, divided by two; joints are made 1e4
/// times stiffer than trusses.
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
            const double joint = i == 0 ? mass : 2 * mass; // of all of the beam's width; the branch has the other half
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
            .modulus = 1.69e11};
}

TEST(FoldedSpring, IsAsStiffAsItsFiniteElements) {
    for (const std::size_t beams : {2U, 4U, 6U})
        for (const double truss : {4e-6, 10e-6, 40e-6}) {
            const FoldedSpring spring = spring_of(beams, truss);
            const double stiffness = by_elements(spring, 0).first;
            // Joints are not quite rigid.
            EXPECT_NEAR(properties_of(spring).stiffness, stiffness, 1e-4 * stiffness) << beams << ' ' << truss;
        }
}

TEST(FoldedSpring, WithStiffTrussesIsARowOfGuidedBeams) {
    FoldedSpring spring = spring_of(2, 40e-6);
    spring.modulus = 1;
    for (const double width : {4e-6, 1e-6}) {
        spring.beam_width = {.top = width, .bottom = width};
        spring.truss_width = {.top = 400e-6, .bottom = 400e-6};
        const SpringProperties found = properties_of(spring);
        const double guided = 0.5 * spring.height * std::pow(width / spring.beam_length, 3);
        EXPECT_NEAR(found.stiff_trusses, guided, 1e-14 * guided);
        // The truss turns a little, as beams are stretched: (width/spacing)^2 of the stiffness.
        EXPECT_NEAR(found.stiffness, guided, 0.5 * guided * std::pow(width / spring.spacing, 2));
        // 3 E w (u/2)/L^2 in each of two beams, and the axial force that stretches them.
        const double bending = 1.5 * width / (spring.beam_length * spring.beam_length);
        EXPECT_NEAR(found.stress_per_travel, bending, bending * width / spring.spacing);
    }
}

TEST(FoldedSpring, BendsLikeTheCubeOfItsWidthAndOfItsLength) {
    FoldedSpring spring = spring_of(2, 40e-6);
    const double first = properties_of(spring).stiffness;
    spring.beam_width = {.top = 6.06e-6, .bottom = 6.06e-6};
    EXPECT_NEAR(std::log(properties_of(spring).stiffness / first) / std::log(1.01), 3, 0.1); // trusses bend, too
    spring.beam_width = {.top = 5.5e-6, .bottom = 6.5e-6};
    // Walls that are not vertical: mean of (6 + x)^3 = 216 (1 + (0.5/6)^2).
    EXPECT_NEAR(properties_of(spring).stiffness / first, 1 + 0.25 / 36, 1e-4);
    spring = spring_of(2, 40e-6);
    for (double* size :
         {&spring.beam_length, &spring.spacing, &spring.half_middle, &spring.height, &spring.beam_width.top,
          &spring.beam_width.bottom, &spring.truss_width.top, &spring.truss_width.bottom})
        *size *= 1e9; // in nm, or as large as a moon: the same shape is as much stiffer as it is larger
    EXPECT_NEAR(properties_of(spring).stiffness, 1e9 * first, 1e-4 * first);
}

TEST(FoldedSpring, MovesAShareOfItsOwnMass) {
    // Rayleigh's quotient of the static shape; where trusses are stiff that is the shape of guided beams.
    const FoldedSpring spring = spring_of(2, 100e-6);
    const double energy = by_elements(spring, 2330).second;
    const double area = properties_of(spring).moving_area;
    EXPECT_NEAR(2330 * spring.height * area, energy, 0.005 * energy); // axial motion and turns of the trusses
    // Two beams of 12/35 each and a quarter of the truss.
    const double beams = 2 * 6e-6 * 1.15e-3 * 12 / 35, truss = 0.25 * 100e-6 * 72e-6;
    EXPECT_NEAR(area, beams + truss, 1e-12 * area);
}

TEST(FoldedSpring, RefusesWhatIsNoSpring) {
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

} // namespace
} // namespace graze
