#include "graze/base/error.hpp"

#include "base/enumerator_name.hpp"
#include "graze/base/printable.hpp"

#include <utility>

namespace graze {

namespace {

// Quoted text may be as long as a file; a message has to stay readable.
constexpr std::size_t longest_part = 1000;

/// Quoted names and texts come from anywhere: the message stays one line without control characters.
std::string message(const Place& place, const std::string& problem, const std::string& remedy) {
    std::string text = shortened(place.text(), longest_part);
    if (!text.empty())
        text += ": ";
    text += shortened(problem, longest_part);
    if (!remedy.empty())
        text += "; " + shortened(remedy, longest_part);
    return printable_line(text);
}

} // namespace

std::string Place::text() const {
    std::string text = file;
    for (int count : {line, line > 0 ? column : 0}) {
        if (count <= 0)
            continue;
        if (!text.empty())
            text += ':';
        text += std::to_string(count);
    }
    return text;
}

std::string_view name_of(ErrorKind kind) {
    constexpr std::string_view names[] = {"input", "file", "instrument", "order", "internal"};
    return enumerator_name(names, kind, "internal");
}

Error::Error(ErrorKind kind, Place place, const std::string& problem, const std::string& remedy)
    : std::runtime_error(message(place, problem, remedy)), kind_(kind), place_(std::move(place)), problem_(problem),
      remedy_(remedy) {}

} // namespace graze
