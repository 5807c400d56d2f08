#include "picture/rich_text.hpp"

#include "graze/base/input_error.hpp"

#include <gmock/gmock.h>

namespace graze::testing::rich_text_test {

using ::testing::ElementsAre;

TEST(RichText, NamesAreSymbolsWithIndicesOrWords) {
    EXPECT_EQ(gnuplot_markup(rich_name("x_nd")), "{/:Italic x}_{nd}");
    EXPECT_EQ(gnuplot_markup(rich_name("V0")), "{/:Italic V}_{0}");
    EXPECT_EQ(gnuplot_markup(rich_name("velocity_jump")), "velocity jump");
    EXPECT_EQ(gnuplot_markup(rich_name("V - 0.2")), "V - 0.2");
    EXPECT_EQ(gnuplot_markup(rich_unit("m/s^2")), "m/s^{2}");
    EXPECT_EQ(letters_of(rich_power(-6)), "10−6");
}

TEST(RichText, UnambiguousNamesWithinTextAreSymbols) {
    const std::vector<std::string> symbols{"V0", "x3", "V", "a", "delta", "k_s"};
    const auto shown = [&](const std::string& text) { return gnuplot_markup(rich_words(text, symbols)); };
    EXPECT_EQ(shown("V0 = 4.833 V: period 3"), "{/:Italic V}_{0} = 4.833 V: period 3");
    EXPECT_EQ(shown("root mean square of x3 and x34"), "root mean square of {/:Italic x}_{3} and x34");
    EXPECT_EQ(shown("(a) V up"), "(a) {/:Italic V} up");
    EXPECT_EQ(shown("a stop at 3 V = 0"), "a stop at 3 V = 0");
    EXPECT_EQ(shown("a = 1, delta = 2"), "{/:Italic a} = 1, delta = 2");
    EXPECT_EQ(shown("k_s, Vup, xk_s"), "{/:Italic k}_{s}, Vup, xk\\\\_s");
    EXPECT_EQ(shown("at V"), "at V");
    EXPECT_EQ(shown("V = 3 m/s^2, s^-1 and 2^3"), "{/:Italic V} = 3 m/s^{2}, s^{-1} and 2\\\\^3");
    EXPECT_EQ(shown(""), "");
    EXPECT_EQ(shown("ä V = ö"), "ä {/:Italic V} = ö");
}

TEST(RichText, LatexMarkupContainsNoCommandsOfTheText) {
    EXPECT_EQ(latex_markup(rich("50% of $x_1$ & \\input{a} #~^|<>\"`")),
              "50\\\\% of \\\\$x\\\\_1\\\\$ \\\\& \\\\textbackslash{}input\\\\{a\\\\} "
              "\\\\#\\\\textasciitilde{}\\\\textasciicircum{}\\\\textbar{}\\\\textless{}\\\\textgreater{}"
              "\\\\textquotedbl{}\\\\textasciigrave{}");
    EXPECT_EQ(latex_markup(rich_name("V0") + rich_unit("s^-1")),
              "\\\\textit{V}\\\\textsubscript{0}s\\\\textsuperscript{-1}");
    EXPECT_EQ(latex_markup(rich("a → b")), "a $\\\\rightarrow$ b");
    EXPECT_THROW(latex_markup(rich("a\nb")), InputError);
}

TEST(RichText, LinesAreBrokenAtBlanks) {
    EXPECT_THAT(wrapped_lines("one two three", 100, 3), ElementsAre("one two three"));
    EXPECT_THAT(wrapped_lines("one two three", 4.5, 3), ElementsAre("one two", "three"));
    EXPECT_THAT(wrapped_lines("one two three", 2.5, 2), ElementsAre("one", "two…"));
    EXPECT_THAT(wrapped_lines("one V = 0.3 m", 4.5, 3), ElementsAre("one", "V = 0.3", "m"));
    EXPECT_THAT(wrapped_lines("one (Fig. 2)", 5, 3), ElementsAre("one", "(Fig. 2)"));
    EXPECT_THAT(wrapped_lines("", 5, 2), ElementsAre());
    for (const std::string& line : wrapped_lines("ein überlanges Wort: ääääääääääääääääääääääää", 6, 9))
        EXPECT_LE(width_of(rich(line)), 6) << line;
}

TEST(RichText, WidthsEqualThoseOfDejaVuSans) {
    // Advances of DejaVu Sans in 2048ths of its size: H 1540, i 569, 0 1303.
    EXPECT_NEAR(width_of(rich("H")), 1540.0 / 2048, 5e-4);
    EXPECT_NEAR(width_of(rich("i")), 569.0 / 2048, 5e-4);
    EXPECT_NEAR(width_of(rich("00")), 2 * 1303.0 / 2048, 1e-3);
}

} // namespace graze::testing::rich_text_test
