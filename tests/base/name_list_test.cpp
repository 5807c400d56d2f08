#include "graze/base/name_list.hpp"

#include <gtest/gtest.h>

namespace graze::testing::name_list_test {

TEST(NameList, ShowsAllOfAFewNamesAndTheNearestOfMany) {
    EXPECT_EQ(name_list({}), "");
    EXPECT_EQ(name_list({"q", "v"}, "x"), "q, v");
    std::vector<std::string> names;
    for (int i = 0; i < 397; ++i)
        names.push_back("column" + std::to_string(i));
    names.emplace_back("pressure_7");
    EXPECT_EQ(name_list(names, "", 2), "column0, column1 and 396 more");
    EXPECT_EQ(name_list(names, "pressure", 1), "pressure_7 and 397 more"); // a part of that name
    EXPECT_TRUE(name_list(names, "column3X", 3).starts_with("column3"));
    EXPECT_LT(name_list(names, "nothing like it").size(), 200U);
}

TEST(NameList, FindsTheNearestName) {
    const std::vector<std::string> names{"amplitude", "omega", "V0", "x", "x_dot"};
    EXPECT_EQ(nearest_name("amplitud", names), "amplitude");
    EXPECT_EQ(nearest_name("omgea", names), "omega") << "exchanged letters are one mistake";
    EXPECT_EQ(nearest_name("Omega", names), "omega");
    EXPECT_EQ(nearest_name("xdot", names), "x_dot");
    EXPECT_EQ(nearest_name("X", names), "x");
    EXPECT_EQ(nearest_name("z", names), "");
    EXPECT_EQ(nearest_name("velocity", names), "");
    EXPECT_EQ(nearest_name("x", {}), "");
    EXPECT_EQ(nearest_name(std::string(100000, 'a'), names), "");
}

} // namespace graze::testing::name_list_test
