#include "graze/model/named_value.hpp"

#include "trajectory/model_parts.hpp"

#include <gtest/gtest.h>

namespace graze::named_value_test {

TEST(SameExpression, HasAnyOrderOfSumsAndProducts) {
    const Model model = testing::OneMode{.parameters = "k = 2",
                                         .states = "x = 1\ny = 0",
                                         .definitions = "r = 'x*y'",
                                         .rates = "x = 'y', y = '-k*x*r'"}
                            .model();
    EXPECT_TRUE(are_same_expression(model, "x^2*y - k*y", "y*x^2 - y*k"));
    EXPECT_TRUE(are_same_expression(model, "1 + sin(x + y)", "sin(y + x) + 1"));
    EXPECT_TRUE(are_same_expression(model, "2*r", "2*(y*x)"));
    EXPECT_FALSE(are_same_expression(model, "x - y", "y - x"));
    EXPECT_FALSE(are_same_expression(model, "x^2*y", "x*y^2"));
    EXPECT_FALSE(are_same_expression(model, "up", "down"));
    EXPECT_FALSE(are_same_expression(model, "x", ""));
}

} // namespace graze::named_value_test
