#pragma once

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
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
        Rows stiffness(static_cast<std::size_t>(n)), mass = stiffness;
        for (const Element& one : elements_)
            assemble(one, stiffness, mass);
        Vector motion = Vector::Zero(n);
        for (const std::size_t joint : moved)
            motion[first_of(joint)] = 1;
        std::vector<bool> given(static_cast<std::size_t>(n));
        for (const auto& joints : {held, moved})
            for (const std::size_t joint : joints)
                std::fill_n(given.begin() + first_of(joint), 3, true);
        const Vector displaced = solved(stiffness, given, motion);
        return {static_cast<double>(motion.dot(product(stiffness, displaced))),
                static_cast<double>(displaced.dot(product(mass, displaced)))};
    }

private:
    struct Element {
        std::size_t from, to;
        double bending, stretching, density; // E I, E A, mass by length
    };
    // In double precision rigid joints would cost ten digits.
    // Joints have few neighbours, so that rows have few entries, also while unknowns are eliminated.
    using Rows = std::vector<std::map<Eigen::Index, long double>>;
    using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
    using OfElement = Eigen::Matrix<long double, 6, 6>;

    /// Place of a joint's displacement in x; those in y and of the angle follow.
    static Eigen::Index first_of(std::size_t joint) { return static_cast<Eigen::Index>(3 * joint); }

    static Vector product(const Rows& rows, const Vector& factor) {
        Vector result = Vector::Zero(factor.size());
        for (Eigen::Index i = 0; i < factor.size(); ++i)
            for (const auto& [j, value] : rows[static_cast<std::size_t>(i)])
                result[i] += value * factor[j];
        return result;
    }

    /// What the joints do that are not given, without forces on them: eliminated one unknown after another, of those
    /// that are left always one with the fewest neighbours. Stiffness is positive, so that no pivot is small.
    static Vector solved(Rows rows, const std::vector<bool>& given, const Vector& motion) {
        Vector right = Vector::Zero(motion.size()), result = motion;
        std::vector<Eigen::Index> left, order;
        for (Eigen::Index i = 0; i < motion.size(); ++i) {
            if (given[static_cast<std::size_t>(i)])
                continue;
            left.push_back(i);
            std::erase_if(rows[static_cast<std::size_t>(i)], [&](const auto& entry) {
                const bool known = given[static_cast<std::size_t>(entry.first)];
                if (known)
                    right[i] -= entry.second * motion[entry.first];
                return known;
            });
        }
        const auto row_of = [&](Eigen::Index i) -> std::map<Eigen::Index, long double>& {
            return rows[static_cast<std::size_t>(i)];
        };
        while (!left.empty()) {
            const auto next = std::min_element(left.begin(), left.end(), [&](auto one, auto other) {
                return row_of(one).size() < row_of(other).size();
            });
            const Eigen::Index i = *next;
            *next = left.back();
            left.pop_back();
            order.push_back(i);
            const auto pivot = row_of(i);
            for (const auto& [j, value] : pivot) {
                if (j == i)
                    continue;
                const long double factor = value / pivot.at(i);
                for (const auto& [k, other] : pivot)
                    row_of(j)[k] -= factor * other;
                row_of(j).erase(i);
                right[j] -= factor * right[i];
            }
        }
        for (auto i = order.rbegin(); i != order.rend(); ++i) {
            long double force = right[*i];
            for (const auto& [j, value] : row_of(*i))
                if (j != *i)
                    force -= value * result[j];
            result[*i] = force / row_of(*i).at(*i);
        }
        return result;
    }

    void assemble(const Element& one, Rows& stiffness, Rows& mass) const {
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
        for (Eigen::Index i = 0; i < 6; ++i)
            for (Eigen::Index j = 0; j < 6; ++j) {
                const auto row = static_cast<std::size_t>(joint(i / 3) + i % 3);
                const Eigen::Index column = joint(j / 3) + j % 3;
                stiffness[row][column] += stiff(i, j);
                mass[row][column] += heavy(i, j);
            }
    }

    std::vector<Eigen::Vector2d> joints_;
    std::vector<Element> elements_;
};

} // namespace graze
