#pragma once

#include <Eigen/Dense>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace graze {

/// A plane frame by finite elements: displacements of joints, with cubic polynomials in each element.
class PlaneFrame {
public:
    std::size_t add_joint(double x, double y) {
        joints_.emplace_back(x, y);
        return joints_.size() - 1;
    }
    /// Adds a beam, divided into equal elements.
    void add_beam(std::size_t from, std::size_t to, double bending, double stretching, double density = 0,
                  int elements = 8) {
        std::size_t last = from;
        for (int i = 1; i < elements; ++i) {
            const Eigen::Vector2d at =
                joints_[from] + static_cast<double>(i) / elements * (joints_[to] - joints_[from]);
            const std::size_t next = add_joint(at.x(), at.y());
            elements_.push_back({last, next, bending, stretching, density});
            last = next;
        }
        elements_.push_back({last, to, bending, stretching, density});
    }
    /// Stiffness: force that moves some joints by one in x, without rotation or motion in y, while others are held; and
    /// twice the kinetic energy at unit speed of those.
    std::pair<double, double> driven(const std::vector<std::size_t>& moved,
                                     const std::vector<std::size_t>& held) const {
        const auto n = static_cast<Eigen::Index>(3 * joints_.size());
        Matrix stiffness = Matrix::Zero(n, n), mass = stiffness;
        for (const Element& one : elements_)
            assemble(one, stiffness, mass);
        Vector motion = Vector::Zero(n);
        for (const std::size_t joint : moved)
            motion[first_of(joint)] = 1;
        const Vector force = stiffness * motion;
        Matrix reduced = stiffness;
        Vector right = -force;
        for (const auto& joints : {held, moved})
            for (const std::size_t joint : joints)
                for (Eigen::Index k = first_of(joint); k < first_of(joint) + 3; ++k) {
                    reduced.row(k).setZero();
                    reduced.col(k).setZero();
                    reduced(k, k) = 1;
                    right[k] = motion[k];
                }
        const Vector displaced = reduced.ldlt().solve(right);
        return {static_cast<double>(motion.dot(stiffness * displaced)),
                static_cast<double>(displaced.dot(mass * displaced))};
    }

private:
    struct Element {
        std::size_t from, to;
        double bending, stretching, density; // E I, E A, mass by length
    };
    // In double precision rigid joints would cost ten digits.
    using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
    using OfElement = Eigen::Matrix<long double, 6, 6>;

    /// Place of a joint's displacement in x; those in y and of the angle follow.
    static Eigen::Index first_of(std::size_t joint) { return static_cast<Eigen::Index>(3 * joint); }

    void assemble(const Element& one, Matrix& stiffness, Matrix& mass) const {
        const Eigen::Vector2d d = joints_[one.to] - joints_[one.from];
        const long double l = d.norm(), c = d.x() / l, s = d.y() / l;
        const long double b = one.bending / (l * l * l), a = one.stretching / l, m = one.density * l / 420;
        OfElement local, inert;
        local << a, 0, 0, -a, 0, 0,                                    //
            0, 12 * b, 6 * b * l, 0, -12 * b, 6 * b * l,               //
            0, 6 * b * l, 4 * b * l * l, 0, -6 * b * l, 2 * b * l * l, //
            -a, 0, 0, a, 0, 0,                                         //
            0, -12 * b, -6 * b * l, 0, 12 * b, -6 * b * l,             //
            0, 6 * b * l, 2 * b * l * l, 0, -6 * b * l, 4 * b * l * l;
        inert << 140, 0, 0, 70, 0, 0,                    //
            0, 156, 22 * l, 0, 54, -13 * l,              //
            0, 22 * l, 4 * l * l, 0, 13 * l, -3 * l * l, //
            70, 0, 0, 140, 0, 0,                         //
            0, 54, 13 * l, 0, 156, -22 * l,              //
            0, -13 * l, -3 * l * l, 0, -22 * l, 4 * l * l;
        OfElement turn = OfElement::Identity();
        for (const Eigen::Index k : {0, 3})
            turn.block<2, 2>(k, k) << c, s, -s, c;
        const OfElement stiff = turn.transpose() * local * turn, heavy = m * turn.transpose() * inert * turn;
        const auto joint = [&](Eigen::Index i) { return first_of(i == 0 ? one.from : one.to); };
        for (const Eigen::Index i : {0, 1})
            for (const Eigen::Index j : {0, 1}) {
                stiffness.block<3, 3>(joint(i), joint(j)) += stiff.block<3, 3>(3 * i, 3 * j);
                mass.block<3, 3>(joint(i), joint(j)) += heavy.block<3, 3>(3 * i, 3 * j);
            }
    }

    std::vector<Eigen::Vector2d> joints_;
    std::vector<Element> elements_;
};

} // namespace graze
