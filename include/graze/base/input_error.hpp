#pragma once

#include <stdexcept>
#include <string>

namespace graze {

/// A place in a text that a user wrote. Lines and columns count from 1; 0 means "not known".
struct Place {
    std::string file;
    int line = 0;
    int column = 0;

    /// Returns `file:line:column`, leaving out the parts that are not known.
    std::string text() const;
};

/// An error in a user's input. `what()` is one line: `file:line:col: what is wrong; what to do`.
class InputError : public std::runtime_error {
public:
    /// @param problem what is wrong
    /// @param remedy  what to do about it (may be empty)
    InputError(Place place, const std::string& problem, const std::string& remedy);
    /// Without a place, for values given from C++ or on a command line.
    InputError(const std::string& problem, const std::string& remedy);

    const Place& place() const { return place_; }
    const std::string& problem() const { return problem_; }
    const std::string& remedy() const { return remedy_; }

private:
    Place place_;
    std::string problem_;
    std::string remedy_;
};

} // namespace graze
