#pragma once

#include "graze/base/input_error.hpp"

#include <string>

namespace graze {

/// Does some work: an InputError that has no file for a place gets this place.
/// @param about begins its problem then, such as "run 'a': "
/// @return what the work returns
template <class Work>
auto with_place(const Place& place, const Work& work, const std::string& about = {}) {
    try {
        return work();
    } catch (const InputError& error) {
        if (!error.place().file.empty())
            throw;
        throw InputError(place, about + error.problem(), error.remedy());
    }
}

} // namespace graze
