#include "settle.hpp"

#include "graze/model/catalogue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace graze::attractor_evidence_test {

/// Returns the contacts of a motion in each of several periods.
std::vector<std::size_t> contacts_of(const Model& model, const std::vector<double>& state, std::size_t periods,
                                     std::vector<double>* end = nullptr) {
    TransientOptions options;
    options.section = model.sections.front().name;
    options.periods = periods;
    Sampling contacts, returns;
    contacts.at = Sampling::At::contact;
    for (std::size_t event = 0; event < model.events.size(); ++event)
        contacts.events.push_back(event);
    returns.section = options.section;
    const PointResult result = result_of(
        *transient_searches(System(model), options, {contacts, returns}, model.state_symbols(), {}), model, state);
    std::vector<std::size_t> counts(1);
    for (const std::size_t sampling : result.samples.samplings)
        if (sampling == 0)
            ++counts.back();
        else
            counts.push_back(0);
    if (end)
        *end = result.state;
    return counts;
}

TEST(AttractorEvidence, AMotionThatPassesByAnOrbitIsNotLabelledPeriodic) {
    // At 7 Hz, below the voltage at which impacts set in, a stable orbit without impacts lies beside a chaotic motion,
    // so close that the motion passes by every few periods.
    Model model = testing::shipped_with("electromagnetic-testbed", {{"f", 7}, {"V0", 3.68}});
    const AttractorOptions options{.section = "phase0", .chaos_cycles = 0};
    std::vector<double> state = model.initial_state();
    contacts_of(model, state, 637, &state);
    for (const double voltage : {3.675, 3.674}) {
        model.set_parameter("V0", voltage);
        const PointResult result = settle(model, options, state);
        EXPECT_EQ(result.label, Label::chaotic) << voltage;
        // A simulation of the same motion continues to have contacts.
        const std::vector<std::size_t> contacts = contacts_of(model, state, 600);
        EXPECT_GT(std::count_if(contacts.end() - 100, contacts.end(), [](std::size_t n) { return n > 0; }), 10);
        state = result.state;
    }
}

TEST(AttractorEvidence, PeriodicLabelsHoldForThousandsOfPeriods) {
    // Impact oscillators close to the onset of contacts, with little damping: a motion labelled periodic must repeat
    // its contacts.
    Model model = load_model("impact-oscillator");
    std::size_t periodic = 0;
    for (int k = 0; k < 24; ++k) {
        const double omega = 1.7 + 0.061 * k, zeta = 0.01 + 0.004 * (k % 5);
        model.set_parameter("zeta", zeta);
        model.set_parameter("omega", omega);
        model.set_parameter("e", 0.6 + 0.05 * (k % 6));
        model.set_parameter("sigma", 1.001 / std::abs(1 - omega * omega)); // above the free motion's amplitude
        const AttractorOptions options{.section = "phase0"};
        const PointResult result = settle(model, options);
        if (result.label != Label::periodic)
            continue;
        ++periodic;
        std::vector<std::size_t> contacts = contacts_of(model, result.state, 2000);
        contacts.pop_back(); // the last period is incomplete
        for (std::size_t c = result.period; c < contacts.size(); ++c)
            ASSERT_EQ(contacts[c], contacts[c - result.period]) << omega << " " << c;
    }
    EXPECT_GE(periodic, 6u);
}

/// A tent map that motions leave at the rate log(slope / 2).
Model leaky_tent(double slope, double start) {
    return in_two_pieces(fmt::format("{}*z", slope), fmt::format("{}*(1 - z)", slope), 0.5, start);
}

TEST(AttractorEvidence, TransientChaosIsDistinguished) {
    const double slope = 2.002, rate = std::log(slope / 2);
    AttractorOptions options;
    options.bounds = {{0, 0, 1}};
    std::size_t begun = 0, chaotic = 0;
    for (int k = 0; k < 60; ++k) {
        const double start = std::fmod(0.137 + k * 0.6180339887498949, 1);
        options.stay_in_transients = false;
        const PointResult left = settle(leaky_tent(slope, start), options);
        options.stay_in_transients = true;
        const PointResult stayed = settle(leaky_tent(slope, start), options);
        EXPECT_TRUE(left.label == Label::escaped || left.label == Label::chaotic) << start;
        EXPECT_EQ(left.cycles, stayed.cycles);
        if (left.cycles < options.cycles)
            continue;
        ++begun;
        chaotic += left.label == Label::chaotic ? 1 : 0;
        EXPECT_EQ(stayed.label, left.label == Label::chaotic ? Label::chaotic : Label::transient);
        // The samples that are kept are chaotic and lie within the tent.
        EXPECT_EQ(stayed.samples.size(), options.keep);
        EXPECT_GT(stayed.state[0], 0);
        EXPECT_LT(stayed.state[0], 1);
        ASSERT_TRUE(stayed.lyapunov);
        EXPECT_NEAR(*stayed.lyapunov, std::log(slope), 2 * *stayed.lyapunov_error + 1e-6);
    }
    // A share exp(-rate returns) of the motions must remain after the first cycles, to within three standard errors.
    const double share = std::exp(-rate * static_cast<double>(options.chaos_cycles));
    const auto all = static_cast<double>(begun);
    EXPECT_NEAR(static_cast<double>(chaotic), share * all, 3 * std::sqrt(all * share * (1 - share)));
}

