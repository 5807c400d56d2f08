// A block that rocks from edge to edge until it rests: contacts at two alternating events accumulate.

#include "closed_form.hpp"
#include "simulate.hpp"

#include <gtest/gtest.h>

using namespace graze;
using namespace graze::testing;

namespace rocking_block_test {

const char* const block = R"toml(
parameters = { r = 0.35, p = 1, a = 1 }
states = { q = 0.9, w = 0 }
events = { dn = "q", up = "-q" }
modes.pl = { rates = { q = "w", w = "p^2*(q - a)" }, watch = ["dn"] }
modes.mi = { rates = { q = "w", w = "p^2*(q + a)" }, watch = ["up"] }
modes.rest = { rates = { q = 0, w = 0 } }
initial.mode = "pl"
jumps.i.w = "r*w"
jumps.l = { q = 0, w = 0 }
transitions = [
  { mode = "pl", event = "dn", jump = "i", next = "mi", chatter = { jump = "l", mode = "rest" } },
  { mode = "mi", event = "up", jump = "i", next = "pl", chatter = { jump = "l", mode = "rest" } },
]
)toml";

/// Returns the time of rest: from the tilt a c, reached with the speed p a s, s^2 = 1 - (1 - c)^2, the block falls
/// within acosh(1/(1 - c))/p; each rise takes as long as the fall after it (Housner 1963).
double time_of_rest(double tilt, double r, double p) {
    double time = std::acosh(1 / (1 - tilt)) / p;
    for (double speed = r * std::sqrt(1 - (1 - tilt) * (1 - tilt)); speed > 1e-20; speed *= r)
        time += 2 * std::atanh(speed) / p;
    return time;
}

TEST(RockingBlock, ComesToRestInAnyUnits) {
    Random random(81);
    Model model = model_from(block);
    for (int i = 0; i < 2000; ++i) {
        const double r = random.uniform(0.05, 0.9), p = random.log_uniform(1e-6, 1e6),
                     a = random.log_uniform(1e-9, 1e9), tilt = random.uniform(0.1, 0.99);
        model.set_parameter("r", r);
        model.set_parameter("p", p);
        model.set_parameter("a", a);
        Experiment experiment(model, with_tolerance(random.log_uniform(1e-15, 1e-8)));
        const double rest = time_of_rest(tilt, r, p);
        const Outcome outcome = experiment.run_from({tilt * a, 0}, 0, 2 * rest);
        ASSERT_EQ(outcome.ending, Ending::end_time)
            << fmt::format("{} {} {} {} {}: {}", r, p, a, tilt, experiment.trajectory.time(), outcome.detail);
        EXPECT_EQ(experiment.trajectory.mode(), 2U);
        const auto& contacts = experiment.recorder.contacts();
        ASSERT_FALSE(contacts.empty());
        EXPECT_EQ(contacts.back().contact.kind, ContactKind::sticking);
        EXPECT_NEAR(contacts.back().contact.time, rest, 1e-6 * rest) << fmt::format("{} {} {} {}", r, p, a, tilt);
    }
}

} // namespace rocking_block_test
