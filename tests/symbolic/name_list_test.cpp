#include "graze/symbolic/name_list.hpp"

#include <gtest/gtest.h>

namespace graze::testing {

TEST(NameList, TellsAllOfAFewAndTheNearestOfMany) {
    EXPECT_EQ(name_list({}), "");
    EXPECT_EQ(name_list({"q", "v"}, "x"), "q, v");
    std::vector<std::string> names;
    for (int i = 0; i < 397; ++i)
        names.push_back("column" + std::to_string(i));
    names.emplace_back("pressure_7");
    EXPECT_EQ(name_list(names, "", 2), "column0, column1 and 396 more");
    EXPECT_EQ(name_list(names, "pressure", 1), "pressure_7 and 397 more"); // it is a part of that name
    EXPECT_TRUE(name_list(names, "column3X", 3).starts_with("column3"));
    EXPECT_LT(name_list(names, "nothing like it").size(), 200U);
}

} // namespace graze::testing
