#include "graze/sweep/plan.hpp"

#include "graze/model/catalogue.hpp"
#include "trajectory/model_parts.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <stdexcept>

namespace graze::plan_test {

/// A few voltages of the testbed; each chain starts with another current.
struct Setting {
    Model model = load_model("electromagnetic-testbed");
    std::unique_ptr<SearchFactory> searches;
    Plan plan;

    explicit Setting(std::size_t chains, std::size_t length, bool carry) {
        const AttractorOptions options{.section = "phase0", .cycles = 60, .lyapunov_cycles = 40};
        Sampling sampling;
        sampling.name = "phase0";
        sampling.section = "phase0";
        searches = attractor_searches(System(model), options, {sampling}, {model.symbol("v"), model.symbol("I")}, {});
        plan.chains = chains;
        plan.chain_length = length;
        plan.carry = carry;
        std::size_t voltage = 0, current = *model.find_state("I");
        for (std::size_t i = 0; i < model.parameter_symbols().size(); ++i)
            if (model.parameter_symbols()[i].name() == "V0")
                voltage = i;
        plan.start = [this, voltage, current, length](std::size_t point) {
            PointStart start{model.parameter_values(), model.initial_state(), model.initial_mode};
            start.parameters[voltage] = 4.85 + 0.03 * static_cast<double>(point % length);
            start.state[current] = 0.1 * static_cast<double>(point / length);
            return start;
        };
    }

    std::map<std::size_t, PointResult> run(const ExecutionOptions& options, const KnownChains& known = {}) {
        std::map<std::size_t, PointResult> results;
        EXPECT_TRUE(execute(plan, *searches, known, options,
                            [&](std::size_t point, const PointStart&, auto& result) { results[point] = result; }));
        return results;
    }
};

void expect_same(const std::map<std::size_t, PointResult>& a, const std::map<std::size_t, PointResult>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (const auto& [point, result] : a) {
        const PointResult& other = b.at(point);
        EXPECT_EQ(result.label, other.label) << point;
        EXPECT_EQ(result.period, other.period);
        EXPECT_EQ(result.state, other.state) << point;
        EXPECT_EQ(result.samples.values, other.samples.values);
        EXPECT_EQ(result.multipliers, other.multipliers);
        EXPECT_EQ(result.lyapunov, other.lyapunov);
        EXPECT_EQ(result.cycles, other.cycles);
    }
}

TEST(Plan, ResultsDoNotDependOnThreadsAndLanes) {
    Setting many(11, 2, true);
    const auto alone = many.run({});
    ASSERT_EQ(alone.size(), 22u);
    for (const int jobs : {3, 11}) {
        ExecutionOptions options;
        options.jobs = jobs; // with eleven threads each has one chain, which is run without lanes
        expect_same(alone, many.run(options));
    }
}

TEST(Plan, AChainCarriesItsStatesAlong) {
    Setting carried(1, 4, true), fresh(1, 4, false);
    const auto with = carried.run({}), without = fresh.run({});
    EXPECT_EQ(with.at(0).state, without.at(0).state);
    EXPECT_NE(with.at(1).state, without.at(1).state);
}

TEST(Plan, ExecutionResumesAnywhere) {
    Setting setting(2, 3, true);
    const auto whole = setting.run({});
    for (std::size_t done = 0; done <= 3; ++done) {
        KnownChains known;
        if (done == 3) {
            known.end({1, 2});
        } else if (done > 0) {
            const PointResult& last = whole.at(3 + done - 1);
            known.begin(1, {done, can_be_carried_on(last), last.state, last.mode});
        }
        auto rest = setting.run({}, known);
        EXPECT_EQ(rest.size(), 6 - done);
        for (std::size_t point = 3; point < 3 + done; ++point)
            rest[point] = whole.at(point);
        expect_same(whole, rest);
    }
}

TEST(Plan, ExecutionStopsOnRequestAndPassesErrorsOn) {
    Setting setting(8, 3, true);
    ExecutionOptions options;
    options.jobs = 2;
    std::atomic<std::size_t> count{0};
    options.interrupted = [&] { return count > 5; };
    EXPECT_FALSE(execute(setting.plan, *setting.searches, {}, options,
                         [&](std::size_t, const PointStart&, PointResult&) { ++count; }));
    EXPECT_LT(count, 24u);
    EXPECT_THROW(execute(setting.plan, *setting.searches, {}, {.jobs = 2},
                         [](std::size_t, const PointStart&, PointResult&) { throw std::runtime_error("full"); }),
                 std::runtime_error);
}

/// A forced oscillator in front of a wall whose position is the parameter.
Model walled(double start) {
    return testing::OneMode{.parameters = "wall = 1",
                            .states = fmt::format("x = {}\nv = 0", start),
                            .rates = "x = 'v', v = '-x - 0.4*v + 2*cos(theta)'",
                            .clock = "1.3",
                            .stops = {{"stop", "wall - x", "v = '-0.5*v'"}},
                            .more = testing::at_phase(2.5, "s")}
        .model();
}

TEST(Plan, AChainContinuesWhereACarriedStateIsInadmissible) {
    // The wall moves by more than the distance of the oscillator from it.
    for (const double start : {-3.0, 0.0}) {
        const Model model = walled(start);
        const auto searches = attractor_searches(System(model), {.section = "s"}, {}, {}, {});
        Plan plan;
        plan.chain_length = 6;
        plan.carry = true;
        plan.start = [&](std::size_t point) {
            return PointStart{{2 - 0.5 * static_cast<double>(point)}, model.initial_state(), model.initial_mode};
        };
        std::size_t anew = 0, points = 0;
        const auto keep = [&](std::size_t point, const PointStart& begun, PointResult& result) {
            ++points;
            EXPECT_TRUE(can_be_carried_on(result)) << point << " " << result.outcome.detail;
            EXPECT_LE(begun.state[0], begun.parameters[0] + 1e-12);
            anew += result.outcome.detail.starts_with("began anew") ? 1 : 0;
            EXPECT_LE(result.state[0], begun.parameters[0] + 1e-12);
        };
        EXPECT_TRUE(execute(plan, *searches, {}, {}, keep));
        EXPECT_EQ(points, 6u);
        EXPECT_GE(anew, 1u);
    }
    // An initial state that was not carried along is used unchanged.
    const Model model = walled(2);
    const auto searches = attractor_searches(System(model), {.section = "s"}, {}, {}, {});
    Plan plan;
    plan.start = [&](std::size_t) { return PointStart{{1}, model.initial_state(), model.initial_mode}; };
    EXPECT_TRUE(execute(plan, *searches, {}, {}, [&](std::size_t, const PointStart&, PointResult& result) {
        EXPECT_EQ(result.label, Label::failed);
    }));
}

} // namespace graze::plan_test