/// A spiral map with this multiplier, with a contact in every return.
Model spiral(double radius) {
    return iterated("z = 1\nw = 0", "z = 0, w = 0",
                    fmt::format("z = '{0}*(z*cos(2.4) - w*sin(2.4))'\nw = '{0}*(z*sin(2.4) + w*cos(2.4))'", radius));
}

TEST(AttractorEvidence, AMotionThatShrinksAsAWholeStaysWithItsOrbit) {
    // Extents of the returns shrink with the deviation, which must not be measured by them.
    for (const double radius : {0.9, 0.98, 0.99}) {
        const PointResult result = settle(spiral(radius));
        EXPECT_EQ(result.label, Label::periodic) << radius << name_of(result.label);
        ASSERT_FALSE(result.multipliers.empty());
        EXPECT_NEAR(std::abs(result.multipliers.front()), radius, 1e-9);
    }
    EXPECT_EQ(settle(spiral(1)).label, Label::quasi_periodic);
    EXPECT_NE(settle(spiral(1.001)).label, Label::periodic);
    EXPECT_EQ(settle(spiral(1.5)).label, Label::unbounded);
}

/// x' = -x falls to `least` after -log(least), where the motion ends; before, only the clock moves noticeably.
TEST(AttractorEvidence, AMotionThatSeemsAtRestStillReachesItsEvent) {
    for (const double least : {1e-3, 1e-12, 1e-20, 1e-60, 1e-100, 1e-160}) {
        const PointResult result = settle(
            testing::OneMode{.states = "x = 1",
                             .rates = "x = '-x'",
                             .clock = "1",
                             .period = "1",
                             .stops = {{.event = "low", .function = fmt::format("x - {:.17g}", least), .next = "end"}},
                             .more = testing::at_phase(0.5)}
                .model());
        EXPECT_EQ(result.label, Label::ended) << least << ": " << name_of(result.label) << result.outcome.detail;
        EXPECT_NEAR(result.time / -std::log(least), 1, 1e-9) << least;
    }
}

/// The section's function is exp(-t), which finally underflows.
TEST(AttractorEvidence, RoundOffOfADecayedFunctionIsNoReturn) {
    for (const char* rate : {"1", "0.1*x", "v"}) {
        const PointResult result = settle(testing::OneMode{.states = "x = 0.5\nv = 1",
                                                           .rates = fmt::format("x = '{}', v = '-v'", rate),
                                                           .more = "[sections.s]\nfunction = 'v'"}
                                              .model());
        EXPECT_EQ(result.cycles, 0U) << rate;
        EXPECT_NE(result.label, Label::periodic) << rate;
        EXPECT_NE(result.label, Label::chaotic) << rate;
    }
}

/// A ball on a table that comes to rest there, and is released where the table's downward acceleration exceeds gravity
/// (g = 1): its earlier motion is forgotten each time.
Model ball_at_rest(double restitution, double omega, double amplitude) {
    Model model = testing::shipped_with(
        "bouncing-ball", {{"g", 1}, {"e", restitution}, {"f", omega / (2 * std::numbers::pi)}, {"a", amplitude}});
    model.set_initial("x", 0);
    model.set_initial("v", amplitude * omega);
    model.set_initial_mode("rest");
    return model;
}

TEST(AttractorEvidence, RepeatedMergingOfNeighboursIsNotChaotic) {
    // Neighbours separate between one rest and the next, which are tens to hundreds of returns apart.
    for (const double amplitude : {0.754, 0.7874, 0.97, 0.998}) {
        const PointResult result = settle(ball_at_rest(0.8, 1.5, amplitude));
        EXPECT_NE(result.label, Label::chaotic) << amplitude;
        EXPECT_FALSE(result.lyapunov) << amplitude << ": the derivative is zero";
        EXPECT_TRUE(result.label == Label::periodic || result.outcome.detail != "") << amplitude;
    }
}

TEST(AttractorEvidence, LongPeriodsBetweenTwoRestsAreFound) {
    // Periods are counted along long simulations, from one release to the next.
    const std::vector<std::pair<double, std::size_t>> cases{{1.12, 25}, {1.08, 26}, {1.0, 30}, {0.96, 33}, {0.84, 43}};
    for (const auto& [amplitude, period] : cases) {
        Model model = ball_at_rest(0.5, 2, amplitude);
        const PointResult result = settle(model);
        EXPECT_EQ(result.label, Label::periodic) << amplitude << name_of(result.label) << result.outcome.detail;
        EXPECT_EQ(result.period, period) << amplitude;
        ASSERT_FALSE(result.multipliers.empty());
        EXPECT_LT(std::abs(result.multipliers.front()), 1e-9);
        model.initial_mode = result.mode;
        const std::vector<std::size_t> contacts = contacts_of(model, result.state, 4 * period + 1);
        for (std::size_t c = period; c < 4 * period; ++c)
            ASSERT_EQ(contacts[c], contacts[c - period]) << amplitude << " " << c;
    }
}

} // namespace graze::attractor_evidence_test
