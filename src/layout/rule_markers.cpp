#include "graze/layout/rule_markers.hpp"

#include "graze/base/xml_text.hpp"
#include "layout/grid_lengths.hpp"

#include <fmt/format.h>

#include <set>

namespace graze {

namespace {

constexpr double half_marker = 5; ///< um, half of a marker's side

/// Quotes a word as KLayout does.
std::string quoted_word(const std::string& text) {
    std::string result = "'";
    for (const char letter : text) {
        if (letter == '\'' || letter == '\\')
            result += '\\';
        result += letter;
    }
    return result + "'";
}

std::string item_of(const RuleFinding& finding) {
    const double x = micrometres(finding.at.x), y = micrometres(finding.at.y);
    return fmt::format("  <item>\n   <tags/>\n   <category>{}</category>\n   <cell>{}</cell>\n"
                       "   <visited>false</visited>\n   <multiplicity>1</multiplicity>\n   <comment/>\n   <image/>\n"
                       "   <values>\n    <value>box: ({:.12g},{:.12g};{:.12g},{:.12g})</value>\n"
                       "    <value>text: {}</value>\n   </values>\n  </item>\n",
                       xml_text(quoted_word(finding.rule)), xml_text(finding.device), x - half_marker, y - half_marker,
                       x + half_marker, y + half_marker, xml_text(quoted_word(finding.text())));
}

} // namespace

std::string rule_markers(std::span<const RuleFinding> findings, const std::string& top, const std::string& generator) {
    std::set<std::string> rules, cells{top};
    std::string items;
    for (const RuleFinding& one : findings)
        if (!one.holds()) {
            rules.insert(one.rule);
            cells.insert(one.device);
            items += item_of(one);
        }
    std::string text = fmt::format("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<report-database>\n"
                                   " <description>Places that break a rule</description>\n <original-file/>\n"
                                   " <generator>{}</generator>\n <top-cell>{}</top-cell>\n <tags/>\n <categories>\n",
                                   xml_text(generator), xml_text(top));
    for (const std::string& rule : rules)
        text += fmt::format("  <category>\n   <name>{}</name>\n   <description>{}</description>\n   <categories/>\n"
                            "  </category>\n",
                            xml_text(rule), xml_text(rule));
    text += " </categories>\n <cells>\n";
    for (const std::string& cell : cells)
        text += fmt::format("  <cell>\n   <name>{}</name>\n   <variant/>\n   <layout-name/>\n   <references/>\n"
                            "  </cell>\n",
                            xml_text(cell));
    return text + " </cells>\n <items>\n" + items + " </items>\n</report-database>\n";
}

} // namespace graze
