// Trips under ramps, waves and noise, against closed forms and simple recursions.

#include "graze/trip/disturbed_trip.hpp"
#include "graze/trip/noisy_trip.hpp"

#include "branch/maps.hpp"
#include "graze/model/named_value.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace graze::disturbed_trip_test {

using namespace graze::testing;
using std::numbers::pi;

/// x relaxes to p at the rate c. @param value of p, at which the motion starts at rest
struct Relaxing {
    explicit Relaxing(double c, double value, double point, double unit = 1)
        : model(model_from(fmt::format("[parameters]\np = {:.17g}\nc = {:.17g}\n[states]\nx = 0\n"
                                       "[modes.only]\nrates = {{ x = \"c*(p - x)\" }}\n",
                                       value, c))) {
        origin.parameter = model.independent_parameter("p");
        origin.value = value;
        origin.point = point;
        origin.cycle = unit;
        origin.state = {value};
        origin.parameters = model.parameter_values();
        end.quantity = named_value(model, "x", {}).value;
        end.level = point;
    }
    Model model;
    TripOrigin origin;
    TripEnd end;
};

double normal(double x) {
    return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

TEST(DisturbedTrip, RampOfALinearLagHasItsClosedForm) {
    // x = v0 + r (t - (1 - exp(-c t))/c) passes the level 1: the value is late by the lag.
    for (const double c : {0.5, 20.0})
        for (const double rate : {1e-3, 1.0}) {
            const Relaxing one(c, 0.2, 1);
            const RampedTrip ramped = ramped_trip(System(one.model), one.origin, rate, one.end);
            ASSERT_TRUE(ramped.trip.ended);
            EXPECT_EQ(ramped.trip.ending, "level");
            const double t = ramped.trip.time, x = 0.2 + rate * (t - (1 - std::exp(-c * t)) / c);
            EXPECT_NEAR(x, 1, 1e-11);
            EXPECT_NEAR(ramped.value, 0.2 + rate * t, 1e-12);
        }
    const Relaxing falling(1, 2, 1);
    EXPECT_LT(ramped_trip(System(falling.model), falling.origin, -0.1, falling.end).value, 1);
    EXPECT_THROW(ramped_trip(System(falling.model), falling.origin, 0.1, falling.end), InputError);
    EXPECT_THROW(ramped_trip(System(falling.model), falling.origin, 0, falling.end), InputError);
}

TEST(DisturbedTrip, RampThroughAFoldHasTheAiryDelay) {
    // x' = p + x^2 with p = r t: x = -u'/u for u'' = -r t u, the Airy function of -r^(1/3) t, and infinite at its zero.
    const Model model = model_from("[parameters]\np = 0\n[states]\nx = 0\n[modes.only]\nrates = { x = \"p + x^2\" }\n");
    for (const double rate : {1e-2, 1e-5, 1e-8}) {
        TripOrigin origin;
        const double scale = std::cbrt(rate * rate);
        origin.value = -30 * scale; // the initial transient has decayed by exp(-4/3 30^(3/2))
        origin.cycle = 1;
        origin.state = {-std::sqrt(30 * scale)};
        origin.parameters = {origin.value};
        TripOptions options;
        options.cycles = 10 / std::cbrt(rate);
        const RampedTrip ramped = ramped_trip(System(model), origin, rate, {}, options);
        ASSERT_EQ(ramped.trip.ending, "singular");
        EXPECT_NEAR(ramped.value / scale, 2.338107410459767, 1e-9);
        FoldPassage fold;
        fold.coefficient = fold.rate = fold.cycle = 1;
        EXPECT_NEAR(ramped.value / delay_of_ramp(fold, rate), 1, 1e-9);
    }
}

TEST(DisturbedTrip, RampThroughAFoldOfAMapFollowsItsRecursion) {
    // Once per cycle x -> x + p + x^2, until a state that follows x within a cycle crosses 1.
    const Model model = map_model("p = -0.04", {"x + p + x^2", "0.1*y", "0"});
    BranchSettings settings = in_parameter(model, "p", -0.1, 0.1);
    const Branch branch = follow_branch(System(model), fixed_point(model, {-0.2, 0, 0}), settings);
    ASSERT_FALSE(of_type(branch, PointType::fold).empty());
    const FoldPassage fold = fold_passage(System(model), of_type(branch, PointType::fold)[0], settings.parameter);
    // Starts in the middle of a cycle.
    const TripOrigin origin = trip_origin(System(model), fold, -0.01);
    EXPECT_NEAR(origin.state[0], -0.1, 1e-9);
    EXPECT_NEAR(origin.state[3], 0.5, 1e-12);
    // Beyond the validity of the normal form.
    EXPECT_NEAR(trip_origin(System(model), fold, -0.09).state[0], -0.3, 1e-9);
    // Direct recursion with the value of p at the end of each cycle.
    TripEnd end;
    end.quantity = named_value(model, "x*clock", {}).value;
    end.level = 1;
    const double rate = 1e-5;
    const RampedTrip ramped = ramped_trip(System(model), origin, rate, end);
    double x = -0.1, p = -0.01 + 0.5 * rate;
    int ticks = 0;
    for (; x <= 1; ++ticks, p += rate)
        x += p + x * x;
    // In the cycle after the last tick x*clock crosses 1.
    EXPECT_NEAR(ramped.trip.time, ticks - 0.5 + 1 / x, 1e-7);
    EXPECT_NEAR(ramped.value, -0.01 + rate * ramped.trip.time, 1e-12);
    EXPECT_NEAR(ramped.value, delay_of_ramp(fold, rate), 5 * rate); // some cycles
    EXPECT_THROW(trip_origin(System(model), fold, 0.01), InputError);
    EXPECT_THROW(trip_origin(System(model), fold, 0), InputError);
}

TEST(DisturbedTrip, WaveOfALinearLagHasItsClosedForm) {
    // x = A c/(c^2 + w^2)^(1/2) (sin(w t - phi) + sin(phi) exp(-c t)), whose first crest is the highest.
    const double c = 2, period = 3, w = 2 * pi / period, phi = std::atan2(w, c);
    double crest = 0;
    for (int i = 0; i < 100'000; ++i) {
        const double t = 1e-5 * period * i;
        crest = std::max(crest, std::sin(w * t - phi) + std::sin(phi) * std::exp(-c * t));
    }
    const double gain = crest * c / std::hypot(c, w); // accurate to 1e-9, due to the steps of t
    const Relaxing one(c, 0, 1);
    TripOptions options;
    options.cycles = 200;
    EXPECT_FALSE(swung_trip(System(one.model), one.origin, (1 - 1e-8) / gain, period, one.end, options).ended);
    const TripTime trip = swung_trip(System(one.model), one.origin, (1 + 1e-8) / gain, period, one.end, options);
    EXPECT_TRUE(trip.ended);
    EXPECT_LT(trip.time, period);
    EXPECT_THROW(swung_trip(System(one.model), one.origin, 1, 0, one.end), InputError);
}

TEST(DisturbedTrip, NoiseOfAFastLagTripsWithTheProbabilityOfItsValues) {
    // x follows p within each cycle (c = 40, up to exp(-40)): no trip while all values are below the margin.
    const Relaxing one(40, 0, 1);
    NoiseSettings settings;
    settings.motions = 4000;
    settings.jobs = 2;
    settings.confidence = 0.9999; // four limits in a test that is run for years
    settings.cycles = 20;
    double before = 0;
    for (const double level : {0.3, 0.4, 0.6}) {
        const NoisyTrips trips = noisy_trips(System(one.model), one.origin, level, one.end, settings);
        EXPECT_EQ(trips.motions, 4000U);
        EXPECT_EQ(trips.failed, 0U);
        EXPECT_EQ(trips.trips, trips.beyond);
        const double expected = 1 - std::pow(normal(1 / level), 20);
        EXPECT_GT(expected, trips.probability.low) << level;
        EXPECT_LT(expected, trips.probability.high) << level;
        EXPECT_GT(trips.probability.value, before);
        before = trips.probability.value;
    }
    EXPECT_EQ(noisy_trips(System(one.model), one.origin, 0, one.end, settings).trips, 0U);
}

TEST(DisturbedTrip, NoiseWithAMemoryHasTheCorrelationOfItsProcess) {
    // Without margin the probability of no trip in two cycles is that of an orthant: 1/4 + asin(rho)/(2 pi), and in
    // three 1/8 + (2 asin(rho) + asin(rho^2))/(4 pi) (Sheppard 1899).
    const Relaxing one(40, 0, 1e-9);
    NoiseSettings settings;
    settings.motions = 4000;
    settings.confidence = 0.9999;
    for (const double memory : {0.0, 0.7, 5.0}) {
        settings.memory = memory;
        const double rho = memory > 0 ? std::exp(-1 / memory) : 0;
        settings.cycles = 2;
        const NoisyTrips two = noisy_trips(System(one.model), one.origin, 1, one.end, settings);
        const double rest_two = 0.25 + std::asin(rho) / (2 * pi);
        EXPECT_GT(1 - rest_two, two.probability.low) << memory;
        EXPECT_LT(1 - rest_two, two.probability.high) << memory;
        settings.cycles = 3;
        const NoisyTrips three = noisy_trips(System(one.model), one.origin, 1, one.end, settings);
        const double rest_three = 0.125 + (2 * std::asin(rho) + std::asin(rho * rho)) / (4 * pi);
        EXPECT_GT(1 - rest_three, three.probability.low) << memory;
        EXPECT_LT(1 - rest_three, three.probability.high) << memory;
    }
}

TEST(DisturbedTrip, NoiseOfASlowLagFollowsItsRecursion) {
    // x_{k+1} = p_k + (x_k - p_k) exp(-c), with its largest values at the ends of cycles.
    const double c = 0.3, memory = 4, level = 1.2, keeps = std::exp(-c), rho = std::exp(-1 / memory);
    const Relaxing one(c, 0, 1);
    NoiseSettings settings;
    settings.motions = 4000;
    settings.cycles = 30;
    settings.memory = memory;
    settings.confidence = 0.9999;
    const NoisyTrips trips = noisy_trips(System(one.model), one.origin, level, one.end, settings);
    std::mt19937_64 engine(7); // an independent generator
    std::normal_distribution<double> unit;
    constexpr int many = 400'000; // a tenth of the uncertainty of the simulation
    int tripped = 0;
    for (int i = 0; i < many; ++i) {
        double x = 0, y = unit(engine);
        bool trip = false;
        for (int k = 0; k < 30 && !trip; ++k) {
            x = level * y + (x - level * y) * keeps;
            y = rho * y + std::sqrt(1 - rho * rho) * unit(engine);
            trip = x > 1;
        }
        tripped += trip ? 1 : 0;
    }
    EXPECT_GT(static_cast<double>(tripped) / many, trips.probability.low);
    EXPECT_LT(static_cast<double>(tripped) / many, trips.probability.high);
    EXPECT_LT(trips.trips, trips.beyond); // the lag smooths the noise
}

TEST(DisturbedTrip, NoiseIsTheSameOnAnyNumberOfThreads) {
    const Relaxing one(0.3, 0, 1);
    NoiseSettings settings;
    settings.motions = 333;
    settings.cycles = 20;
    const NoisyTrips alone = noisy_trips(System(one.model), one.origin, 1.5, one.end, settings);
    EXPECT_GT(alone.trips, 10U);
    for (const int jobs : {2, 5}) {
        settings.jobs = jobs;
        const NoisyTrips together = noisy_trips(System(one.model), one.origin, 1.5, one.end, settings);
        EXPECT_EQ(together.trips, alone.trips);
        EXPECT_EQ(together.half, alone.half);
        EXPECT_EQ(together.beyond, alone.beyond);
    }
    settings.seed = 2;
    EXPECT_NE(noisy_trips(System(one.model), one.origin, 1.5, one.end, settings).trips, alone.trips);
    settings.interrupted = [] { return true; };
    const NoisyTrips interrupted = noisy_trips(System(one.model), one.origin, 1.5, one.end, settings);
    EXPECT_TRUE(interrupted.interrupted);
    EXPECT_LT(interrupted.motions, 333U);
    settings.motions = 0;
    EXPECT_THROW(noisy_trips(System(one.model), one.origin, 1.5, one.end, settings), InputError);
}

TEST(DisturbedTrip, NoiseIsInterruptedWithinAMotion) {
    const Relaxing one(0.3, 0, 1);
    NoiseSettings settings;
    settings.motions = 1;
    settings.cycles = 100'000'000; // hours
    int asked = 0;
    settings.interrupted = [&] { return ++asked > 5; };
    const NoisyTrips trips = noisy_trips(System(one.model), one.origin, 1e-9, one.end, settings);
    EXPECT_TRUE(trips.interrupted);
    EXPECT_EQ(trips.motions, 0U);
}

/// The switch of chapter 6 at its touch.
struct Switch {
    explicit Switch(double omega) : model(load_model("mems-switch")) {
        model.set_parameter("V", 0.05);
        model.set_parameter("omega", omega);
        for (const char* state : {"q", "v", "theta"})
            model.set_initial(state, 0);
        BranchSettings settings = in_parameter(model, "V", 0.01, 0.4);
        branch = follow_branch(System(model), settled(model, "phase0").orbit, settings);
        parameter = settings.parameter;
    }
    Model model;
    Branch branch;
    ParameterId parameter;
};

TEST(DisturbedTrip, RampOfTheSwitchTripsAtItsTouch) {
    const Switch one(1);
    const System system(one.model);
    const SpecialPoint touch = of_type(one.branch, PointType::grazing).at(0);
    const CycleMap map = cycle_at(one.model, touch, one.parameter);
    const double point = touch.parameter, cycle = 2 * pi;
    EXPECT_NEAR(point, 0.2013662121541341, 1e-11);
    double cycles_before = 0;
    for (const double rate : {1e-5, 1e-7, 1e-9, 1e-11}) {
        const TripOrigin origin = trip_origin(system, touch.solution.orbit, map, one.parameter, point - 700 * rate);
        const RampedTrip ramped = ramped_trip(system, origin, rate, {});
        ASSERT_TRUE(ramped.trip.ended) << ramped.trip.ending;
        // The motion lags by some cycles of the ramp; from the first contact on the trip takes as long as after a
        // parameter step of the ramp's change per cycle.
        const double cycles = (ramped.value - point) / (rate * cycle);
        EXPECT_GT(cycles, 3) << rate;
        EXPECT_LT(cycles, 16) << rate;
        EXPECT_GT(cycles, cycles_before);
        EXPECT_LT(cycles - cycles_before, cycles_before > 0 ? 2 : 16); // log log of the rate
        cycles_before = cycles;
    }
    // A slow wave trips where its crest is beyond the touch.
    const TripOrigin origin = trip_origin(system, touch.solution.orbit, map, one.parameter, 0.99 * point);
    TripOptions options;
    options.cycles = 800;
    EXPECT_FALSE(swung_trip(system, origin, 0.0095 * point, 400 * cycle, {}, options).ended);
    EXPECT_TRUE(swung_trip(system, origin, 0.0105 * point, 400 * cycle, {}, options).ended);
    // Noise of level zero never trips, and noise as large as the margin nearly always.
    NoiseSettings settings;
    settings.motions = 40;
    settings.cycles = 50;
    EXPECT_EQ(noisy_trips(system, origin, 1e-5 * point, {}, settings).trips, 0U);
    EXPECT_GT(noisy_trips(system, origin, 0.03 * point, {}, settings).trips, 30U);
}

TEST(DisturbedTrip, RampOfTheSwitchThroughItsFoldHasTheTwoThirdsDelay) {
    const Switch one(0.95);
    const System system(one.model);
    const FoldPassage fold = fold_passage(system, of_type(one.branch, PointType::fold).at(0), one.parameter);
    TripEnd end; // beyond the fold the motion reaches the stop
    end.quantity = named_value(one.model, "q + delta", {}).value;
    TripOptions options;
    options.cycles = 20'000;
    for (const double rate : {1e-7, 1e-9, 1e-11}) {
        const double predicted = delay_of_ramp(fold, rate);
        const TripOrigin origin = trip_origin(system, fold, fold.value - 4 * predicted);
        const RampedTrip ramped = ramped_trip(system, origin, rate, end, options);
        ASSERT_EQ(ramped.trip.ending, "level");
        // The stop is reached about 20 cycles before infinity, and the next order is of the same size.
        EXPECT_NEAR(ramped.value - fold.value, predicted, 40 * rate * fold.cycle) << rate;
        EXPECT_LT(40 * rate * fold.cycle, predicted);
    }
}

} // namespace graze::disturbed_trip_test
