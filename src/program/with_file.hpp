#pragma once

#include "graze/base/input_error.hpp"

#include <string>

namespace graze {

/// Does some work on a file: what goes wrong with it names the file, wherever it was noticed.
template <class Work>
void with_file(const std::string& file, const Work& work) {
    try {
        work();
    } catch (const InputError& error) {
        if (!error.place().file.empty())
            throw;
        throw InputError(Place{file, 0, 0}, error.problem(), error.remedy());
    }
}

} // namespace graze
