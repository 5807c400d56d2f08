#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Text of a JSON object, written member by member in the order of the calls.
class JsonObject {
public:
    void add(std::string_view name, std::string_view text);
    void add(std::string_view name, double number);
    void add(std::string_view name, const JsonObject& object);
    void add(std::string_view name, const std::vector<JsonObject>& objects);
    /// Text of the members, without the braces around them.
    const std::string& members() const { return members_; }

private:
    void put(std::string_view name, const std::string& value);
    std::string members_;
};

} // namespace graze
