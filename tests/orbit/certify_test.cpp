// What a certificate says of the events of an orbit.

#include "orbits.hpp"
#include "trajectory/model_parts.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace graze::certify_test {

using namespace graze::testing;

/// A ball that bounces on a table, below a ceiling. Of several transitions for one event any may be the one that is
/// made: the function of its event is zero at the end, which says nothing of a second event.
TEST(Certify, TheEventThatEndsASegmentIsNoSecondOne) {
    for (const auto& [made, condition] : {std::pair("first", "v < 0"), std::pair("second", "v > 0")}) {
        const Model model = model_from(fmt::format(R"toml(
states = {{ x = 0, v = 0.5, theta = {{ initial = 0, period = 1 }} }}
events = {{ floor = "x", ceiling = "2 - x" }}
jumps.bounce.v = "0.4 - 0.2*v"
initial.mode = "flight"
modes.flight = {{ rates = {{ x = "v", v = -1, theta = 1 }}, watch = ["ceiling", "floor"] }}
transitions = [
    {{ mode = "flight", event = "floor", when = "{}", label = "first", jump = "bounce", next = "flight" }},
    {{ mode = "flight", event = "floor", label = "second", jump = "bounce", next = "flight" }},
    {{ mode = "flight", event = "ceiling", next = "end" }},
]
)toml",
                                                   condition));
        const OrbitSolution solution = solve_orbit(System(model), given_orbit(model, made, {{0, 0.5, 0}}, {1}));
        ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
        EXPECT_TRUE(solution.certificate.admissible) << solution.certificate.reason;
        ASSERT_EQ(solution.certificate.end_values.size(), 1U) << made;
        EXPECT_EQ(model.events[solution.certificate.end_values[0].event].name, "ceiling");
    }
}

} // namespace graze::certify_test
