#pragma once

#include "graze/base/error.hpp"

#include <string>
#include <utility>

namespace graze {

/// What was given cannot be used: of kind `input`, or `file`.
class InputError : public Error {
public:
    /// @param problem what is wrong
    /// @param remedy  what to do about it (may be empty)
    InputError(Place place, const std::string& problem, const std::string& remedy)
        : Error(ErrorKind::input, std::move(place), problem, remedy) {}
    /// Without a place, as for values given from C++ or on a command line.
    InputError(const std::string& problem, const std::string& remedy) : InputError(Place{}, problem, remedy) {}

protected:
    using Error::Error;
};

/// A file cannot be opened, read or written, or somebody else uses it.
class FileError : public InputError {
public:
    /// @param path the place
    FileError(std::string path, const std::string& problem, const std::string& remedy)
        : InputError(ErrorKind::file, {std::move(path), 0, 0}, problem, remedy) {}
};

} // namespace graze
