#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace graze {

/// A plane frame by finite elements: displacements of joints, with cubic polynomials in each element.
class PlaneFrame {
public:
    std::size_t add_joint(double x, double y) {
        joints_.push_back({x, y});
        return joints_.size() - 1;
    }
    /// Adds a beam, divided into equal elements.
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
    /// Stiffness: force that moves some joints by one in x, without rotation or motion in y, while others are held; and
    /// twice the kinetic energy at unit speed of those.
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
    /// Solves by elimination; the matrix is symmetric and positive. In double precision rigid joints would cost ten
    /// digits.
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

} // namespace graze
