#include "acquire/generator_answer.hpp"

#include "base/letter_case.hpp"
#include "base/read_whole.hpp"
#include "graze/base/trimmed.hpp"

#include <charconv>
#include <cmath>

namespace graze {

namespace {

constexpr double source_ohms = 50, high_impedance = 1e9;

/// The number after a plus sign, which std::from_chars does not accept.
std::string_view behind_plus(std::string_view answer) {
    return answer.substr(answer.starts_with('+') ? 1 : 0);
}

} // namespace

bool is_of_transmission(int error) {
    return (error <= -100 && error > -200) || error > 0;
}

std::optional<double> answered_number(std::string_view answer) {
    double value = 0;
    if (!read_whole(behind_plus(answer), value) || !std::isfinite(value))
        return std::nullopt;
    return value;
}

std::string compared(std::string_view answer) {
    return in_capitals(trimmed(answer));
}

double inner_by_shown(double load) {
    return load > high_impedance ? 1 : (source_ohms + load) / load;
}

bool tells_load(const std::string& answer, double load) {
    const std::optional<double> told = answered_number(answer);
    if (load > high_impedance) // most report 9.9E+37
        return answer == "INF" || answer == "INFINITY" || (told && *told > high_impedance);
    constexpr double close = 1e-3;
    return told && std::abs(*told - load) <= close * load;
}

bool tells_off(const std::string& answer) {
    return answer == "OFF" || answered_number(answer) == 0.0;
}

bool tells_on(const std::string& answer) {
    return answer == "ON" || answered_number(answer) == 1.0;
}

std::optional<int> answered_error(std::string_view answer) {
    const char* const end = answer.data() + answer.size();
    int number = 0;
    const auto [next, error] = std::from_chars(behind_plus(answer).data(), end, number);
    if (error != std::errc() || next == end || *next != ',')
        return std::nullopt;
    return number;
}

} // namespace graze
