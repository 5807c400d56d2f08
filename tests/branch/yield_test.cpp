#include "graze/branch/yield.hpp"

#include "branch/examined_yield.hpp"
#include "driven_oscillator.hpp"
#include "graze/base/input_error.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace graze::yield_test {

using namespace graze::testing;

struct YieldExample {
    DrivenOscillator known;
    Model model = known.model();
    SpecialPoint point = known.grazing(model);
    ParameterId force = model.independent_parameter("F");
    YieldSettings settings;

    explicit YieldExample(const DrivenOscillator& of = {}) : known(of) {
        settings.devices = 500;
        settings.jobs = 2;
    }
    void add(const char* name, double size, Spread spread = Spread::normal) {
        settings.tolerances.push_back({model.independent_parameter(name), spread, size});
    }
    Yield yield() const { return yield_of(System(model), point, force, settings); }
};

TEST(Yield, ValueOfEachDeviceHasItsClosedForm) {
    for (const double unit : {1.0, 1e-9, 1e6}) {
        YieldExample shop(DrivenOscillator{unit, 1 / unit, unit});
        shop.add("omega", 0.03 * shop.known.omega);
        const Yield yield = shop.yield();
        ASSERT_EQ(yield.found, 500U);
        const double derivative = shop.known.derivatives()[3];
        for (const Device& device : yield.devices) {
            DrivenOscillator one = shop.known; // the drawn parameter follows from the linear estimate
            one.omega += (device.linear - yield.nominal) / derivative;
            EXPECT_NEAR(device.value / one.force(), 1, 1e-11);
        }
        EXPECT_GT(yield.largest_departure, 0);
    }
}

TEST(Yield, GivenDevicesHaveTheirClosedForm) {
    YieldExample shop;
    MadeDevices given{{shop.model.independent_parameter("omega"), shop.model.independent_parameter("sigma")}, {}};
    for (int i = 0; i < 50; ++i) // correlated, as from one process
        given.values.push_back({shop.known.omega * (1 + 0.001 * i), shop.known.sigma * (1 - 0.002 * i)});
    given.values.emplace_back(); // a device that cannot be made
    shop.settings.least = 0;
    const DeviceExamination examination{"", [](const LocatedSolution& device, const std::function<bool()>&) {
                                            return fmt::format("{:a}", device.value);
                                        }};
    const auto [yield, examined] =
        examined_yield_of(System(shop.model), shop.point, shop.force, given, shop.settings, examination);
    ASSERT_EQ(yield.found, 50U);
    EXPECT_EQ(yield.failed, 1U);
    EXPECT_EQ(yield.problems.front().first, "the device cannot be made");
    for (std::size_t i = 0; i < 50; ++i) {
        DrivenOscillator one = shop.known;
        one.omega = given.values[i][0];
        one.sigma = given.values[i][1];
        EXPECT_NEAR(yield.devices[i].value / one.force(), 1, 1e-11);
        EXPECT_EQ(examined[i], fmt::format("{:a}", yield.devices[i].value));
    }
    EXPECT_EQ(examined.back(), "");
    EXPECT_NEAR(yield.within.value().value, 50.0 / 51, 1e-15);
    EXPECT_GT(yield.linear_deviation, 0);
    given.values[0].pop_back();
    EXPECT_THROW(yield_of(System(shop.model), shop.point, shop.force, given, shop.settings), InputError);
}

