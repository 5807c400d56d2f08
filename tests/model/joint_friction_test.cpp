// Limits of forces that contacts share, against the corners of the set of forces that hold.

#include "model/joint_friction.hpp"

#include "graze/model/model.hpp"
#include "graze/symbolic/expression.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

using namespace graze;

namespace joint_friction_test {

/// fixed + by * chosen >= 0
struct Row {
    double fixed = 0;
    std::array<double, 2> by{};
    double at(const std::array<double, 2>& chosen) const { return fixed + by[0] * chosen[0] + by[1] * chosen[1]; }
};

/// The set is not empty if one of its corners is in it: it contains no straight line.
double most_of_corners(const std::vector<Row>& rows, std::size_t chosen) {
    double most = -1e300;
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t j = chosen == 1 ? i : 0; j < (chosen == 1 ? i + 1 : i); ++j) {
            std::array<double, 2> corner{-rows[i].fixed / rows[i].by[0], 0};
            if (chosen == 2) {
                const double d = rows[i].by[0] * rows[j].by[1] - rows[i].by[1] * rows[j].by[0];
                if (std::abs(d) < 1e-12)
                    continue; // parallel
                corner = {(-rows[i].fixed * rows[j].by[1] + rows[j].fixed * rows[i].by[1]) / d,
                          (-rows[j].fixed * rows[i].by[0] + rows[i].fixed * rows[j].by[0]) / d};
            }
            double least = 1e300;
            for (std::size_t k = 0; k < rows.size(); ++k)
                if (k != i && k != j)
                    least = std::min(least, rows[k].at(corner));
            most = std::max(most, least);
        }
    return most;
}

TEST(JointFriction, HoldsWhereForcesWithinAllConesExist) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    std::size_t holding = 0, giving_way = 0;
    for (int number = 0; number < 4000; ++number) {
        Model model;
        const std::size_t chosen = 1 + static_cast<std::size_t>(number % 2);
        const double coupling = number % 3 == 0 ? 0.0 : number % 3 == 1 ? 0.3 : 3.0;
        std::vector<SharedContact> contacts;
        std::vector<Row> rows;
        for (std::size_t i = 0; i < chosen + 1; ++i) {
            const double mu = 0.1 + std::abs(normal(random)), n = 1 + normal(random), t = normal(random);
            SharedContact one{i, true, model.number(mu), {model.number(n), {}}, {model.number(t), {}}};
            Row forward{mu * n + t}, backward{mu * n - t};
            for (std::size_t k = 0; k < chosen; ++k) {
                const double by_n = coupling * normal(random), by_t = normal(random);
                one.normal.by.push_back(model.number(by_n));
                one.tangential.by.push_back(model.number(by_t));
                forward.by[k] = mu * by_n + by_t;
                backward.by[k] = mu * by_n - by_t;
            }
            contacts.push_back(one);
            rows.insert(rows.end(), {forward, backward});
        }
        const double most = most_of_corners(rows, chosen);
        const std::vector<ContactLimit> limits = joint_limits(StartValues(model), contacts).limits;
        const bool holds =
            std::ranges::all_of(limits, [](const ContactLimit& one) { return one.function.node().value >= 0; });
        if (std::abs(most) < 1e-9 || (coupling == 0 && chosen == 2 && std::abs(most) < 1e-6))
            continue; // round-off
        ++(holds ? holding : giving_way);
        EXPECT_EQ(holds, most > 0) << number << " most " << most;
    }
    EXPECT_GT(std::min(holding, giving_way), 300U);
}

} // namespace joint_friction_test
