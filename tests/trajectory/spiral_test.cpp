// Spirals of infinitely many crossings into the place where two surfaces of slides meet, against closed forms.

#include "closed_form.hpp"
#include "model_parts.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

using namespace graze;
using namespace graze::testing;

namespace spiral_test {

/// Relays u = sign(x - place), v = sign(y - place): x' = -a u + b v, y' = -b u - a v with 0 < a < b, in units of
/// `length` and `time`, and z' = 1 + c u.
struct Spiral {
    double a = 1, b = 2, c = 3, length = 1, time = 1, place = 0;

    std::string model() const {
        std::string text =
            fmt::format("name = \"spiral\"\n[states]\nx = {:.17g}\ny = {:.17g}\nz = 0\n[events]\nfront = \"x - "
                        "({:.17g})\"\nside = \"y - ({:.17g})\"\n",
                        place, place + length, place, place);
        const double speed = length / time;
        for (const int u : {1, -1})
            for (const int v : {1, -1})
                text += fmt::format("[modes.{}{}]\nrates = {{ x = {:.17g}, y = {:.17g}, z = {:.17g} }}\n",
                                    u > 0 ? 'p' : 'm', v > 0 ? 'p' : 'm', speed * (-a * u + b * v),
                                    speed * (-b * u - a * v), 1 + c * u);
        return text + slides_between_quadrants();
    }
    /// From (0, 1) each quarter of a turn takes the distance from the corner, divided by a + b, and multiplies it by
    /// (b - a)/(b + a).
    double end() const { return time / (a + b) / (1 - (b - a) / (b + a)); }
    /// z there: u = 1 in the first and second quarter of each turn, then -1.
    double z() const {
        const double q = (b - a) / (b + a);
        return end() + c * time / (a + b) * (1 + q - q * q - q * q * q) / (1 - std::pow(q, 4));
    }
};

TEST(Spiral, EndsAtTheCornerAtTheClosedFormTime) {
    for (const double b : {1.001, 1.1, 2.0, 5.0, 30.0, 1000.0})
        for (const double unit : {1e-9, 1.0, 1e6})
            for (const double tolerance : {1e-8, 1e-12, 1e-15}) {
                SCOPED_TRACE(fmt::format("b = {}, unit {}, tolerance {}", b, unit, tolerance));
                const Spiral spiral{.b = b, .length = unit, .time = std::sqrt(unit)};
                Experiment experiment(model_from(spiral.model()), with_tolerance(tolerance));
                const Outcome& outcome = experiment.run(2 * spiral.end());
                ASSERT_EQ(outcome.ending, Ending::end_time) << outcome.detail;
                const auto& contacts = experiment.recorder.contacts();
                ASSERT_FALSE(contacts.empty());
                const Contact& last = contacts.back().contact;
                EXPECT_EQ(last.kind, ContactKind::sticking);
                EXPECT_NEAR(last.time, spiral.end(), 1e-12 * spiral.end());
                EXPECT_EQ(experiment.simulation.model().modes[experiment.trajectory.mode()].name, "upper-right");
                EXPECT_EQ(experiment.state()[0], 0);
                EXPECT_EQ(experiment.state()[1], 0);
                // Both relays are 0 at the corner, so that z' = 1 there.
                EXPECT_NEAR(experiment.state()[2], spiral.z() + spiral.end(), 1e-10 * spiral.end());
            }
}

/// Where the corner is not at zero, its surfaces are known to round-off of the states.
TEST(Spiral, EndsAtACornerBesideZero) {
    for (const double place : {1.0, -3.0, 1e3}) {
        const Spiral spiral{.place = place};
        Experiment experiment(model_from(spiral.model()));
        const Outcome& outcome = experiment.run(1);
        ASSERT_EQ(outcome.ending, Ending::end_time) << outcome.detail;
        EXPECT_NEAR(experiment.recorder.contacts().back().contact.time, spiral.end(), 1e-13 * std::abs(place) + 1e-13);
        EXPECT_EQ(experiment.state()[0], place);
        EXPECT_EQ(experiment.state()[1], place);
    }
}

/// A spiral whose turns hardly become shorter, or become longer, goes on round the corner.
TEST(Spiral, OfConstantTurnsGoesOn) {
    for (const double a : {1e-9, -1e-9}) {
        const Spiral spiral{.a = a, .b = 1};
        Experiment experiment(model_from(spiral.model()));
        EXPECT_EQ(experiment.run(400.5).ending, Ending::end_time);
        EXPECT_EQ(experiment.recorder.contacts().size(), 400U);
        EXPECT_NEAR(std::abs(experiment.state()[0]) + std::abs(experiment.state()[1]), 1, 2e-6);
    }
}

} // namespace spiral_test
