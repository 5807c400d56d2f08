#include "study/json.hpp"

#include "base/json_text.hpp"

#include <gtest/gtest.h>

#include <string>

namespace graze::json_test {

const Place place{"settings", 0, 0};

TEST(Json, ReadsWhatItWrites) {
    const std::string strange = "a \"quoted\" \\ text,\n\twith [brackets] and \x01";
    const Json json = parse_json("{\"t\":" + json_text(strange) + R"(, "n": [1, -2.5e-300, 18446744073709551615],
                                 "b": true, "f": false, "z": null, "o": {}, "l": []})",
                                 place);
    EXPECT_EQ(json.kind, Json::Kind::object);
    EXPECT_EQ(json.find("t")->text, strange);
    EXPECT_EQ(json.find("n")->items.at(2).text, "18446744073709551615");
    EXPECT_TRUE(json.find("b")->truth);
    EXPECT_FALSE(json.find("f")->truth);
    EXPECT_EQ(json.find("z")->kind, Json::Kind::nothing);
    EXPECT_EQ(json.find("o")->kind, Json::Kind::object);
    EXPECT_EQ(json.find("l")->kind, Json::Kind::list);
    EXPECT_EQ(json.find("none"), nullptr);
}

TEST(Json, RefusesTextsThatAreNoJson) {
    for (const char* text : {"", "{", "[1,]", "{\"a\"}", "{\"a\":}", "{a:1}", "\"open", "\"\\u00zz\"", "\"\\", "1 2",
                             "tru", "{\"a\":1,}", "\"\\u0fff\"", "[1 2]"})
        EXPECT_THROW(parse_json(text, place), InputError) << text;
    EXPECT_THROW(parse_json(std::string(1'000'000, '['), place), InputError);
}

} // namespace graze::json_test
