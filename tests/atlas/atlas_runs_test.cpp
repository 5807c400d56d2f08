// What an atlas reads of its results.

#include "atlas/atlas_runs.hpp"

#include "atlas/truth_atlas.hpp"
#include "graze/model/catalogue.hpp"

#include <algorithm>

namespace graze::atlas_runs_test {

using namespace graze::testing;

TEST(AtlasRuns, AreKnownByTheirNames) {
    EXPECT_TRUE(is_made_by("map.branch1", "map"));
    EXPECT_TRUE(is_made_by("map.x.y", "map"));
    EXPECT_FALSE(is_made_by("map", "map"));
    EXPECT_FALSE(is_made_by("map.", "map"));
    EXPECT_FALSE(is_made_by("mapper.branch1", "map"));
    EXPECT_FALSE(is_made_by("other.branch1", "map"));
}

TEST(AtlasRuns, ReadsPeriodsContactsRowsAndTypes) {
    AtlasResults results(line_study());
    results.run();
    const AtlasRuns runs = read_atlas(results.study, *results.study.find_run("map"), results.file);
    EXPECT_EQ(runs.rows.size(), 5U);
    EXPECT_NEAR(runs.scales.at[0], 1.2, 1e-15);
    EXPECT_EQ(runs.range(1), std::pair(0.5, 8.0));
    ASSERT_FALSE(runs.branches.empty());
    for (const FollowedRun& one : runs.branches) {
        EXPECT_EQ(one.multiple, 1U);
        ASSERT_TRUE(one.row);
        for (const FollowedOrbit& orbit : one.orbits) {
            EXPECT_NEAR(orbit.mark.at[1], runs.rows[*one.row], 1e-12);
            // A contact of no speed, with which a contact begins, does not count.
            const bool touches = orbit.type == PointType::grazing && orbit.at_end;
            EXPECT_EQ(orbit.contacts, orbit.signature == "impact" && !touches ? 1U : 0U) << orbit.signature;
        }
    }
    ASSERT_FALSE(runs.curves.empty());
    for (const FollowedRun& one : runs.curves)
        for (const FollowedOrbit& orbit : one.orbits)
            if (!orbit.is_special()) {
                EXPECT_EQ(orbit.contacts, one.kept == PointType::grazing ? 0U : 1U) << one.name();
            }
    EXPECT_EQ(runs.find("map.branch1"), runs.branches.data());
    EXPECT_EQ(runs.find("map.branch99"), nullptr);
}

/// Labels may contain blanks, colons and powers, and the label of another transition.
TEST(AtlasRuns, CountsContactsOfAnyLabel) {
    Model model = load_model(truth_model("impact-line"));
    for (Transition& one : model.transitions)
        one.label = one.label == "impact" ? "free: the stop^2 b" : "free: the";
    const auto contacts = [](const AtlasResults& results) {
        std::vector<std::size_t> counts;
        for (const SampledMotion& one : read_atlas(results.study, *results.study.find_run("map"), results.file).samples)
            counts.push_back(one.contacts + (one.accumulates ? 1000 : 0));
        return counts;
    };
    const std::string text = line_study(), named = text.substr(0, text.find("model =")) + "model = \"labelled\"\n" +
                                                   text.substr(text.find("[runs.map]"));
    AtlasResults plain(text), labelled(named, {{"labelled", model}});
    for (AtlasResults* one : {&plain, &labelled})
        run_study(one->study, one->file, {});
    const std::vector<std::size_t> counts = contacts(plain);
    EXPECT_GT(std::ranges::count(counts, 1U), 20);
    EXPECT_GT(std::ranges::max(counts), 1000U);
    EXPECT_EQ(contacts(labelled), counts);
}

} // namespace graze::atlas_runs_test
