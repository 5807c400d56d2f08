#include "graze/base/rounded.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

namespace graze {

double rounded(double value, int digits) {
    if (!std::isfinite(value))
        return value;
    const std::string text = fmt::format("{:.{}g}", value, digits);
    double result = value;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), result);
    return error == std::errc() ? result
                                : value; // out of range: the decimal nearest to the largest double may exceed it
}

} // namespace graze
