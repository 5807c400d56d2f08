#include "graze/base/printable.hpp"

#include "graze/base/input_error.hpp"

#include <gtest/gtest.h>

#include <random>

namespace graze::printable_test {

/// Returns random bytes among which the special ones are frequent.
std::string random_text(std::mt19937& random) {
    static const std::string_view parts[] = {"a",
                                             "\x1b[2J",
                                             "\n",
                                             "\t",
                                             "\r",
                                             "\x07",
                                             std::string_view("\0", 1),
                                             "\x7f",
                                             "\xc2\x9b",
                                             "\xe2\x80\xae",
                                             "ü",
                                             "→",
                                             "\xf0\x9f\x98\x80",
                                             "\xff",
                                             "\xc3",
                                             "\xe2\x80",
                                             "\xf3\xa0\x80\x81",
                                             "\xed\xa0\x80",
                                             "\xc0\x80",
                                             "é",
                                             "\\",
                                             "'"};
    std::string text;
    for (int i = std::uniform_int_distribution<>(0, 12)(random); i > 0; --i)
        text += parts[std::uniform_int_distribution<std::size_t>(0, std::size(parts) - 1)(random)];
    return text;
}

TEST(Printable, OutputHasNoActiveCharacters) {
    std::mt19937 random(1);
    for (int i = 0; i < 20'000; ++i) {
        const std::string text = random_text(random), line = printable_line(text), shown = printable(text);
        EXPECT_TRUE(is_plain_line(line)) << i;
        EXPECT_TRUE(is_plain_text(shown)) << i;
        EXPECT_EQ(shown.find('\r'), std::string::npos);
        EXPECT_EQ(is_plain_line(text), line == text) << i;
        EXPECT_EQ(printable_line(line), line);
    }
}

TEST(Printable, CodesAreThoseOfUnicode) {
    EXPECT_EQ(printable("a\x1b[31m\n\tb"), "a\\u001b[31m\n\tb");
    EXPECT_EQ(printable_line("a\nb"), "a\\u000ab");
    EXPECT_EQ(printable("\xc2\x9b"
                        "2J \xe2\x80\xae"),
              "\\u009b2J \\u202e");
    EXPECT_EQ(printable("\xff\xc3"), "\xef\xbf\xbd\xef\xbf\xbd");
    EXPECT_EQ(printable("Übergröße → 😀"), "Übergröße → 😀");
}

TEST(Printable, IncompleteCharactersAreLeftForLater) {
    const std::string text = "a→😀";
    for (std::size_t size = 0; size <= text.size(); ++size) {
        const std::string_view part(text.data(), size);
        EXPECT_TRUE(is_plain_line(part.substr(0, size - unfinished_character(part)))) << size;
    }
    EXPECT_EQ(unfinished_character("\x80\x80\x80"), 0u);
}

TEST(Printable, ErrorMessagesAreOneShortLine) {
    std::mt19937 random(2);
    for (int i = 0; i < 2000; ++i) {
        const InputError error({random_text(random), 1, 2}, random_text(random), random_text(random));
        EXPECT_TRUE(is_plain_line(error.what()));
    }
    const std::string message = InputError(std::string(1'000'000, 'x'), std::string(1'000'000, 'y')).what();
    EXPECT_LT(message.size(), 2500u);
    EXPECT_NE(message.find("bytes left out"), std::string::npos);
}

} // namespace graze::printable_test
