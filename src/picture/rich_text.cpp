#include "picture/rich_text.hpp"

#include "graze/base/printable.hpp"
#include "picture/gnuplot_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>

namespace graze {

namespace {

using RunLook = TextRun::Look;

constexpr double wide = 0.84;          ///< upper bound of the width of characters that are not in the table
constexpr double width_of_index = 0.8; ///< font size of an index, relative to its text

/// Widths of the ASCII characters from blank to tilde, in thousandths of the font size.
constexpr std::array<int, 95> widths{318,  401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361, 318, 337,
                                     636,  636, 636, 636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531,
                                     1000, 684, 686, 698, 770, 632, 575, 775, 752, 295, 295, 656, 557, 863, 748, 787,
                                     603,  787, 695, 635, 611, 732, 684, 989, 685, 611, 685, 390, 337, 390, 838, 500,
                                     500,  613, 635, 550, 635, 615, 352, 635, 634, 278, 278, 579, 278, 974, 634, 612,
                                     635,  635, 411, 521, 392, 634, 592, 818, 592, 592, 525, 636, 337, 636, 838};

double width_of_letters(const std::string& text) {
    double width = 0;
    for (const unsigned char c : text)
        if (c >= ' ' && c <= '~')
            width += 1e-3 * widths[c - ' '];
        else if ((c & 0xc0) != 0x80) // not a continuation byte of UTF-8
            width += wide;
    return width;
}

/// Removes the last character, with all its bytes.
void drop_letter(std::string& text) {
    const auto is_continued = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; };
    while (text.size() > 1 && is_continued(text.back()))
        text.pop_back();
    text.pop_back();
}

bool is_index(const TextRun& run) {
    return run.look == RunLook::lowered || run.look == RunLook::raised;
}

/// Escapes a text for LaTeX. Of characters beyond ASCII only those that graze itself uses are replaced.
std::string latex_letters(const std::string& text) {
    static const std::map<std::string, std::string> known{{"→", "$\\rightarrow$"},
                                                          {"−", "$-$"},
                                                          {"·", "$\\cdot$"},
                                                          {"°", "$^\\circ$"},
                                                          {"…", "\\dots{}"},
                                                          {"×", "$\\times$"},
                                                          {"\\", "\\textbackslash{}"},
                                                          {"~", "\\textasciitilde{}"},
                                                          {"^", "\\textasciicircum{}"},
                                                          {"`", "\\textasciigrave{}"},
                                                          {"\"", "\\textquotedbl{}"},
                                                          {"<", "\\textless{}"},
                                                          {">", "\\textgreater{}"},
                                                          {"|", "\\textbar{}"}};
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        const auto found = std::find_if(known.begin(), known.end(), [&](const auto& one) {
            return text.compare(i, one.first.size(), one.first) == 0;
        });
        if (found != known.end()) {
            result += found->second;
            i += found->first.size();
            continue;
        }
        const char c = text[i++];
        result += std::string_view("{}$&#_%").find(c) != std::string_view::npos ? std::string{'\\', c} : std::string{c};
    }
    return result;
}

/// The end of an exponent such as ^-1 after a letter; `begin` if there is none.
std::size_t power_at(const std::string& text, std::size_t begin) {
    if (begin == 0 || begin >= text.size() || text[begin] != '^' ||
        std::isalpha(static_cast<unsigned char>(text[begin - 1])) == 0)
        return begin;
    const std::size_t digits = begin + (text.compare(begin, 2, "^-") == 0 ? 2 : 1);
    const std::size_t end = std::min(text.find_first_not_of("0123456789", digits), text.size());
    return end > digits ? end : begin;
}

/// Markup of the four looks: what stands before the letters and after them.
using LookMarkup = std::array<std::pair<const char*, const char*>, 4>;
constexpr LookMarkup gnuplot_looks{{{"", ""}, {"{/:Italic ", "}"}, {"_{", "}"}, {"^{", "}"}}};
constexpr LookMarkup latex_looks{
    {{"", ""}, {"\\textit{", "}"}, {"\\textsubscript{", "}"}, {"\\textsuperscript{", "}"}}};

std::string marked_up(const TextRun& run, const LookMarkup& looks, const std::string& letters) {
    const auto& [before, after] = looks[static_cast<std::size_t>(run.look)];
    return before + letters + after;
}

} // namespace

RichText rich(const std::string& text) {
    return text.empty() ? RichText{} : RichText{{text, RunLook::upright}};
}

