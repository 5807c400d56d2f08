#include "graze/record/impacts.hpp"

#include "graze/base/input_error.hpp"
#include "record/recorded_model.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace graze::testing::impacts_test {

/// Impacts of the simulation within the rows in which they can be found.
std::vector<Recorder::RecordedContact> known(const RecordedModel& recorded, const std::string& velocity, double edge,
                                             double least_jump) {
    std::vector<Recorder::RecordedContact> result;
    const std::size_t v = recorded.header.channel(velocity, "test");
    for (const auto& contact : recorded.truth.contacts())
        if (contact.contact.time > recorded.samples.times.front() + edge &&
            contact.contact.time < recorded.samples.times.back() - edge &&
            std::abs(contact.after[v] - contact.before[v]) > least_jump)
            result.push_back(contact);
    return result;
}

TEST(Impacts, OfABouncingBallAreExact) {
    // Falls with 9.81 from 1 and bounces with 0.8: the velocity is linear between impacts.
    const double g = 9.81, first = std::sqrt(2 / g);
    std::vector<double> times{first}, speeds{std::sqrt(2 * g)};
    for (int k = 0; k < 4; ++k) {
        speeds.push_back(0.8 * speeds.back());
        times.push_back(times.back() + 2 * speeds.back() / g);
    }
    const auto velocity = [&](double t) {
        double value = -g * t;
        for (std::size_t k = 0; k < times.size(); ++k)
            if (t > times[k])
                value = 0.8 * speeds[k] - g * (t - times[k]);
        return value;
    };
    const auto height = [&](double t) {
        double value = 1 - 0.5 * g * t * t;
        for (std::size_t k = 0; k < times.size(); ++k)
            if (t > times[k])
                value = 0.8 * speeds[k] * (t - times[k]) - 0.5 * g * std::pow(t - times[k], 2);
        return value;
    };
    StoredSamples source(named({"y", "v"}), sampled(1000, 2000, {height, velocity}), 300);
    const std::vector<RecordedImpact> impacts = find_impacts(source, {{}, 1, 0});
    ASSERT_EQ(impacts.size(), 3U); // the record ends before the fourth
    for (std::size_t k = 0; k < impacts.size(); ++k) {
        EXPECT_NEAR(impacts[k].time, times[k], 1e-11);
        EXPECT_NEAR(impacts[k].before, -speeds[k], 1e-10);
        EXPECT_NEAR(impacts[k].after, 0.8 * speeds[k], 1e-10);
    }
}

TEST(Impacts, OfTheTestbedAreFoundInNoise) {
    for (const double sigma : {0.0, 1e-3, 5e-3}) {
        RecordedModel recorded(load_model("electromagnetic-testbed"), "theta", 2.0, 5000, 100'000);
        Noise noise(3);
        recorded.add_noise("v", sigma, noise);
        recorded.add_noise("q", 1e-6, noise);
        StoredSamples source(recorded.header, recorded.samples);
        const ImpactSettings settings = impact_settings(recorded.header, "v", "q", {});
        const auto truth = known(recorded, "v", 0.02, 8 * sigma);
        ASSERT_GT(truth.size(), 40U);
        const std::vector<RecordedImpact> impacts = find_impacts(source, settings);
        std::size_t found = 0, times = 0, speeds = 0;
        for (const auto& contact : truth)
            for (const RecordedImpact& impact : impacts) {
                if (std::abs(impact.time - contact.contact.time) > 5e-4)
                    continue;
                ++found;
                times += std::abs(impact.time - contact.contact.time) < 3 * impact.time_error + 1e-8 ? 1 : 0;
                speeds += std::abs(impact.before - contact.before[1]) < 3 * impact.before_error + 2e-4 &&
                                  std::abs(impact.after - contact.after[1]) < 3 * impact.after_error + 2e-4
                              ? 1
                              : 0;
            }
        const auto count = static_cast<double>(truth.size());
        EXPECT_EQ(found, truth.size()) << sigma;
        for (const RecordedImpact& impact : impacts)
            EXPECT_TRUE(
                std::any_of(recorded.truth.contacts().begin(), recorded.truth.contacts().end(),
                            [&](const auto& contact) { return std::abs(contact.contact.time - impact.time) < 5e-4; }))
                << "none where there is none, with noise " << sigma;
        EXPECT_GE(static_cast<double>(speeds), 0.95 * count) << sigma;
        EXPECT_GE(static_cast<double>(times), 0.95 * count) << sigma;
    }
}

TEST(Impacts, OfAShakerGrowAsPublished) {
    // Impact velocities from rest at a = 0.6505 mm, f = 6 Hz: they grow from 1.5 to 38 mm/s.
    RecordedModel recorded(load_model("ball-and-shaker"), "theta", 0.0, 12'800, 6000);
    Noise noise(1);
    recorded.add_noise("v", 0.05, noise);
    StoredSamples source(recorded.header, recorded.samples);
    const ImpactSettings settings = impact_settings(recorded.header, "v", "", {.window = 32});
    const std::vector<RecordedImpact> impacts = find_impacts(source, settings);
    ASSERT_GE(impacts.size(), 3U);
    const double times[] = {0.040626571561, 0.19997381698, 0.3533191041};
    const double jumps[] = {1.4900573956, 12.733127832, 37.681754587};
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(impacts[k].time, times[k], 1.5 * std::sqrt(3.0) * impacts[k].time_error);
        const double error = std::hypot(impacts[k].before_error, impacts[k].after_error);
        EXPECT_NEAR(impacts[k].after - impacts[k].before, jumps[k], 3 * error + 0.01);
    }
}

TEST(Impacts, AreNotFoundInSmoothMotionWithNoise) {
    Noise noise(2);
    for (const double sigma : {0.0, 1e-4, 0.3}) {
        StoredSamples source(named({"v"}), sampled(200, 50'000, {[&](double t) {
                                                       return std::sin(20 * t) + 0.3 * std::sin(57 * t + 1) +
                                                              sigma * noise.normal();
                                                   }}));
        EXPECT_EQ(find_impacts(source, {}).size(), 0U) << sigma;
    }
}

TEST(Impacts, AreNotFoundInNumbersWithFewDigits) {
    StoredSamples source(named({"v"}),
                         sampled(1000, 20'000, {[](double t) { return std::round(50 * std::sin(t)) / 50; }}));
    EXPECT_EQ(find_impacts(source, {}).size(), 0U);
}

TEST(Impacts, RefuseInvalidSettings) {
    StoredSamples source(named({"v"}), sampled(200, 500, {[](double t) { return t; }}));
    for (const ImpactSettings& settings :
         {ImpactSettings{{}, 1}, {{}, 0, 1}, {{.window = 4}}, {{}, 0, {}, 0}, {{.least_jump = -1}}})
        EXPECT_THROW(ImpactFinder(borrowed(source), settings), InputError);
}

} // namespace graze::testing::impacts_test
