#pragma once

#include "graze/base/input_error.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A value of JSON, as it stands in a text.
struct Json {
    enum class Kind { nothing, truth, number, text, list, object };

    Kind kind = Kind::nothing;
    bool truth = false;
    std::string text;               ///< of texts; of numbers their digits, for none to be lost
    std::vector<Json> items;        ///< of lists; of objects the members,
    std::vector<std::string> names; ///< and what they are called

    /// The member of that name, or null.
    const Json* find(std::string_view name) const;
};

/// @param place for messages
/// @throws InputError when the text is no JSON, or nested deeper than anything that graze writes
Json parse_json(std::string_view text, const Place& place);

} // namespace graze
