#include "graze/base/xml_text.hpp"

#include <gtest/gtest.h>

namespace graze::xml_text_test {

TEST(XmlText, EscapesSpecialCharacters) {
    EXPECT_EQ(xml_text("a < b && c > \"d\" ]]> 'e'"), "a &lt; b &amp;&amp; c &gt; &quot;d&quot; ]]&gt; 'e'");
    EXPECT_EQ(xml_text("\xc3\xa9 \xe2\x80\xae \xf0\x9f\x98\x80\t\n\r"), "\xc3\xa9 \xe2\x80\xae \xf0\x9f\x98\x80\t\n\r");
}

TEST(XmlText, ReplacesForbiddenCharacters) {
    const std::string sign = "\xef\xbf\xbd";
    for (const std::string wrong : {"\x01", "\x1b", "\x1f", "\xff", "\xc0", "\x80", "\xef\xbf\xbe", "\xef\xbf\xbf"}) {
        EXPECT_EQ(xml_text("a" + wrong + "b"), "a" + sign + "b");
        EXPECT_EQ(well_formed("<a>" + wrong + "</a>"), "<a>" + sign + "</a>");
    }
    EXPECT_EQ(xml_text(std::string("a\0b", 3)), "a" + sign + "b");
    EXPECT_EQ(xml_text("\xed\xa0\x80"), sign + sign + sign); // half of a surrogate pair
    EXPECT_EQ(xml_text("\xe2\x82"), sign + sign);            // cut off
}

TEST(XmlText, KeepsWellFormedDocuments) {
    const std::string document = "<?xml version=\"1.0\"?>\n<svg><text>a &lt; b [1] ]] ></text></svg>\n";
    EXPECT_EQ(well_formed(document), document);
    EXPECT_EQ(well_formed("<text>a ]]> b ]]]> c</text>"), "<text>a ]]&gt; b ]]]&gt; c</text>");
}

} // namespace graze::xml_text_test
