#include "program/style_arguments.hpp"

#include "graze/base/input_error.hpp"
#include "graze/study/study.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace graze {

double number_of_option(const std::string& text, const char* option) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throw InputError({option, 0, 0}, fmt::format("'{}' is not a number", text), "give a number");
    return value;
}

FigureStyle figure_style(const StyleArguments& arguments) {
    FigureStyle style;
    style.grey = arguments.grey;
    if (!arguments.size.empty()) {
        const std::size_t cross = arguments.size.find('x');
        if (arguments.size.find_first_not_of("0123456789.x") != std::string::npos)
            throw InputError({"--size", 0, 0}, fmt::format("'{}' is no size", arguments.size),
                             "write the width in mm, as 85, or WIDTHxHEIGHT, as 254x143");
        style.width = number_of_option(arguments.size.substr(0, cross), "--size");
        if (cross != std::string::npos)
            style.height = number_of_option(arguments.size.substr(cross + 1), "--size");
        if (style.width == 0 || (cross != std::string::npos && style.height == 0)) // 0 would mean the default
            throw InputError({"--size", 0, 0}, fmt::format("'{}' is no size", arguments.size), "give millimetres");
    }
    const std::string& font = arguments.font;
    const std::size_t comma = font.find(',');
    const bool only_size = !font.empty() && font.find_first_not_of("0123456789.") == std::string::npos;
    if (only_size || comma != std::string::npos)
        style.font_size = number_of_option(only_size ? font : font.substr(comma + 1), "--font");
    if (!only_size)
        style.font = font.substr(0, comma);
    check_style(style, {arguments.size.empty() ? "--font" : "--size", 0, 0});
    return style;
}

} // namespace graze
