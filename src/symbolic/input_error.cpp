#include "graze/symbolic/input_error.hpp"

namespace graze {

namespace {

std::string message(const Place& place, const std::string& problem, const std::string& remedy) {
    std::string text = place.text();
    if (!text.empty())
        text += ": ";
    text += problem;
    if (!remedy.empty())
        text += "; " + remedy;
    return text;
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

InputError::InputError(Place place, const std::string& problem, const std::string& remedy)
    : std::runtime_error(message(place, problem, remedy)), place_(std::move(place)), problem_(problem),
      remedy_(remedy) {}

InputError::InputError(const std::string& problem, const std::string& remedy) : InputError(Place{}, problem, remedy) {}

} // namespace graze