TEST(Yield, LinearValueHasTheStatisticsOfTheDrawnParameter) {
    YieldExample shop;
    shop.settings.devices = 4000;
    shop.add("sigma", 0.02);
    shop.settings.least = shop.known.force() - 0.02 * shop.known.derivatives()[4]; // one standard deviation below
    const Yield yield = shop.yield();
    const double deviation = 0.02 * shop.known.derivatives()[4];
    EXPECT_NEAR(yield.linear_deviation, deviation, 1e-11);
    EXPECT_LT(yield.largest_departure, 1e-11); // the value is linear in sigma
    // Four standard errors: another seed would fail once in 16000 times.
    const double error = deviation / std::sqrt(4000.0);
    EXPECT_NEAR(yield.mean.value().value, shop.known.force(), 4 * error);
    EXPECT_NEAR(yield.mean->high - yield.mean->value, 1.96 * error, 0.1 * error);
    EXPECT_NEAR(yield.deviation.value().value, deviation, 4 * error / std::sqrt(2.0));
    EXPECT_NEAR(yield.deviation->high - yield.deviation->value, 1.96 * error / std::sqrt(2.0), 0.1 * error);
    constexpr double share = 0.8413447460685429; // share of a normal distribution above -1
    EXPECT_NEAR(yield.within.value().value, share, 4 * std::sqrt(share * (1 - share) / 4000));
    const ConfidenceInterval surely =
        wilson_interval(static_cast<std::size_t>(std::lround(4000 * yield.within->value)), 4000, 0.9999);
    EXPECT_LT(surely.low, share);
    EXPECT_GT(surely.high, share);
    EXPECT_LT(yield.within->low, yield.within->value);
    EXPECT_GT(yield.within->high, yield.within->value);
    EXPECT_EQ(yield.linear_within.value(), yield.within->value);
    ASSERT_EQ(yield.quantiles.size(), 7U);
    EXPECT_LT(yield.quantiles[3].low.value(), shop.known.force());
    EXPECT_GT(yield.quantiles[3].high.value(), shop.known.force());
    for (std::size_t i = 1; i < 7; ++i)
        EXPECT_GT(yield.quantiles[i].value, yield.quantiles[i - 1].value);
}

TEST(Yield, ContributionsAreSortedSharesOfTheVariance) {
    YieldExample shop;
    shop.settings.devices = 2000;
    shop.add("m", 0.004, Spread::uniform);
    shop.add("e", 0.1);
    shop.add("sigma", 0.003);
    const Yield yield = shop.yield();
    const auto by = shop.known.derivatives();
    const double of_mass = by[0] * 0.004 / std::sqrt(3.0), of_stop = by[4] * 0.003;
    EXPECT_NEAR(yield.linear_deviation, std::hypot(of_mass, of_stop), 1e-12);
    EXPECT_NEAR(yield.deviation.value().value / yield.linear_deviation, 1, 0.07); // four standard errors
    ASSERT_EQ(yield.contributions.size(), 3U);
    EXPECT_EQ(yield.contributions[2].parameter, shop.model.independent_parameter("e"));
    EXPECT_EQ(yield.contributions[2].share, 0);
    EXPECT_NEAR(yield.contributions[0].share + yield.contributions[1].share, 1, 1e-14);
    EXPECT_GT(yield.contributions[0].share, yield.contributions[1].share);
    const bool mass_first = std::abs(of_mass) > of_stop;
    EXPECT_NEAR(yield.contributions[0].deviation, mass_first ? of_mass : of_stop, 1e-12);
}

TEST(Yield, ResultsAreIdenticalOnAnyNumberOfThreads) {
    YieldExample shop;
    shop.settings.devices = 300;
    shop.add("omega", 0.3, Spread::uniform); // wide enough for divided paths
    shop.add("k", 0.2);
    shop.settings.jobs = 1;
    const Yield once = shop.yield();
    for (const int jobs : {2, 5}) {
        shop.settings.jobs = jobs;
        const Yield again = shop.yield();
        ASSERT_EQ(again.devices.size(), once.devices.size());
        for (std::size_t i = 0; i < once.devices.size(); ++i) {
            EXPECT_EQ(again.devices[i].outcome, once.devices[i].outcome);
            EXPECT_EQ(again.devices[i].value, once.devices[i].value);
            EXPECT_EQ(again.devices[i].linear, once.devices[i].linear);
        }
        EXPECT_EQ(again.mean.value().value, once.mean.value().value);
    }
    shop.settings.seed = 2;
    EXPECT_NE(shop.yield().mean.value().value, once.mean.value().value);
}

