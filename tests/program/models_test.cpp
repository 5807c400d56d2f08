#include "run_graze.hpp"

#include <gmock/gmock.h>

namespace graze::testing::models_test {

using ::testing::HasSubstr;

TEST(Models, ListsDescribesShowsAndWrites) {
    const std::string list = done("models");
    EXPECT_THAT(list, HasSubstr("mems-switch"));
    EXPECT_THAT(list, HasSubstr("microbeam"));
    EXPECT_THAT(run_graze("models mems-switch").out, HasSubstr("level of the square wave"));
    const std::string shown = run_graze("models mems-switch --show").out;
    EXPECT_THAT(shown, HasSubstr("[modes.on]"));
    const Folder folder;
    done("models mems-switch --write " + (folder / "mine.toml"));
    EXPECT_EQ(contents(folder / "mine.toml"), shown);
    done("check " + (folder / "mine.toml"));
}

TEST(Models, WritesMembersOfTheBeamFamily) {
    const Folder folder;
    const std::string file = folder / "beam.toml";
    done("models microbeam --beam-modes 3 --quadrature gauss --points 12 --write " + file);
    const std::string check = done("check " + file);
    EXPECT_THAT(check, HasSubstr("7 states"));
    EXPECT_THAT(check, HasSubstr("Gauss's rule with 12 nodes"));
}

} // namespace graze::testing::models_test
