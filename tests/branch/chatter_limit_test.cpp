#include "graze/branch/chatter_limit.hpp"

#include "chattering.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace graze::chatter_limit_test {

using namespace graze::testing;

std::vector<SpecialPoint> climbed(const Model& model, const BranchSettings& settings, std::size_t rungs) {
    const Ladder ladder = climb(System(model), first_grazing(model, settings), settings, rungs);
    EXPECT_EQ(ladder.grazings().size(), rungs) << ladder.why();
    return ladder.grazings();
}

ChatterLimit limit_of_oscillator(const Model& model, double length, std::size_t rungs) {
    const BranchSettings settings = of_oscillator(model, length);
    return chatter_limit(System(model), climbed(model, settings, rungs), settings.parameter);
}

/// The same by the closed form of the flights in extended precision, over some contacts from rest at the stop, where
/// the force is about to stop holding the mass.
class Flights {
public:
    Flights(long double stop, long double restitution) : stop_(stop), e_(restitution) {}

    /// Returns the excess of the speed after a number of contacts over the self-similar one; NaN where there are fewer
    /// contacts.
    long double excess(int contacts, long double factor) {
        phase_ = std::acos(stop_);
        set(stop_, 0);
        long double time = 0.5L; // the height from rest grows with the third power of the time
        for (int k = 0; k < contacts; ++k) {
            const long double arrival = next(time);
            if (!(arrival > 0))
                return std::numeric_limits<long double>::quiet_NaN();
            const long double speed = rate(arrival);
            phase_ = std::fmod(phase_ + force_ * arrival, 2 * std::numbers::pi_v<long double>);
            set(stop_, -e_ * speed);
            time = 0;
        }
        // Derivatives of the height s - x after the contact.
        const long double v = -rate_, a = -(std::cos(phase_) - stop_ - 2 * damping_ * rate_),
                          j = -(-force_ * std::sin(phase_) - rate_ + 2 * damping_ * a);
        return v * j / (a * a) / factor - 1;
    }

private:
    void set(long double x, long double v) {
        const long double own = 1 - force_ * force_, other = 2 * damping_ * force_, size = own * own + other * other;
        cosine_ = own / size;
        sine_ = other / size;
        const long double forced = cosine_ * std::cos(phase_) + sine_ * std::sin(phase_),
                          speed = force_ * (-cosine_ * std::sin(phase_) + sine_ * std::cos(phase_));
        own_cosine_ = x - forced;
        own_sine_ = (v - speed + damping_ * own_cosine_) / frequency_;
        rate_ = v;
    }
    long double place(long double t) const {
        return std::exp(-damping_ * t) *
                   (own_cosine_ * std::cos(frequency_ * t) + own_sine_ * std::sin(frequency_ * t)) +
               cosine_ * std::cos(phase_ + force_ * t) + sine_ * std::sin(phase_ + force_ * t);
    }
    long double rate(long double t) const {
        const long double c = std::cos(frequency_ * t), s = std::sin(frequency_ * t);
        return std::exp(-damping_ * t) * ((frequency_ * own_sine_ - damping_ * own_cosine_) * c -
                                          (frequency_ * own_cosine_ + damping_ * own_sine_) * s) +
               force_ * (-cosine_ * std::sin(phase_ + force_ * t) + sine_ * std::cos(phase_ + force_ * t));
    }
    /// Returns the first time after `from` at which the stop is reached, searched in growing steps.
    long double next(long double from) const {
        long double left = from > 0 ? from : 1e-7L, step = left / 4;
        while (left < 40) {
            const long double right = left + step;
            if (place(right) > stop_)
                return bisected(left, right);
            left = right;
            step = std::min(0.02L, left / 8);
        }
        return 0;
    }
    long double bisected(long double left, long double right) const {
        constexpr int halvings = 70;
        for (int i = 0; i < halvings; ++i) {
            const long double middle = (left + right) / 2;
            (place(middle) > stop_ ? right : left) = middle;
        }
        return right;
    }

    long double stop_, e_, damping_ = zeta, force_ = omega, frequency_ = std::sqrt(1 - damping_ * damping_);
    long double phase_ = 0, cosine_ = 0, sine_ = 0, own_cosine_ = 0, own_sine_ = 0, rate_ = 0;
};

/// Returns the stop at which a number of contacts lead to the self-similar remainder, by the secant method.
long double stop_with(int contacts, long double guess, long double restitution) {
    const long double factor = self_similar_contacts(static_cast<double>(restitution)).speed;
    long double one = guess, other = guess * (1 + 1e-9L);
    long double at_one = Flights(one, restitution).excess(contacts, factor);
    constexpr int iterations = 12;
    for (int i = 0; i < iterations && other != one; ++i) {
        const long double at_other = Flights(other, restitution).excess(contacts, factor);
        const long double next = other - at_other * (other - one) / (at_other - at_one);
        one = std::exchange(other, next);
        at_one = at_other;
    }
    return other;
}

