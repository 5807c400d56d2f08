#include "base/letter_case.hpp"

#include <algorithm>
#include <cctype>

namespace graze {

namespace {

std::string changed(std::string_view text, int (*change)(int)) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [change](unsigned char letter) { return static_cast<char>(change(letter)); });
    return result;
}

} // namespace

std::string in_small_letters(std::string_view text) {
    return changed(text, std::tolower);
}

std::string in_capitals(std::string_view text) {
    return changed(text, std::toupper);
}

} // namespace graze
