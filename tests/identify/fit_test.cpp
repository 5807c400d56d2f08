#include "graze/identify/fit.hpp"

#include "base/message_of.hpp"
#include "identify/models.hpp"
#include "identify/recorded_motion.hpp"

#include <gmock/gmock.h>

#include <array>

namespace graze::testing::fit_test {

/// Motions are accurate to some 1e-13; numbers fitted to them must have nine correct digits.
constexpr double nine_digits = 1e-9;

void expect_found(const RecordedMotion& motion, const FitSettings& settings = {}) {
    const Fit fit = motion.converged(settings);
    EXPECT_LE(motion.error(fit), nine_digits);
}

/// Replaces the readings by the squares of a displacement.
void read_squares(RecordedMotion& motion) {
    motion.task.outputs[0].value = pow(motion.task.outputs[0].value, 2);
    for (double& value : motion.task.records[0].readings[0].values)
        value *= value;
    motion.task.records[0].start = motion.first;
}

TEST(Fit, FindsTheParametersOfAnImpactOscillator) {
    RecordedMotion motion(load_model("impact-oscillator"), {"x", "v"}, 0, 0.05, 600);
    motion.forget_all({"zeta", "omega", "amplitude", "sigma", "e"}, 1.1);
    expect_found(motion);
}

TEST(Fit, FindsTheParametersOfTheBallAndShaker) {
    RecordedMotion motion(load_model("ball-and-shaker"), {"q"}, 0.4, 0.005, 400);
    motion.forget_all({"zeta", "omega_n", "e", "a", "f"}, 1.03);
    expect_found(motion);
}

TEST(Fit, FindsTheParametersOfABouncingBall) {
    RecordedMotion motion(load_model("bouncing-ball"), {"x"}, 0, 0.002, 400);
    motion.forget_all({"g", "e", "a", "f"}, 1.03);
    expect_found(motion);
}

TEST(Fit, FindsTheParametersOfADryFrictionOscillator) {
    RecordedMotion motion(load_model("dry-friction-oscillator"), {"x", "v"}, 0, 0.1, 500);
    for (const char* name : {"zeta", "omega", "amplitude", "friction_static", "friction_dynamic"})
        motion.forget(name, 1.05);
    motion.task.records[0].unknown_states = {0, 2}; // v is known: the motion starts at rest
    expect_found(motion);
}

TEST(FitSlow, FindsTheParametersOfTheTestbedThroughChaos) {
    Model model = load_model("electromagnetic-testbed");
    RecordedMotion motion(model, {"q", "v", "I"}, 4, 0.002, 1500);
    motion.forget_all({"V0", "zeta", "e", "beta1", "R", "w0"}, 1.05);
    expect_found(motion);
}

/// Records with different amplitudes, each known, and an unknown gain and offset.
TEST(Fit, FindsGainsAndOffsetsFromSeveralRecords) {
    Model model = load_model("impact-oscillator");
    RecordedMotion motion(model, {"x", "v"}, 0, 0.05, 300);
    motion.model.set_parameter("amplitude", 1.3);
    motion.add_record({"v", "x"}, 1, 0.04, 400);
    const ParameterId amplitude = model.independent_parameter("amplitude");
    motion.task.records[0].known.emplace_back(amplitude, 1.0);
    motion.task.records[1].known.emplace_back(amplitude, 1.3);
    for (FitRecord& record : motion.task.records)
        for (FitRecord::Readings& readings : record.readings)
            for (double& value : readings.values)
                value = readings.output == 0 ? 2.5e-6 * value + 3e-7 : value;
    motion.task.outputs[0].gain = 2.3e-6;
    motion.task.outputs[0].offset = 2e-7;
    motion.task.outputs[0].gain_unknown = motion.task.outputs[0].offset_unknown = true;
    motion.forget_all({"zeta", "omega", "sigma", "e"}, 1.05);
    const Fit fit = motion.converged();
    EXPECT_LE(motion.error(fit), nine_digits);
    ASSERT_EQ(fit.numbers.size(), 12U);
    EXPECT_EQ(fit.numbers[4].name, "gain of x");
    EXPECT_NEAR(fit.numbers[4].estimate.value, 2.5e-6, 2.5e-6 * nine_digits);
    EXPECT_NEAR(fit.numbers[5].estimate.value, 3e-7, 3e-7 * nine_digits);
    EXPECT_EQ(fit.numbers[11].name, "theta(0) of record 2");
}

/// x'' = -k/m x: only the ratio of k and m is determined.
TEST(Fit, NamesUndeterminedCombinations) {
    RecordedMotion motion(smooth_model("{ m = 2, k = 8 }", "{ x = 1, v = 0 }", R"({ x = "v", v = "-k/m*x" })"), {"x"},
                          0, 0.1, 50);
    motion.forget("m", 1.1);
    motion.forget("k", 1.05);
    motion.task.records[0].unknown_states = {0};
    const Fit fit = motion.fit();
    EXPECT_EQ(name_of(fit.ending), "undetermined");
    ASSERT_EQ(fit.free.size(), 1U);
    EXPECT_LT(fit.free[0].strength, 1e-9);
    ASSERT_EQ(fit.free[0].parts.size(), 2U);
    EXPECT_NEAR(fit.free[0].parts[0].change / fit.free[0].parts[1].change, 1, 1e-6);
    EXPECT_THAT(fit.detail, ::testing::HasSubstr("m (+1 %)"));
    EXPECT_THAT(fit.detail, ::testing::HasSubstr("k (+1 %)"));
    EXPECT_EQ(fit.numbers[0].estimate.freedom, 0);
    EXPECT_NEAR(fit.numbers[1].estimate.value / fit.numbers[0].estimate.value, 4, 4 * nine_digits);
    EXPECT_GT(fit.numbers[2].estimate.freedom, 0) << "the amplitude is still determined";
}

TEST(Fit, CanBeInterruptedInTheMiddleOfAMotion) {
    RecordedMotion motion(smooth_model("{ tau = 10 }", "{ T = 1 }", R"({ T = "-T/tau" })"), {"T"}, 0, 0.1, 50);
    motion.forget("tau", 1e-8); // so stiff that the first motion alone would take minutes
    FitSettings settings;
    int asked = 0;
    settings.interrupted = [&] { return ++asked > 1000; };
    const Fit fit = motion.fit(settings);
    EXPECT_EQ(name_of(fit.ending), "interrupted");
    EXPECT_EQ(asked, 1001) << "no motion begins any more";
    EXPECT_THAT(fit.detail,
                ::testing::HasSubstr("a record lasts 4.9 of the model's time; look at the unit of its times"));
}

/// No parameters fit a channel with the wrong sign or unit: the fit ends soon, and names the channel.
TEST(Fit, NamesTheChannelThatDoesNotMatch) {
    for (const double factor : {-1.0, 57.29577951308232}) {
        RecordedMotion motion(wall_model(), {"x", "v"}, 0.013, 0.05, 200);
        for (double& value : motion.task.records[0].readings[1].values)
            value *= factor;
        motion.add_noise(0.005, 3);
        motion.forget_all({"c", "k", "wall", "e"}, 1.02);
        FitSettings settings;
        int asked = 0;
        settings.interrupted = [&] {
            ++asked;
            return false;
        };
        const Fit fit = motion.fit(settings);
        EXPECT_NE(name_of(fit.ending), "converged") << factor;
        EXPECT_THAT(fit.detail, ::testing::HasSubstr("does not match from time")) << factor;
        EXPECT_THAT(fit.detail, ::testing::HasSubstr("look at its sign, its unit")) << factor;
        // Interrupted early it says the same, as soon as all pieces have been evaluated.
        int until = asked / 2;
        settings.interrupted = [&] { return --until < 0; };
        const Fit ended = motion.fit(settings);
        EXPECT_EQ(name_of(ended.ending), "interrupted");
        EXPECT_THAT(ended.detail, ::testing::HasSubstr("before it had converged"));
    }
}

/// The same motion in units from nano to mega.
TEST(Fit, UnitsMakeNoDifference) {
    const auto swing = [](double length, double time) {
        Model model = wall_model();
        model.set_parameter("c", 0.2 / time);
        model.set_parameter("k", 4 / (time * time));
        model.set_parameter("wall", 0.5 * length);
        RecordedMotion motion(model, {"x"}, 0.01 * time, 0.02 * time, 300);
        motion.forget_all({"c", "k", "wall", "e"}, 1.1);
        motion.add_noise(1e-3, 7);
        return std::pair(motion, motion.fit());
    };
    const auto [motion, usual] = swing(1, 1);
    EXPECT_EQ(name_of(usual.ending), "converged") << usual.detail;
    EXPECT_GT(usual.records[0].contacts, 1U);
    for (const auto& [length, time] : {std::pair(1e-9, 1e6), std::pair(1e6, 1e-9)}) {
        const Fit other = swing(length, time).second;
        EXPECT_EQ(name_of(other.ending), "converged") << other.detail;
        const std::array<double, 6> units{1 / time, 1 / (time * time), length, 1, length, length / time};
        for (std::size_t j = 0; j < units.size(); ++j) {
            // Each fit is stationary to at most a hundredth of the error.
            const double error = usual.numbers[j].estimate.error;
            EXPECT_NEAR(other.numbers[j].estimate.value / units[j], usual.numbers[j].estimate.value, 0.02 * error);
            EXPECT_NEAR(other.numbers[j].estimate.error / units[j], error, 1e-3 * error);
        }
    }
}

/// The period of a cyclic state depends on an unknown parameter.
TEST(Fit, FindsAPeriod) {
    const Model model =
        smooth_model("{ w = 3, c = 0.2 }", R"({ x = -0.3, v = 0, tau = { initial = 0.4, period = "2*pi/w" } })",
                     R"({ x = "v", v = "cos(w*tau) - 4*x - c*v", tau = 1 })");
    RecordedMotion motion(model, {"x"}, 0.3, 0.1, 300);
    motion.forget_all({"w", "c"}, 1.05);
    expect_found(motion);
}

/// The ball rests for more than half of the record, with readings on both sides of the floor.
TEST(Fit, ConvergesOnARecordWithRestAfterChatter) {
    for (const std::uint64_t seed : {1, 2, 3}) {
        RecordedMotion motion(dropped_ball(), {"x"}, 0, 0.01, 400);
        ASSERT_GT(motion.contacts, 10U);
        motion.forget("g", 0.97);
        motion.forget_all({"e"}, 0.95);
        motion.add_noise(0.02, seed);
        const Fit fit = motion.converged();
        motion.expect_within_errors(fit); // by chance once in 3000 fits
    }
}

TEST(Fit, SaysThatTheModelDoesNotDefineWhatFollowsChatter) {
    RecordedMotion motion(dropped_ball(), {"x"}, 0, 0.02, 200);
    motion.model = dropped_ball("");
    motion.forget("e", 1.01);
    const Fit fit = motion.fit();
    EXPECT_EQ(name_of(fit.ending), "broken");
    EXPECT_THAT(fit.detail, ::testing::HasSubstr("give it `chatter = { jump = ..., mode = ... }` in the model"));
    EXPECT_THAT(fit.detail, ::testing::Not(::testing::HasSubstr("guesses")));
}

/// An output that is always 0, and one whose gain is only known in product with its initial state.
TEST(Fit, NamesUndeterminedGains) {
    const Model model = smooth_model("{ k = 2 }", "{ x = 1, z = 0 }", R"({ x = "-k*x", z = "-z" })");
    for (const bool noise : {false, true}) {
        RecordedMotion motion(model, {"x", "z"}, 0, 0.05, 60);
        motion.forget("k", 1.1);
        motion.task.outputs[0].gain_unknown = motion.task.outputs[1].gain_unknown = true;
        motion.task.records[0].unknown_states = {0};
        if (noise)
            motion.add_noise(0.01, 5);
        const Fit fit = motion.fit();
        EXPECT_EQ(name_of(fit.ending), "undetermined") << fit.detail;
        ASSERT_EQ(fit.free.size(), 2U);
        EXPECT_THAT(fit.free[0].text + fit.free[1].text, ::testing::HasSubstr("gain of z"));
        EXPECT_THAT(fit.free[0].text + fit.free[1].text, ::testing::HasSubstr("gain of x"));
        EXPECT_THAT(fit.free[0].text + fit.free[1].text, ::testing::HasSubstr("x(0)"));
    }
}

TEST(Fit, NamesAReadingThatIsOutOfAllProportion) {
    RecordedMotion motion(dropped_ball(), {"x", "v"}, 0, 0.02, 50);
    motion.forget("g", 1.1);
    motion.task.records[0].readings[1].values[7] = -1e308;
    EXPECT_THAT(message_of([&] { motion.fit(); }),
                ::testing::HasSubstr("the reading -1e+308 of 'v' at time 0.14 is out of"));
}

/// Equal readings, as from a stuck converter, do not show their noise.
TEST(Fit, AConstantChannelHasAnIntervalAboveZero) {
    RecordedMotion motion(smooth_model("{ c = 5 }", "{ x = 1 }", "{ x = 0 }"), {"x"}, 0, 0.1, 30);
    motion.task.outputs[0].offset_unknown = true;
    const Fit fit = motion.fit();
    EXPECT_TRUE(fit.outputs[0].unchanging);
    EXPECT_GT(fit.numbers[0].estimate.half_width(), 0);
}

/// Squares of a displacement do not show the side: the mirror image is reported as alternative, found by the signs of
/// all states, or by a symmetry of the model, through impacts.
TEST(Fit, ReportsMirrorImagesAsAlternatives) {
    RecordedMotion ball(dropped_ball(), {"v"}, 0, 0.01, 40);
    ball.forget("g", 1.02);
    ball.task.records[0].unknown_states = {1};
    EXPECT_TRUE(ball.fit().alternatives.empty());

    RecordedMotion swing(smooth_model("{ k = 4 }", "{ x = 1, v = 0.5 }", R"({ x = "v", v = "-k*x" })"), {"x"}, 0, 0.05,
                         100);
    read_squares(swing);
    swing.forget("k", 1.02);
    swing.forget_states();
    const Fit fit = swing.converged();
    ASSERT_EQ(fit.alternatives.size(), 1U);
    EXPECT_EQ(fit.alternatives[0].text, "x(0) = -1, v(0) = -0.5");
    ASSERT_EQ(fit.alternatives[0].numbers.size(), 2U);
    EXPECT_NEAR(fit.alternatives[0].numbers[0].second, -1, nine_digits);

    RecordedMotion stops(load_model("impact-oscillator-two-stops"), {"x"}, 0, 0.05, 200);
    ASSERT_GT(stops.contacts, 2U);
    read_squares(stops);
    stops.forget("e", 1.02);
    stops.forget_states();
    const Fit other = stops.converged();
    ASSERT_GE(other.alternatives.size(), 1U);
    for (const char* state : {"x(0) = ", "v(0) = ", "theta(0) = "})
        EXPECT_THAT(other.alternatives[0].text, ::testing::HasSubstr(state));
}

/// A fit that converges to a negative amplitude with a phase half a period later is moved to the sign of the guess.
TEST(Fit, SignsAreThoseOfGuesses) {
    RecordedMotion motion(load_model("ball-and-shaker"), {"q"}, 0.621, 0.005, 400);
    motion.forget_all({"zeta", "omega_n", "e", "a", "f"}, 1.05);
    motion.add_noise(0.005, 17);
    const Fit fit = motion.converged();
    EXPECT_TRUE(fit.alternatives.empty());
    motion.expect_within_errors(fit);
}

} // namespace graze::testing::fit_test
