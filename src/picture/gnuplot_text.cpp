#include "picture/gnuplot_text.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

namespace graze {

void require_quotable(const std::string& text) {
    if (std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }))
        throw InputError(fmt::format("'{}' cannot be written into a picture: it has control characters", text),
                         "change the name, title or label");
}

std::string plain(const std::string& given) {
    require_quotable(given);
    const std::string text = printable_line(given); // also replaces invalid UTF-8
    std::string result;
    for (const char c : text) {
        // As an octal code, the only form that all versions of gnuplot print unchanged.
        if (c == '`')
            result += "\\140";
        else if (c == '@')
            result += "\\\\\\100";
        else if (std::string_view("_^{}&~\\").find(c) != std::string_view::npos)
            result += (c == '\\' ? "\\\\\\" : "\\\\") + std::string(1, c);
        else
            result += (c == '"' ? "\\" : "") + std::string(1, c);
    }
    return result;
}

std::string quoted_path(const std::string& path) {
    require_quotable(path);
    std::string result = "'";
    for (const char c : path)
        result += c == '\'' ? "''" : std::string(1, c);
    return result + "'";
}

std::string firm_blanks(std::string markup) {
    // librsvg drops blanks at the end of a span, except before a character of zero width.
    const std::string blank = "\u00a0", mark = "\u200b";
    for (const auto& [soft, firm] : {std::pair{std::string("} "), "}" + mark + blank}, {" {", blank + mark + "{"}})
        for (std::size_t at = markup.find(soft); at != std::string::npos; at = markup.find(soft, at))
            markup.replace(at, soft.size(), firm);
    return markup;
}

std::string drawing_terminal(const std::string& ending, double width, double height, double png_scale) {
    if (ending == "png")
        return fmt::format("pngcairo noenhanced size {:.0f},{:.0f}", png_scale * width, png_scale * height);
    if (ending == "pdf")
        return fmt::format("pdfcairo noenhanced size {:.3f}in,{:.3f}in", width / 96, height / 96);
    return fmt::format("svg noenhanced size {:.0f},{:.0f} background rgb 'white'", width, height);
}

} // namespace graze