TEST(ChatterLimit, SelfSimilarContactsSolveTheirEquations) {
    for (const double e : {1e-6, 0.01, 0.3, 0.5, 0.9, 0.999}) {
        const SelfSimilarContacts known = self_similar_contacts(e);
        const double rho = known.times;
        EXPECT_NEAR(e * (1 + 2 * rho), rho * rho * (2 + rho), 8e-16);
        // One flight by its polynomial: it lands at -rho and leaves with rho^2 times the previous speed.
        const double before = known.speed, flight = 1 - rho;
        EXPECT_NEAR(before * flight - flight * flight / 2 + flight * flight * flight / 6, 0, 4e-16);
        EXPECT_NEAR(-e * (before - flight + flight * flight / 2), rho * rho * before, 4e-16);
    }
    EXPECT_THROW(self_similar_contacts(0), InputError);
    EXPECT_THROW(self_similar_contacts(1), InputError);
}

TEST(ChatterLimit, OscillatorHasItsClosedForm) {
    const ChatterLimit limit = limit_of_oscillator(chattering_oscillator(0.5, 1, 1), 1, 9);
    ASSERT_TRUE(limit.direct) << limit.problem;
    ASSERT_TRUE(limit.extrapolated);
    EXPECT_NEAR(limit.contacts.restitution, 0.5, 1e-6);
    // With n contacts the error is (rho^6 / e^2)^n = 0.33^n, and round-off grows by (rho / e)^2 = 1.7 per contact: a
    // few 1e-13 here.
    const auto known = static_cast<double>(stop_with(26, limit.direct->first, 0.5L));
    EXPECT_LT(limit.direct->second, 1e-10);
    EXPECT_NEAR(limit.direct->first, known, 1e-11);
    EXPECT_NEAR(limit.direct->first, known, limit.direct->second + 1e-12);
    EXPECT_LT(limit.extrapolated->second, 1e-4);
    EXPECT_NEAR(limit.extrapolated->first, known, limit.extrapolated->second);
    // The last segment represents all remaining contacts: the orbit has the full period.
    EXPECT_LT(limit.gap, 1e-8);
    EXPECT_NEAR(limit.orbit.return_time(), 2 * std::numbers::pi / omega, 1e-10);
}

/// Near a restitution of 1 hundreds of contacts are needed.
TEST(ChatterLimit, ContactsWithHighRestitutionHaveTheirClosedForm) {
    constexpr double restitution = 0.95, guessed = 0.3104;
    const Model model = chattering_oscillator(restitution, 1, 1);
    // The state in which the force stops holding the mass: x = s, v = 0, cos(theta) = s.
    const Segment contact{0, SegmentEnd::event, 0};
    const Orbit guess{
        {contact}, {guessed, 1}, {{guessed, 0, std::acos(guessed)}}, {2 * std::numbers::pi / omega}, std::nullopt};
    const ChatterLimit limit = chatter_limit_near(System(model), guess, 0, model.independent_parameter("s"));
    ASSERT_TRUE(limit.direct) << limit.problem;
    EXPECT_GT(limit.orbit.segments(), 200U);
    EXPECT_LT(limit.direct->second, 1e-8);
    // Closed form with bisection, since the secant method would need a better guess. (rho^6 / e^2)^n is 1e-10 with n =
    // 290; more contacts are below round-off in extended precision.
    const long double factor = self_similar_contacts(restitution).speed;
    long double low = 0.310726L, high = 0.310728L;
    constexpr int halvings = 60;
    for (int i = 0; i < halvings; ++i) {
        const long double middle = (low + high) / 2;
        (Flights(middle, restitution).excess(290, factor) < 0 ? low : high) = middle;
    }
    EXPECT_NEAR(limit.direct->first, static_cast<double>(low), limit.direct->second + 1e-10);
}

/// Two equal masses with a spring between them; the first has a stop and a slow force.
Model two_masses() {
    return OneMode{.parameters = "s = 1.5",
                   .states = "x = 0\nv = 0\ny = 0\nw = 0",
                   .definitions = "pull = '0.6*(x - y) + 0.18*(v - w)'",
                   .rates = "x = 'v', v = 'cos(theta) - x - 0.6*v - pull', y = 'w', w = '-y - 0.6*w + pull'",
                   .clock = "0.3",
                   .stops = {{"stop", "s - x", "v = '-0.75*v'"}}}
        .model();
}