TEST(Yield, DevicesThatAreNotFoundAreCounted) {
    YieldExample shop;
    shop.settings.devices = 200;
    shop.add("sigma", 1.2); // some stops lie beyond the rest position, so that no orbit touches from inside
    shop.settings.least = 0;
    const Yield yield = shop.yield();
    EXPECT_EQ(yield.made, 200U);
    EXPECT_EQ(yield.found + yield.inadmissible + yield.failed, 200U);
    EXPECT_GT(yield.inadmissible + yield.failed, 0U);
    std::size_t told = 0;
    for (const auto& [problem, count] : yield.problems) {
        EXPECT_FALSE(problem.empty());
        told += count;
    }
    EXPECT_EQ(told, yield.inadmissible + yield.failed);
    EXPECT_LE(yield.within.value().value, static_cast<double>(yield.found) / 200);
}

TEST(Yield, StopsWhenInterrupted) {
    YieldExample shop;
    shop.add("sigma", 0.01);
    shop.settings.jobs = 1;
    std::size_t seen = 0;
    shop.settings.progress = [&](std::size_t devices) { seen = devices; };
    shop.settings.interrupted = [&] { return seen == 7; };
    const Yield yield = shop.yield();
    EXPECT_TRUE(yield.interrupted);
    EXPECT_EQ(yield.made, 7U);
    EXPECT_EQ(yield.found, 7U);
    EXPECT_FALSE(yield.quantiles[0].low); // too few devices for a confidence limit
}

TEST(Yield, SettingsOutOfRangeAreRefused) {
    YieldExample shop;
    EXPECT_THROW(shop.yield(), InputError);
    shop.add("sigma", -1);
    EXPECT_THROW(shop.yield(), InputError);
    shop.settings.tolerances[0].size = 0.01;
    const auto refused = [&](auto change) {
        YieldSettings wrong = shop.settings;
        change(wrong);
        EXPECT_THROW(yield_of(System(shop.model), shop.point, shop.force, wrong), InputError);
    };
    refused([](YieldSettings& s) { s.devices = 0; });
    refused([](YieldSettings& s) { s.jobs = 0; });
    refused([](YieldSettings& s) { s.confidence = 1; });
    refused([](YieldSettings& s) { s.quantiles = {0}; });
    refused([](YieldSettings& s) { s.solver.halvings = 100; });
    refused([](YieldSettings& s) {
        s.least = 2;
        s.greatest = 1;
    });
    shop.add("sigma", 0.01);
    EXPECT_THROW(shop.yield(), InputError); // twice
}

TEST(WilsonInterval, LimitsSolveTheDefiningEquation) {
    // Both limits p solve (share - p)^2 = z^2 p (1 - p) / n.
    constexpr double z = 1.959963984540054;
    for (const auto& [hits, trials] : {std::pair<std::size_t, std::size_t>{3, 10}, {50, 1000}, {999, 1000}}) {
        const ConfidenceInterval one = wilson_interval(hits, trials, 0.95);
        const auto n = static_cast<double>(trials);
        EXPECT_EQ(one.value, static_cast<double>(hits) / n);
        for (const double p : {one.low, one.high})
            EXPECT_NEAR((one.value - p) * (one.value - p), z * z * p * (1 - p) / n, 1e-13);
    }
    EXPECT_EQ(wilson_interval(0, 10, 0.95).low, 0);
    EXPECT_EQ(wilson_interval(10, 10, 0.95).high, 1);
    EXPECT_THROW(wilson_interval(0, 0, 0.95), InputError);
    EXPECT_THROW(wilson_interval(2, 1, 0.95), InputError);
}

} // namespace graze::yield_test
