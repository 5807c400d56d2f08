#include "identify/fit_start.hpp"

#include "identify/models.hpp"
#include "identify/recorded_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::testing::other_initial_states_test {

/// Time of the first impact: x = -2 exp(-ct/2) (cos wt + c/(2w) sin wt) rises to 0.5, by bisection.
double first_contact() {
    const double c = 0.1, w = std::sqrt(4 - c * c / 4);
    double before = 0, behind = std::acos(-1.0) / w;
    for (int i = 0; i < 60; ++i) {
        const double t = (before + behind) / 2;
        const double x = -2 * std::exp(-c * t / 2) * (std::cos(w * t) + c / (2 * w) * std::sin(w * t));
        (x < 0.5 ? before : behind) = t;
    }
    return before;
}

/// Record of the wall model's displacement alone, from a little before an impact on.
RecordedMotion before_contact(double lead) {
    RecordedMotion motion(wall_model(), {"x"}, first_contact() - lead, 0.02, 300);
    EXPECT_EQ(motion.task.records[0].mode, 0U);
    EXPECT_GT(motion.first[1], 0) << "it still moves towards the wall";
    int turn = 0;
    for (const char* name : {"c", "k", "wall", "e"})
        motion.forget(name, turn++ % 2 == 0 ? 0.95 : 1.05);
    motion.forget_states();
    return motion;
}

/// Only the first few readings, or a single one, precede the impact, and velocity is not read: starting with the
/// velocity after the impact fits all other readings.
TEST(OtherInitialStates, ARecordMayBeginJustBeforeAContact) {
    const double period = std::acos(-1.0);
    for (const double part : {0.001, 0.003, 0.01, 0.02}) {
        SCOPED_TRACE(part);
        RecordedMotion motion = before_contact(part * period);
        const Fit fit = motion.converged();
        EXPECT_LE(motion.error(fit), 1e-9); // only round-off is left
        EXPECT_EQ(fit.records[0].contacts, 3U);
    }
}

} // namespace graze::testing::other_initial_states_test
