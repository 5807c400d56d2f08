#include "graze/results/orbit_motion.hpp"

#include "graze/branch/switching.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/study_catalogue.hpp"
#include "graze/symbolic/function.hpp"

#include "study_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace graze::orbit_motion_test {

/// Runs of orbits that lead back to no sweep, which would take long; of small models, or of large ones. Of the long
/// curves only those of folds and flips.
std::vector<std::string> branches_alone(const Study& study, bool large) {
    constexpr std::size_t most_states_of_small = 10;
    std::set<std::string> chosen;
    for (const StudyRun& run : study.runs)
        if (run.is_branch() && !run.name.starts_with("touches") &&
            (run.model.states.size() > most_states_of_small) == large &&
            (!run.start || chosen.contains(run.start->run)))
            chosen.insert(run.name);
    return {chosen.begin(), chosen.end()};
}

/// By how much two states differ, relative to their size; whole periods do not count, nor does what drifts.
double distance(const Model& model, const std::vector<double>& one, const std::vector<double>& other,
                const std::vector<double>& sizes) {
    const std::vector<double> period = model.periods();
    double result = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        if (model.states[i].drifting)
            continue;
        double difference = one[i] - other[i];
        if (period[i] > 0)
            difference = std::remainder(difference, period[i]);
        result = std::max(result, std::abs(difference) / (period[i] > 0 ? period[i] : sizes[i]));
    }
    return result;
}

/// The state after what ends a segment.
std::vector<double> after_end(const Model& model, const Segment& segment, const std::vector<double>& state) {
    if (segment.end == SegmentEnd::section)
        return state;
    std::vector<double> values = state;
    for (const double value : model.parameter_values())
        values.push_back(value);
    return System(model).jump(model.transitions[segment.index].jump).map(values);
}

void expect_closed(const Model& model, const OrbitRecord& record, const std::string& name) {
    const Orbit& stored = record.point.solution.orbit;
    const Orbit whole = whole_orbit(System(model), stored);
    const Model there = model_at(model, whole);
    const auto motion = orbit_motion(model, whole, 50);
    ASSERT_EQ(motion.size(), whole.segments()) << name;
    EXPECT_NEAR(whole.period(), stored.period(), 1e-12 * stored.period()) << name;
    std::vector<double> sizes(model.states.size(), 1e-300);
    for (const SegmentMotion& segment : motion)
        for (const auto& state : segment.states)
            for (std::size_t i = 0; i < state.size(); ++i)
                sizes[i] = std::max(sizes[i], std::abs(state[i]));
    // Where a contact has no speed, what it would give to another body is round-off.
    constexpr double least_share = 1e-5;
    const double largest = *std::max_element(sizes.begin(), sizes.end());
    for (double& size : sizes)
        size = std::max(size, least_share * largest);
    // A phase is brought within its period, which may round.
    EXPECT_LT(distance(there, motion.front().states.front(), stored.starts.front(), sizes), 1e-15) << name;
    // Newton's last correction is 1e-10; along unstable orbits errors of the start grow by the multiplier.
    double growth = 1;
    for (const auto& multiplier : record.point.solution.multipliers)
        growth = std::isfinite(std::abs(multiplier)) ? std::max(growth, std::abs(multiplier)) : growth;
    for (std::size_t s = 0; s < motion.size(); ++s) {
        EXPECT_EQ(motion[s].problem, "") << name;
        const std::vector<double> next = after_end(there, whole.signature[s], motion[s].states.back());
        EXPECT_LT(distance(there, next, whole.starts[(s + 1) % motion.size()], sizes), 1e-9 * growth)
            << name << ", segment " << s + 1 << " of " << motion.size();
    }
}

struct Counts {
    std::size_t orbits = 0, halves = 0;
};

Counts expect_all_closed(bool large) {
    Counts counts;
    for (const std::string& name : shipped_studies()) {
        testing::StudyResults results(name);
        const std::vector<std::string> chosen = branches_alone(results.study, large);
        if (chosen.empty())
            continue;
        results.run(chosen);
        for (const StudyRun& run : results.study.runs) {
            if (!std::ranges::binary_search(chosen, run.name)) // sorted
                continue;
            for (const OrbitRecord& record : results.file().orbits(run.name, true)) {
                EXPECT_LT(record.point.solution.residual, 1e-6) << name << run.name << record.label;
                // Where contacts accumulate, what is kept ends before the last of them.
                const bool whole = record.point.type != PointType::chatter && run.name != "onset";
                if (record.point.solution.outcome != OrbitOutcome::converged || !whole)
                    continue;
                expect_closed(run.model, record, name + ", " + run.name + ':' + record.label);
                ++counts.orbits;
                counts.halves += record.point.solution.orbit.symmetry ? 1 : 0;
            }
        }
    }
    return counts;
}

TEST(OrbitMotion, OfAllShippedStudiesStartsAtTheStoredStateAndCloses) {
    const Counts counts = expect_all_closed(false);
    EXPECT_GT(counts.orbits, 50u);
    EXPECT_GT(counts.halves, 5u);
}

TEST(OrbitMotionSlow, OfLargeModelsStartsAtTheStoredStateAndCloses) {
    EXPECT_GT(expect_all_closed(true).orbits, 8u);
}

/// As a damaged file may have it.
TEST(OrbitMotion, OfASegmentWithoutEndIsInterrupted) {
    Model model = load_model("impact-oscillator");
    for (const auto& [name, value] : {std::pair{"sigma", 0.5}, {"omega", 1.2}, {"amplitude", 0.1}})
        model.set_parameter(name, value);
    AttractorOptions options;
    options.section = "phase0";
    const Orbit orbit = find_orbit(System(model), options).orbit;
    ASSERT_EQ(orbit_motion(model, orbit, 10).front().problem, "");
    for (const double duration : {1e300, -1e300, 1e12, std::numeric_limits<double>::infinity(),
                                  -std::numeric_limits<double>::infinity(), std::nan("")}) {
        Orbit endless = orbit;
        endless.durations.front() = duration;
        endless.signature.push_back(endless.signature.front());
        endless.starts.push_back(endless.starts.front());
        endless.durations.push_back(1e200);
        const std::vector<SegmentMotion> motion = orbit_motion(model, endless, 10);
        ASSERT_EQ(motion.size(), 2U);
        EXPECT_NE(motion[0].problem, "") << duration;
        EXPECT_NE(motion[1].problem, "") << duration;
        EXPECT_LE(motion[0].times.size() + motion[1].times.size(), 30U) << duration;
    }
}

} // namespace graze::orbit_motion_test
