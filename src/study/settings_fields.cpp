#include "study/settings_fields.hpp"

#include "base/read_whole.hpp"

#include <algorithm>

namespace graze {

void SettingsReader::fail(std::string_view name, const std::string& wanted) const {
    throw InputError(*place_, fmt::format("the stored settings cannot be read: '{}' is not {}", name, wanted),
                     "the result file has been changed or damaged: ask for another copy, or run the study again");
}

const std::vector<Json>& SettingsReader::items_of(std::string_view name, const Json& json) const {
    if (json.kind != Json::Kind::list)
        fail(name, "a list");
    return json.items;
}

std::size_t SettingsReader::index_among(std::string_view name, const std::string& text,
                                        const std::vector<std::string>& names) const {
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end())
        fail(name, fmt::format("a name that is known, but '{}'", text));
    return static_cast<std::size_t>(found - names.begin());
}

Expression SettingsReader::parsed(const std::string& text) const {
    if (!model_)
        fail(text, "something that can stand here");
    return named_value(*model_, text, *place_).value;
}

void SettingsReader::expression(std::string_view name, Expression& value) const {
    std::string text;
    field(name, text);
    value = parsed(text);
}

void SettingsReader::expressions(std::string_view name, std::vector<Expression>& values) const {
    std::vector<std::string> texts;
    field(name, texts);
    values.clear();
    for (const std::string& text : texts)
        values.push_back(parsed(text));
}

void SettingsReader::read(std::string_view name, const Json& json, double& value) const {
    if (json.kind == Json::Kind::nothing)
        value = std::numeric_limits<double>::quiet_NaN();
    else if (json.kind == Json::Kind::text && (json.text == "inf" || json.text == "-inf"))
        value = json.text == "inf" ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity();
    else if (json.kind != Json::Kind::number || !read_whole(json.text, value))
        fail(name, "a number");
}

void SettingsReader::read(std::string_view name, const Json& json, bool& value) const {
    if (json.kind != Json::Kind::truth)
        fail(name, "true or false");
    value = json.truth;
}

void SettingsReader::read(std::string_view name, const Json& json, std::string& value) const {
    if (json.kind != Json::Kind::text)
        fail(name, "a text");
    value = json.text;
}

void SettingsReader::read(std::string_view name, const Json& json, std::uint64_t& value) const {
    if (json.kind != Json::Kind::number || !read_whole(json.text, value))
        fail(name, "a whole number");
}

void SettingsReader::read(std::string_view name, const Json& json, int& value) const {
    if (json.kind != Json::Kind::number || !read_whole(json.text, value))
        fail(name, "a whole number");
}

void SettingsReader::read(std::string_view name, const Json& json, std::pair<double, double>& range) const {
    std::vector<double> ends;
    read(name, json, ends);
    if (ends.size() != 2)
        fail(name, "two numbers");
    range = {ends[0], ends[1]};
}

} // namespace graze
