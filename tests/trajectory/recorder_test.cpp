#include "graze/trajectory/recorder.hpp"

#include "trajectory/simulate.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

namespace graze::recorder_test {

/// Runs the MEMS switch of chapter 6 with an observer until snap-through.
void run_switch(Observer& observer, bool minima = false) {
    const Model model = load_model("mems-switch");
    const Simulation simulation(System(model), {section_probe(model, "phase0")}, {}, {.minima = minima});
    Trajectory trajectory(simulation, model.parameter_values(), borrowed(observer));
    trajectory.start(model.initial_state(), model.initial_mode, 0, 100);
    testing::run(trajectory);
    EXPECT_EQ(trajectory.outcome().ending, Ending::singular);
}

TEST(Recorder, KeepsStatesOfContactsAndPassages) {
    Recorder recorder;
    run_switch(recorder);
    int impacts = 0;
    double last = 0;
    for (const auto& [contact, before, after] : recorder.contacts()) {
        EXPECT_GE(contact.time, last);
        last = contact.time;
        ASSERT_EQ(before.size(), 3U);
        ASSERT_EQ(after.size(), 3U);
        if (before[1] != after[1]) {
            ++impacts;
            EXPECT_NEAR(after[1], -0.8 * before[1], 1e-15);
        }
    }
    EXPECT_EQ(impacts, 4);
    ASSERT_EQ(recorder.passages().size(), 4U);
    EXPECT_EQ(recorder.passages()[0].state[2], 0);
    recorder.clear();
    EXPECT_TRUE(recorder.contacts().empty());
}

TEST(Recorder, RelayForwardsToSeveralObservers) {
    Recorder one, other;
    Relay relay({borrowed(one), borrowed(other)});
    run_switch(relay);
    EXPECT_GT(one.contacts().size(), 4U);
    EXPECT_EQ(one.contacts().size(), other.contacts().size());
    EXPECT_EQ(one.passages().size(), other.passages().size());
}

TEST(Sampler, SamplesAtTheRequestedTimes) {
    const double period = 2 * std::numbers::pi;
    std::vector<double> times;

    Sampler sampler(0, 0.5, 40, {0, 0, period}, [&](double time, std::size_t, std::span<const double> state) {
        times.push_back(time);
        EXPECT_GE(state[0], -0.6 - 1e-15) << "sampled beyond the stop";
        EXPECT_NEAR(std::remainder(state[2] - time - 0.7306205700512591, period), 0, 1e-12);
        EXPECT_GE(state[2], 0);
        EXPECT_LT(state[2], period);
    });
    run_switch(sampler);
    ASSERT_EQ(times.size(), 40U);
    for (std::size_t i = 0; i < times.size(); ++i)
        EXPECT_EQ(times[i], 0.5 * static_cast<double>(i));
}

TEST(Sampler, CoarsensEvenly) {
    std::vector<double> times;
    Sampler* self = nullptr;
    Sampler sampler(0, std::exp2(-50), std::numeric_limits<std::size_t>::max(), {0, 0, 0},
                    [&](double time, std::size_t, std::span<const double>) {
                        times.push_back(time);
                        if (times.size() < 20)
                            return;
                        for (std::size_t i = 0; i < 10; ++i)
                            times[i] = times[2 * i];
                        times.resize(10);
                        self->coarsen();
                    });
    self = &sampler;
    run_switch(sampler);
    EXPECT_EQ(times.size(), sampler.taken());
    EXPECT_GE(times.size(), 10U);
    for (std::size_t i = 0; i < times.size(); ++i)
        EXPECT_EQ(times[i], static_cast<double>(i) * sampler.spacing());
    EXPECT_GT(sampler.next(), 27.3);
}

TEST(StepRecorder, KeepsTheMotionAtAnyTime) {
    StepRecorder recorder;
    std::vector<std::pair<double, std::vector<double>>> samples;
    Sampler sampler(0, 0.7, 30, {0, 0, 0}, [&](double time, std::size_t, std::span<const double> state) {
        samples.emplace_back(time, std::vector(state.begin(), state.end()));
    });
    Relay relay({borrowed(recorder), borrowed(sampler)});
    run_switch(relay);
    ASSERT_EQ(samples.size(), 30U);
    std::size_t at = 0;
    for (const RecordedStep& step : recorder.steps())
        for (; at < samples.size() && samples[at].first <= step.start + step.length; ++at)
            for (std::size_t i = 0; i < 2; ++i)
                EXPECT_EQ(step.state(i, samples[at].first - step.start), samples[at].second[i]) << at;
    EXPECT_EQ(at, samples.size());
    EXPECT_THROW(recorder.steps().front().state(3, 0), InputError);
}

TEST(ArcMinima, CoverTheTrajectoryWithoutGaps) {
    std::vector<ArcMinimum> minima;
    ArcMinima collector([&](const ArcMinimum& minimum) { minima.push_back(minimum); });
    run_switch(collector, true);
    collector.finish();
    ASSERT_GT(minima.size(), 10U);
    double end = 0;
    for (std::size_t i = 0; i < minima.size(); ++i) {
        const ArcMinimum& minimum = minima[i];
        EXPECT_LE(minimum.lower_bound, minimum.value);
        EXPECT_GE(minimum.time, minimum.start);
        EXPECT_LE(minimum.time, minimum.end + 1e-12);
        EXPECT_GE(minimum.value, -1e-14);
        if (i == 0 || minimum.arc != minima[i - 1].arc) {
            EXPECT_NEAR(minimum.start, end, 1e-12);
        }
        end = minimum.end;
    }
    EXPECT_NEAR(end, 27.31773570163, 1e-6);
}

} // namespace graze::recorder_test
