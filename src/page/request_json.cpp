#include "page/request_json.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/printable.hpp"
#include "graze/results/name_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

namespace graze {

namespace {

constexpr int deepest_request = 32;

[[noreturn]] void refuse_member(const char* name, std::string_view what) {
    throw InputError(fmt::format("'{}' of the request is no {}", name, what), "docs/page-interface.md describes it");
}

/// The member; null if it is missing.
const nlohmann::json* member_of(const nlohmann::json& request, const char* name) {
    const auto found = request.find(name);
    return found == request.end() || found->is_null() ? nullptr : &*found;
}

const nlohmann::json& needed_member(const nlohmann::json& request, const char* name) {
    const nlohmann::json* found = member_of(request, name);
    if (found == nullptr)
        throw InputError(fmt::format("the request has no '{}'", name), "docs/page-interface.md describes it");
    return *found;
}

std::string shown_member(const std::string& name) {
    return printable_line(shortened(name, 100));
}

std::string text_of(const nlohmann::json& value, const char* name) {
    if (!value.is_string())
        refuse_member(name, "text");
    return value.get<std::string>();
}

/// What a reader of JSON says, without the name that it gives the mistake.
std::string words_of(const nlohmann::json::exception& error) {
    const std::string text = error.what();
    const auto end = text.starts_with('[') ? text.find("] ") : std::string::npos;
    return end == std::string::npos ? text : text.substr(end + 2);
}

} // namespace

nlohmann::json request_json(std::string_view body) {
    nlohmann::json request;
    try {
        std::vector<std::set<std::string>> members; // of the objects and lists in which the reader is
        request = nlohmann::json::parse(body, [&](int depth, nlohmann::json::parse_event_t event,
                                                  const nlohmann::json& value) {
            if (depth > deepest_request)
                throw InputError("the request is nested too deep", "docs/page-interface.md describes it");
            members.resize(static_cast<std::size_t>(depth) + 1);
            if (event == nlohmann::json::parse_event_t::key && !members.back().insert(value.get<std::string>()).second)
                throw InputError(fmt::format("the request has '{}' twice", shown_member(value.get<std::string>())),
                                 "give it once");
            return true;
        });
    } catch (const nlohmann::json::exception& error) {
        throw InputError("the request is no JSON: " + printable_line(shortened(words_of(error), 300)),
                         "send one object in UTF-8");
    }
    if (!request.is_object())
        throw InputError("the request is no object in JSON", "docs/page-interface.md describes it");
    return request;
}

void require_known(const std::string& name, const std::vector<std::string>& known, const char* what) {
    if (std::ranges::find(known, name) == known.end())
        throw InputError(fmt::format("the request has an unknown {} '{}'", what, shown_member(name)),
                         name_advice(name, known, "leave it out"));
}

void require_known_members(const nlohmann::json& object, const std::vector<std::string>& known) {
    for (const auto& [name, value] : object.items())
        require_known(name, known, "member");
}

std::string text_member(const nlohmann::json& request, const char* name) {
    return text_of(needed_member(request, name), name);
}

std::string text_member(const nlohmann::json& request, const char* name, const std::string& otherwise) {
    const nlohmann::json* found = member_of(request, name);
    return found == nullptr ? otherwise : text_of(*found, name);
}

bool flag_member(const nlohmann::json& request, const char* name, bool otherwise) {
    const nlohmann::json* found = member_of(request, name);
    if (found != nullptr && !found->is_boolean())
        refuse_member(name, "true or false");
    return found == nullptr ? otherwise : found->get<bool>();
}

double number_member(const nlohmann::json& request, const char* name) {
    const nlohmann::json& value = needed_member(request, name);
    if (!value.is_number())
        refuse_member(name, "number");
    return value.get<double>();
}

std::size_t count_member(const nlohmann::json& request, const char* name) {
    const nlohmann::json& value = needed_member(request, name);
    if (!value.is_number_unsigned())
        refuse_member(name, "whole number");
    return value.get<std::size_t>();
}

std::vector<std::string> texts_member(const nlohmann::json& request, const char* name) {
    const nlohmann::json* found = member_of(request, name);
    std::vector<std::string> texts;
    if (found == nullptr)
        return texts;
    if (!found->is_array())
        refuse_member(name, "list of texts");
    for (const nlohmann::json& one : *found)
        texts.push_back(text_of(one, name));
    return texts;
}

nlohmann::json object_member(const nlohmann::json& request, const char* name) {
    const nlohmann::json* found = member_of(request, name);
    if (found != nullptr && !found->is_object())
        refuse_member(name, "object");
    return found == nullptr ? nlohmann::json::object() : *found;
}

std::size_t count_of(const std::string& text, const char* name) {
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error != std::errc() || end != text.data() + text.size())
        refuse_member(name, "whole number");
    return count;
}

} // namespace graze
