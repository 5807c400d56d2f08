#include "run_graze.hpp"

#include <gmock/gmock.h>

namespace graze::testing {

using ::testing::HasSubstr;

TEST(Models, ListsDescribesShowsAndWrites) {
    const Printed list = run_graze("models");
    EXPECT_EQ(list.code, 0);
    EXPECT_THAT(list.out, HasSubstr("mems-switch"));
    EXPECT_THAT(list.out, HasSubstr("microbeam"));
    EXPECT_THAT(run_graze("models mems-switch").out, HasSubstr("level of the square wave"));
    const std::string shown = run_graze("models mems-switch --show").out;
    EXPECT_THAT(shown, HasSubstr("[modes.on]"));
    const Folder folder;
    EXPECT_EQ(run_graze("models mems-switch --write " + (folder / "mine.toml")).code, 0);
    EXPECT_EQ(contents(folder / "mine.toml"), shown);
    EXPECT_EQ(run_graze("check " + (folder / "mine.toml")).code, 0);
}

TEST(Models, WritesMembersOfTheBeamFamily) {
    const Folder folder;
    const std::string file = folder / "beam.toml";
    EXPECT_EQ(run_graze("models microbeam --beam-modes 3 --quadrature gauss --points 12 --write " + file).code, 0);
    const Printed check = run_graze("check " + file);
    EXPECT_EQ(check.code, 0) << check.err;
    EXPECT_THAT(check.out, HasSubstr("7 states"));
    EXPECT_THAT(check.out, HasSubstr("Gauss's rule with 12 nodes"));
}

} // namespace graze::testing
