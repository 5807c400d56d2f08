#include "page/special_points_json.hpp"

#include "graze/results/stored_orbit.hpp"
#include "page/page_results.hpp"

namespace graze {
namespace {

class SpecialPointsJson : public testing::PageResults {};

TEST_F(SpecialPointsJson, AreThoseOfTheFile) {
    const nlohmann::json json = special_points_json(file(), "chain");
    const std::vector<OrbitRecord> orbits = file().orbits("chain", true);
    const StoredRun run(file(), "chain", {});
    ASSERT_EQ(json["rows"].size(), orbits.size());
    ASSERT_GT(orbits.size(), 2U);
    EXPECT_EQ(json["columns"].size(), run.record.coordinates.size() + run.record.values.size());
    EXPECT_EQ(json["columns"][0]["name"], "omega");
    for (std::size_t i = 0; i < orbits.size(); ++i) {
        const nlohmann::json& row = json["rows"][i];
        EXPECT_EQ(row["number"], orbits[i].number);
        EXPECT_EQ(row["label"], orbits[i].label);
        EXPECT_EQ(row["type"], short_name(orbits[i].point.type));
        EXPECT_EQ(row["type_words"], name_of(orbits[i].point.type));
        EXPECT_EQ(row["stable"], orbits[i].stable);
        EXPECT_EQ(row["coordinates"].size(), json["columns"].size());
        EXPECT_EQ(row["coordinates"][0], orbits[i].point.parameter);
        EXPECT_EQ(row["coordinates"].back(), orbits[i].point.monitors.back());
    }
}

TEST_F(SpecialPointsJson, AreNotOfOtherRuns) {
    EXPECT_TRUE(special_points_json(file(), "sweep")["rows"].empty());
    EXPECT_THROW(special_points_json(file(), "<script>"), InputError);
}

} // namespace
} // namespace graze
