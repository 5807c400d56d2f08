#include "base/letter_case.hpp"

#include <gtest/gtest.h>

namespace graze::letter_case_test {

TEST(LetterCase, ChangesOnlyAsciiLetters) {
    EXPECT_EQ(in_small_letters("Outp:LOAD? 9.9E+37"), "outp:load? 9.9e+37");
    EXPECT_EQ(in_capitals("vpp, 5 \xc2\xb5s"), "VPP, 5 \xc2\xb5S");
    EXPECT_EQ(in_small_letters("\xc3\x84"
                               "B"),
              "\xc3\x84"
              "b");
    EXPECT_EQ(in_capitals(""), "");
}

} // namespace graze::letter_case_test
