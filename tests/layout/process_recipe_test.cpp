#include "graze/layout/process_recipe.hpp"

#include <gmock/gmock.h>

namespace graze::process_recipe_test {

using ::testing::HasSubstr;

TEST(ProcessRecipe, HasTheNumbersOfAppendixD) {
    const std::string text = recipe_text(load_device_file("mems-switch-device"));
    EXPECT_THAT(text, HasSubstr("polished on both sides, 300 um thick"));
    EXPECT_THAT(text, HasSubstr("Etch 50 um deep (reactive ions, about 6 min)"));
    EXPECT_THAT(text, HasSubstr("Spin 3 um of SU-8"));
    EXPECT_THAT(text, HasSubstr("polished on one side, 500 um thick"));
    EXPECT_THAT(text, HasSubstr("Etch 250 um over the chambers, 300 um beside them (about 38 min)"));
}

TEST(ProcessRecipe, FollowsTheDesign) {
    const std::string text =
        recipe_text(load_device_file("mems-switch-device", {{"chamber_depth", 100}, {"bias", 0.5}}));
    EXPECT_THAT(text, HasSubstr("Etch 100 um deep (reactive ions, about 12 min)"));
    EXPECT_THAT(text, HasSubstr("recedes by 0.5 um"));
}

} // namespace graze::process_recipe_test
