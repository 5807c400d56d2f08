#pragma once

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace graze {

/// Refuses what another version has written: the same work might lead to other numbers.
/// @param what it is, such as "part of a run"
inline void require_same_version(const std::string& version, std::string_view what) {
    if (version != GRAZE_VERSION)
        throw InputError(Place{std::string(what), 0, 0},
                         fmt::format("a {} of graze {} cannot be computed by graze {}", what, version, GRAZE_VERSION),
                         "install the same version everywhere");
}

} // namespace graze
