#include "instrument/scpi_text.hpp"

#include "base/letter_case.hpp"
#include "graze/base/trimmed.hpp"
#include "instrument/function_generator.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace graze {

std::vector<std::string_view> parts(std::string_view text, char separator) {
    std::vector<std::string_view> result;
    for (std::size_t begin = 0;;) {
        const std::size_t end = std::min(text.find(separator, begin), text.size());
        result.push_back(trimmed(text.substr(begin, end - begin)));
        if (end == text.size())
            return result;
        begin = end + 1;
    }
}

bool is_form_of(std::string_view word, std::string_view pattern) {
    const std::string whole = in_capitals(pattern);
    const auto small = std::find_if(pattern.begin(), pattern.end(),
                                    [](char letter) { return std::islower(static_cast<unsigned char>(letter)) != 0; });
    return word == whole ||
           word == std::string_view(whole).substr(0, static_cast<std::size_t>(small - pattern.begin()));
}

bool matches(std::string_view header, std::string_view pattern) {
    const std::vector<std::string_view> words = parts(header, ':'), forms = parts(pattern, ':');
    return words.size() == forms.size() && std::equal(words.begin(), words.end(), forms.begin(), is_form_of);
}

std::string_view scpi_error_text(int number) {
    static constexpr std::array<std::pair<int, std::string_view>, 14> texts{{{0, "No error"},
                                                                             {-101, "Invalid character"},
                                                                             {-102, "Syntax error"},
                                                                             {-104, "Data type error"},
                                                                             {-108, "Parameter not allowed"},
                                                                             {-109, "Missing parameter"},
                                                                             {-113, "Undefined header"},
                                                                             {-131, "Invalid suffix"},
                                                                             {-221, "Settings conflict"},
                                                                             {-222, "Data out of range"},
                                                                             {-224, "Illegal parameter value"},
                                                                             {-350, "Too many errors"},
                                                                             {521, "Input buffer overflow"},
                                                                             {550, "Command not allowed in local"}}};
    const auto found = std::find_if(texts.begin(), texts.end(), [&](const auto& one) { return one.first == number; });
    return found == texts.end() ? std::string_view("Unknown error") : found->second;
}

} // namespace graze
