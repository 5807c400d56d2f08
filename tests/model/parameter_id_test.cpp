#include "graze/model/parameter_id.hpp"

#include "graze/model/model.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <type_traits>
#include <utility>

namespace graze::parameter_id_test {

// No index converts to a parameter implicitly, not even in braces.
static_assert(!std::is_convertible_v<std::size_t, ParameterId> && !std::is_convertible_v<int, ParameterId>);
static_assert(!std::is_assignable_v<ParameterId&, std::size_t>);
static_assert(!std::is_convertible_v<ParameterId, std::size_t>);
static_assert(!std::is_assignable_v<ParameterId&, decltype(*std::declval<const Model&>().find_parameter(""))>);
static_assert(std::is_same_v<decltype(std::declval<const Model&>().independent_parameter("")), ParameterId>);

TEST(ParameterId, IsTheIndexAmongTheIndependentParameters) {
    Model model;
    model.parameters.push_back({"area", "", "", {}, model.symbol("width") * model.symbol("width")});
    model.parameters.push_back({"width", "", "", 2.0, {}});
    model.parameters.push_back({"mass", "", "", 3.0, {}});
    const ParameterId mass = model.independent_parameter("mass");
    EXPECT_EQ(model.parameter_values()[mass.place()], 3);
    EXPECT_EQ(model.independent_parameters()[mass.place()], "mass");
    EXPECT_NE(mass.place(), model.find_parameter("mass")); // that index counts the dependent area too
    EXPECT_EQ(model.find_independent_parameter("area"), std::nullopt);
    EXPECT_EQ(mass, ParameterId(1));
    EXPECT_LT(model.independent_parameter("width"), mass);
    EXPECT_EQ(ParameterId(), model.independent_parameter("width"));
}

} // namespace graze::parameter_id_test
