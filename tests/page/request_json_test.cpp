#include "page/request_json.hpp"

#include "graze/base/input_error.hpp"

#include <gtest/gtest.h>

namespace graze {
namespace {

TEST(RequestJson, ReadsAnObject) {
    const nlohmann::json request = request_json(R"({"run": "a", "number": 3, "x": 0.5, "save": true, "names": ["b"]})");
    EXPECT_EQ(text_member(request, "run"), "a");
    EXPECT_EQ(count_member(request, "number"), 3U);
    EXPECT_EQ(number_member(request, "x"), 0.5);
    EXPECT_TRUE(flag_member(request, "save", false));
    EXPECT_EQ(texts_member(request, "names"), std::vector<std::string>{"b"});
}

TEST(RequestJson, TakesMissingMembersAndNullAlike) {
    const nlohmann::json request = request_json(R"({"run": null})");
    EXPECT_EQ(text_member(request, "run", "default"), "default");
    EXPECT_EQ(text_member(request, "other", "default"), "default");
    EXPECT_TRUE(flag_member(request, "run", true));
    EXPECT_TRUE(texts_member(request, "run").empty());
    EXPECT_THROW(text_member(request, "run"), InputError);
    EXPECT_THROW(count_member(request, "number"), InputError);
}

TEST(RequestJson, RefusesOtherTypes) {
    const nlohmann::json request = request_json(R"({"a": 1, "b": "x", "c": -1, "d": 1.5, "e": [1], "f": {}})");
    EXPECT_THROW(text_member(request, "a"), InputError);
    EXPECT_THROW(text_member(request, "f", ""), InputError);
    EXPECT_THROW(count_member(request, "b"), InputError);
    EXPECT_THROW(count_member(request, "c"), InputError);
    EXPECT_THROW(count_member(request, "d"), InputError);
    EXPECT_THROW(number_member(request, "b"), InputError);
    EXPECT_THROW(texts_member(request, "e"), InputError);
    EXPECT_THROW(texts_member(request, "f"), InputError);
    EXPECT_THROW(flag_member(request, "a", false), InputError);
}

TEST(RequestJson, RefusesWhatIsNoJsonObject) {
    for (const std::string text :
         {"", "{", "{}}", "[]", "1", "{\"a\": nan}", "{\"a\": \"\xff\"}", "\xef\xbb", "{'a': 1}"})
        EXPECT_THROW(request_json(text), InputError) << text;
}

TEST(RequestJson, SaysWhatIsWrongWithoutNamesOfItsReader) {
    try {
        request_json("{\"a\": }");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(error.problem().find("parse error at line 1, column 7"), std::string::npos) << error.problem();
        EXPECT_EQ(error.problem().find("exception"), std::string::npos) << error.problem();
    }
}

TEST(RequestJson, RefusesDeepNesting) {
    const auto nested = [](int depth) { return "{\"a\":" + std::string(depth, '[') + std::string(depth, ']') + "}"; };
    EXPECT_NO_THROW(request_json(nested(30)));
    EXPECT_THROW(request_json(nested(40)), InputError);
    EXPECT_THROW(request_json("{\"a\":" + std::string(2'000'000, '[')), InputError);
    std::string objects;
    for (int i = 0; i < 500'000; ++i)
        objects += "{\"a\":";
    EXPECT_THROW(request_json(objects), InputError);
}

TEST(RequestJson, RefusesWhatIsThereTwice) {
    EXPECT_THROW(request_json(R"({"a": 1, "b": 2, "a": 1})"), InputError);
    EXPECT_THROW(request_json(R"({"a": {"b": [{"c": 1, "c": 2}]}})"), InputError);
    EXPECT_NO_THROW(request_json(R"({"a": {"a": [{"a": 1}, {"a": 2}]}, "b": {"a": 1}, "c": [{"a": 3}]})"));
}

TEST(RequestJson, RefusesUnknownMembers) {
    EXPECT_NO_THROW(require_known_members(nlohmann::json{{"a", 1}}, {"a", "b"}));
    EXPECT_THROW(require_known_members(nlohmann::json{{"a", 1}, {"c", 1}}, {"a", "b"}), InputError);
}

TEST(RequestJson, ReadsNumbersOfAddresses) {
    EXPECT_EQ(count_of("12", "number"), 12U);
    for (const char* text : {"", "-1", "1x", " 1", "1.0", "99999999999999999999999"})
        EXPECT_THROW(count_of(text, "number"), InputError) << text;
}

} // namespace
} // namespace graze
