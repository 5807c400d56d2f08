#include "instrument/scpi_text.hpp"

#include "base/letter_case.hpp"
#include "graze/base/trimmed.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
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

namespace {

constexpr double ohms = 50, milliwatt = 1e-3;

/// Ratio of peak-to-peak amplitude to root mean square.
double crest(WaveShape shape) {
    constexpr double root2 = std::numbers::sqrt2, root3 = std::numbers::sqrt3;
    constexpr double halves[]{root2, 1, root3, root3, 1}; // in the order of WaveShape
    return 2 * halves[static_cast<int>(shape)];
}

double peaks_of(double value, VoltageUnit unit, WaveShape shape) {
    if (unit == VoltageUnit::dbm)
        value = std::sqrt(ohms * milliwatt * std::pow(10, value / 10));
    return unit == VoltageUnit::vpp ? value : value * crest(shape);
}

} // namespace

double shown_voltage(double peaks, VoltageUnit unit, WaveShape shape) {
    if (unit == VoltageUnit::vpp)
        return peaks;
    const double effective = peaks / crest(shape);
    return unit == VoltageUnit::vrms ? effective : 10 * std::log10(effective * effective / ohms / milliwatt);
}

bool read_voltage(std::string_view suffix, VoltageUnit unit, WaveShape shape, double& value) {
    if (suffix.empty() || (suffix == "V" && unit != VoltageUnit::dbm))
        value = peaks_of(value, unit, shape);
    else if (suffix == "MV" && unit != VoltageUnit::dbm)
        value = peaks_of(1e-3 * value, unit, shape);
    else if (suffix == "MVPP")
        value *= 1e-3;
    else if (const auto named = voltage_unit_named(suffix))
        value = peaks_of(value, *named, shape);
    else
        return false;
    return true;
}

std::string_view name_of(VoltageUnit unit) {
    return unit == VoltageUnit::vpp ? "VPP" : unit == VoltageUnit::vrms ? "VRMS" : "DBM";
}

std::optional<VoltageUnit> voltage_unit_named(std::string_view name) {
    for (const VoltageUnit unit : {VoltageUnit::vpp, VoltageUnit::vrms, VoltageUnit::dbm})
        if (name == name_of(unit))
            return unit;
    return std::nullopt;
}

} // namespace graze
