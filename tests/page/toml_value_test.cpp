#include "page/toml_value.hpp"

#include "graze/base/input_error.hpp"

#include <gtest/gtest.h>

namespace graze {
namespace {

TEST(TomlValue, WritesAllTypes) {
    const auto written = [](const char* json) { return toml_value(nlohmann::json::parse(json)); };
    EXPECT_EQ(written("3"), "3");
    EXPECT_EQ(written("0.5"), "0.5");
    EXPECT_EQ(written("true"), "true");
    EXPECT_EQ(written(R"("a\"b\\\n")"), R"("a\"b\\\n")");
    EXPECT_EQ(written("[1, [2], \"x\"]"), R"([1, [2], "x"])");
    EXPECT_EQ(written(R"({"a": 1, "b.c": {"d": []}})"), R"({ "a" = 1, "b.c" = { "d" = [] } })");
    EXPECT_THROW(written("null"), InputError);
    EXPECT_THROW(written("[null]"), InputError);
}

TEST(TomlLines, LeavesOutNull) {
    EXPECT_EQ(toml_lines(nlohmann::json::parse(R"({"run": "a", "x": null, "y": ["v"]})")),
              "\"run\" = \"a\"\n\"y\" = [\"v\"]\n");
}

} // namespace
} // namespace graze
