#pragma once

#include "graze/base/input_error.hpp"

#include <string>

namespace graze::testing {

/// The message with which something is refused; empty if it is not.
template <class Work>
std::string message_of(const Work& work) {
    try {
        work();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

} // namespace graze::testing
