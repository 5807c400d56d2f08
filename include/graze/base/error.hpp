#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace graze {

/// A place in a text that a user wrote. Lines and columns count from 1; 0 means "not known".
struct Place {
    std::string file;
    int line = 0;
    int column = 0;

    /// `file:line:column`, leaving out what is not known.
    std::string text() const;
};

/// By which a caller decides what to do about an error.
enum class ErrorKind {
    input,      ///< what was given cannot be used: a text, a record, a setting, an argument
    file,       ///< a file cannot be opened, read or written, or somebody else uses it
    instrument, ///< an instrument does not do what it should
    order,      ///< a function was called before what it needs, or in the midst of something
    internal,   ///< the library contradicts itself
};
/// Stable name, such as "input".
std::string_view name_of(ErrorKind kind);

/// What the library throws, all of it but for std::bad_alloc and whatever callbacks of the caller throw.
/// `what()` is one line: `file:line:col: what is wrong; what to do`.
class Error : public std::runtime_error {
public:
    /// @param place    where in a text or file; empty: values given from C++ or on a command line
    /// @param problem  what is wrong
    /// @param remedy   what to do about it (may be empty)
    Error(ErrorKind kind, Place place, const std::string& problem, const std::string& remedy);

    ErrorKind kind() const { return kind_; }
    const Place& place() const { return place_; }
    const std::string& problem() const { return problem_; }
    const std::string& remedy() const { return remedy_; }

private:
    ErrorKind kind_;
    Place place_;
    std::string problem_;
    std::string remedy_;
};

/// A function was called before what it needs, such as a step of what was not started: a mistake of the calling
/// program.
class OrderError : public Error {
public:
    explicit OrderError(const std::string& problem, const std::string& remedy = "")
        : Error(ErrorKind::order, {}, problem, remedy) {}
};

/// The library contradicts itself.
class InternalError : public Error {
public:
    explicit InternalError(const std::string& problem)
        : Error(ErrorKind::internal, {}, problem, "this is a mistake in graze: please report it, with what led to it") {
    }
};

} // namespace graze
