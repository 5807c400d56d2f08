// Tables of what an atlas has found.

#include "graze/atlas/atlas_tables.hpp"

#include "atlas/truth_atlas.hpp"
#include "base/message_of.hpp"

#include <gmock/gmock.h>

namespace graze::atlas_tables_test {

using namespace graze::testing;

TEST(AtlasTables, HaveARowForEachThingThatWasFound) {
    AtlasResults results(flips_study("multiple = 2\n"));
    results.run();
    const AtlasFindings found = results.findings();
    EXPECT_EQ(atlas_table(found, "curves").rows(), found.curves.size());
    EXPECT_EQ(atlas_table(found, "points").rows(), found.points.size());
    EXPECT_EQ(atlas_table(found, "branches").rows(), found.branches.size());
    EXPECT_EQ(atlas_table(found, "motions").rows(), found.motions.size());
    EXPECT_EQ(atlas_table(found, "left").rows(), found.remainders.size());
    EXPECT_EQ(curves_and_points(found).rows(), found.curves.size() + found.points.size());
    for (const std::string& name : atlas_table_names())
        EXPECT_FALSE(atlas_table(found, name).columns().empty()) << name;
    EXPECT_FALSE(message_of([&] { atlas_table(found, "other"); }).empty());
}

TEST(AtlasTables, TellTheTypesOfAPointInWords) {
    AtlasPoint point;
    point.types = {PointType::fold, PointType::grazing};
    EXPECT_EQ(words_of(point), "fold and grazing");
}

TEST(AtlasTables, KnowWhichAtlasHasMadeARun) {
    AtlasResults results(flips_study("multiple = 2\n"));
    results.run();
    EXPECT_EQ(atlas_that_made(results.study, "map.branch1"), results.study.find_run("map"));
    EXPECT_EQ(atlas_that_made(results.study, "map"), nullptr);
}

} // namespace graze::atlas_tables_test