TEST(ChatterLimit, TwoMassesAgreeWithSimulationFromLaddersOfAnyLength) {
    const Model model = two_masses();
    const BranchSettings settings = of_oscillator(model, 1);
    const std::vector<SpecialPoint> grazings = climbed(model, settings, 30);
    std::vector<double> values;
    for (const std::size_t rungs : {12U, 18U, 24U, 30U}) {
        const ChatterLimit limit = chatter_limit(System(model), std::span(grazings).first(rungs), settings.parameter);
        ASSERT_TRUE(limit.direct && limit.extrapolated) << limit.problem;
        EXPECT_NEAR(limit.contacts.restitution, 0.75, 1e-6);
        EXPECT_LT(limit.direct->second, 1e-8);
        EXPECT_NEAR(limit.extrapolated->first, limit.direct->first, limit.extrapolated->second + limit.direct->second);
        values.push_back(limit.direct->first);
    }
    for (const double value : values)
        EXPECT_NEAR(value, values.back(), 1e-9);
    const ChatterLimit limit = chatter_limit(System(model), grazings, settings.parameter);
    // With a nearer stop contacts accumulate in each period, with a farther one they are finitely many.
    for (const double side : {-1e-4, 1e-4}) {
        const double stop = limit.orbit.parameters[settings.parameter.place()] * (1 + side);
        Model moved = model;
        moved.set_parameter("s", stop);
        std::vector<double> state = limit.orbit.starts.at(1);
        state[0] = stop;
        constexpr double periods = 10;
        Experiment motion(moved);
        EXPECT_EQ(name_of(motion.run_from(state, 0, periods * limit.orbit.return_time()).ending),
                  name_of(side < 0 ? Ending::chatter : Ending::end_time))
            << side;
    }
}

TEST(ChatterLimit, DoesNotDependOnUnits) {
    const ChatterLimit known = limit_of_oscillator(chattering_oscillator(0.5, 1, 1), 1, 6);
    ASSERT_TRUE(known.direct) << known.problem;
    using Units = std::pair<double, double>;
    for (const auto& [length, time] : {Units(1e-9, 1e-6), Units(1e6, 1), Units(1e-20, 1e3), Units(1e15, 1e3)}) {
        const ChatterLimit limit = limit_of_oscillator(chattering_oscillator(0.5, length, time), length, 6);
        ASSERT_TRUE(limit.direct) << limit.problem;
        EXPECT_NEAR(limit.direct->first / length, known.direct->first, known.direct->second);
        EXPECT_LT(limit.direct->second / length, 1e-9); // round-off of the lowest flights
    }
}

TEST(ChatterLimit, MicroactuatorConvergesToItsLimit) {
    const Model model = shipped_with("impact-microactuator", {{"omega", 2.0056}, {"V", 0.1}});
    const BranchSettings settings = in_parameter(model, "V", 0.005, 3);
    const auto rungs = climbed(model, settings, 9);
    // "Published values": V_1 to V_8.
    const std::array known{.52745995765981, .66636423118007, .74940362005310, .79897011651099,
                           .82715666925300, .84240315127881, .85032000894172, .85431167398464};
    for (std::size_t i = 0; i < known.size(); ++i)
        EXPECT_NEAR(rungs[i].parameter, known[i], 2e-12);
    const ChatterLimit limit = chatter_limit(System(model), rungs, settings.parameter);
    ASSERT_TRUE(limit.direct) << limit.problem;
    // After each contact the frame slips for a time that decreases with the speed: the restitution tends to 0.5.
    EXPECT_NEAR(limit.contacts.restitution, 0.5, 1e-3);
    // Round-off limits the accuracy: the estimates are 8e-11 to 2.4e-10 at any tolerance.
    EXPECT_LT(limit.direct->second, 5e-10);
    EXPECT_NEAR(limit.extrapolated.value().first, limit.direct->first, limit.extrapolated->second);
}

TEST(ChatterLimit, PointsThatAreNotALadderAreRefused) {
    const Model model = chattering_oscillator(0.5, 1, 1);
    const std::vector<SpecialPoint> none(1);
    EXPECT_THROW(chatter_limit(System(model), none, model.independent_parameter("s")), InputError);
    std::vector<SpecialPoint> folds(3);
    for (SpecialPoint& fold : folds) {
        fold.type = PointType::fold;
        fold.located = true;
    }
    EXPECT_THROW(chatter_limit(System(model), folds, model.independent_parameter("s")), InputError);
}

} // namespace graze::chatter_limit_test
