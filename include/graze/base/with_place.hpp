#pragma once

#include "graze/base/input_error.hpp"

#include <string>

namespace graze {

/// Calls `work()` and gives this place to any InputError that names no file.
/// @param about is then put before the error's problem, such as "run 'a': "
/// @return what `work` returns
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