RichText rich_name(const std::string& name) {
    constexpr std::size_t longest_symbol = 2;
    const bool word =
        std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
    if (!word)
        return rich(name);
    const std::size_t underscore = name.find('_');
    const std::size_t stem = underscore == std::string::npos ? name.find_last_not_of("0123456789") + 1 : underscore;
    if (stem == 0 || stem > longest_symbol) {
        std::string words = name;
        std::replace(words.begin(), words.end(), '_', ' ');
        return rich(words);
    }
    RichText result{{name.substr(0, stem), RunLook::italic}};
    const std::string index = name.substr(std::min(name.size(), stem + (underscore == std::string::npos ? 0 : 1)));
    if (!index.empty())
        result.push_back({index, RunLook::lowered});
    return result;
}

RichText rich_words(const std::string& text, const std::vector<std::string>& symbols) {
    const auto in_name = [&](std::size_t i) {
        return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) != 0 || text[i] == '_');
    };
    const auto follows = [&](std::size_t at, std::string_view word) {
        return text.compare(at, word.size(), word) == 0 && !in_name(at + word.size());
    };
    RichText result;
    std::string words;
    for (std::size_t i = 0; i < text.size();) {
        std::size_t end = i;
        while (in_name(end))
            ++end;
        const std::string name = text.substr(i, end - i);
        const bool known = std::find(symbols.begin(), symbols.end(), name) != symbols.end();
        const RichText symbol = known ? rich_name(name) : RichText{};
        const bool indexed = symbol.size() > 1;
        const bool after_number = i >= 2 && text[i - 1] == ' ' && std::isdigit(static_cast<unsigned char>(text[i - 2]));
        const bool valued = follows(end, " =") || follows(end, " up") || follows(end, " down");
        if (known && symbol.front().look == RunLook::italic && (indexed || (valued && !after_number))) {
            result = result + rich(words) + symbol;
            words.clear();
        } else {
            words += name;
        }
        i = end;
        if (const std::size_t power = power_at(text, i); power > i) {
            result = result + rich(words) + RichText{{text.substr(i + 1, power - i - 1), RunLook::raised}};
            words.clear();
            i = power;
        }
        while (i < text.size() && !in_name(i))
            words += text[i++];
    }
    return result + rich(words);
}

RichText rich_unit(const std::string& unit) {
    RichText result;
    for (std::size_t i = 0; i < unit.size();) {
        const bool raised = unit[i] == '^';
        std::size_t end = std::min(unit.find('^', i), unit.size());
        if (raised)
            for (end = i + 1; end < unit.size() && (std::isdigit(static_cast<unsigned char>(unit[end])) != 0 ||
                                                    unit[end] == '-' || unit[end] == '.');)
                ++end;
        result.push_back({unit.substr(i + (raised ? 1 : 0), end - i - (raised ? 1 : 0)),
                          raised ? RunLook::raised : RunLook::upright});
        i = end;
    }
    return result;
}

RichText rich_power(int exponent) {
    return {{"10", RunLook::upright},
            {fmt::format("{}{}", exponent < 0 ? "−" : "", std::abs(exponent)), RunLook::raised}};
}

RichText operator+(RichText one, const RichText& other) {
    one.insert(one.end(), other.begin(), other.end());
    return one;
}

std::string letters_of(const RichText& text) {
    std::string letters;
    for (const TextRun& run : text)
        letters += run.text;
    return letters;
}

double width_of(const RichText& text) {
    double width = 0;
    for (const TextRun& run : text)
        width += width_of_letters(run.text) * (is_index(run) ? width_of_index : 1);
    return width;
}

std::vector<std::string> wrapped_lines(const std::string& text, double width, std::size_t most) {
    std::vector<std::string> lines, parts;
    std::istringstream words(text);
    for (std::string word; words >> word;)
        if (!parts.empty() && (word == "=" || parts.back().ends_with(" =") || parts.back().ends_with("Fig.")))
            parts.back() += ' ' + word;
        else
            parts.push_back(word);
    for (std::string& word : parts) {
        while (width_of_letters(word) > width && word.size() > 1)
            drop_letter(word);
        if (!lines.empty() && width_of_letters(lines.back() + ' ' + word) <= width)
            lines.back() += ' ' + word;
        else
            lines.push_back(word);
    }
    if (lines.size() > most) {
        lines.resize(most);
        lines.back() += "…";
    }
    return lines;
}

std::string gnuplot_markup(const RichText& text) {
    std::string result;
    for (const TextRun& run : text)
        result += marked_up(run, gnuplot_looks, plain(run.text));
    return result;
}

std::string latex_markup(const RichText& text) {
    std::string result;
    for (const TextRun& run : text) {
        require_quotable(run.text);
        result += marked_up(run, latex_looks, latex_letters(printable_line(run.text)));
    }
    std::string quoted; // backslashes doubled, since gnuplot reads the double quotes before LaTeX does
    for (const char c : result)
        quoted += c == '\\' ? std::string("\\\\") : std::string(1, c);
    return quoted;
}

} // namespace graze
